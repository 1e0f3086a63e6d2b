#include "voxels/ball_in_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>

#include "bernal/core/random.hpp"
#include "support/ball_in_box.hpp"

namespace bernal {
namespace ball_in_cells_test {

using testing::ball_in_box;
using testing::disc_in_rectangle;

constexpr double pi = std::numbers::pi;

/// Area of the disc of radius r about the origin in a rectangle, by what its chords along y have in it:
/// pieces between the places where a chord's end passes an edge, each integrated in closed form.
double area_by_chords(double r, const Bounds<2>& box) {
  if (!(r > 0)) return 0;
  const double left = std::max(-r, box.lower[0]), right = std::min(r, box.upper[0]);
  if (!(left < right)) return 0;
  std::vector<double> ends = {left, right};
  for (const double edge : {box.lower[1], box.upper[1]}) {
    if (!(std::abs(edge) < r)) continue;
    const double x = std::sqrt(r * r - edge * edge);
    for (const double end : {-x, x})
      if (end > left && end < right) ends.push_back(end);
  }
  std::sort(ends.begin(), ends.end());
  const auto half_chord = [&](double x) { return std::sqrt(std::max(0.0, r * r - x * x)); };
  const auto integral = [&](double x) {
    return 0.5 * (x * half_chord(x) + r * r * std::asin(std::clamp(x / r, -1.0, 1.0)));
  };
  double area = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double a = ends[k], b = ends[k + 1],
                 s = half_chord(a + 0.3 * (b - a));  // off the middle, where a chord may touch an edge
    const double of_chords = integral(b) - integral(a), width = b - a;
    const double top = s < box.upper[1] ? of_chords : box.upper[1] * width;
    const double bottom = -s > box.lower[1] ? -of_chords : box.lower[1] * width;
    if (std::min(s, box.upper[1]) > std::max(-s, box.lower[1])) area += top - bottom;
  }
  return area;
}

/// Volume of the ball of radius r about the origin in a box: the areas of its sections across z, integrated
/// between all heights at which a section's circle passes an edge or a corner.
double volume_by_sections(double r, const Bounds<3>& box) {
  const double bottom = std::max(-r, box.lower[2]), top = std::min(r, box.upper[2]);
  if (!(bottom < top)) return 0;
  std::vector<double> squares;
  for (const double x : {box.lower[0], box.upper[0]}) {
    squares.push_back(x * x);
    for (const double y : {box.lower[1], box.upper[1]}) {
      squares.push_back(y * y);
      squares.push_back(x * x + y * y);
    }
  }
  std::vector<double> heights = {bottom, top, 0};
  for (const double square : squares)
    for (const double sign : {-1, 1}) heights.push_back(sign * std::sqrt(std::max(0.0, r * r - square)));
  std::sort(heights.begin(), heights.end());
  const Bounds<2> section{box.lower.head<2>(), box.upper.head<2>()};
  double volume = 0;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double from = std::max(heights[k], bottom), to = std::min(heights[k + 1], top);
    if (!(from < to)) continue;
    // At the ends the area grows like roots of what is left of z, which are smooth in the angle.
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const auto of_angle = [&](double angle) {
      const double z = middle - half * std::cos(angle);
      return half * std::sin(angle) * area_by_chords(std::sqrt(std::max(0.0, r * r - z * z)), section);
    };
    for (int part = 0; part < 4; ++part)
      volume +=
          boost::math::quadrature::gauss<double, 30>::integrate(of_angle, part * pi / 4, (part + 1) * pi / 4);
  }
  return volume;
}

Bounds<3> shifted(const Bounds<3>& box, const Vector<3>& by) { return {box.lower - by, box.upper - by}; }

void expect_right(const Vector<3>& center, double r, const Bounds<3>& box) {
  const double volume = ball_in_box(center, r, box);
  // Some dozen roundings of numbers below π, and what the integral leaves where heights nearly coincide.
  EXPECT_NEAR(volume, volume_by_sections(r, shifted(box, center)), 1e-11 * r * r * r)
      << "ball " << center.transpose() << ", " << r << "; box " << box.lower.transpose() << " to "
      << box.upper.transpose();
  EXPECT_GE(volume, 0);
  EXPECT_LE(volume, box.volume());
}

TEST(BallInCells, IsTheIntegralOfSections) {
  Random random(3, stream(Stream::test));
  for (int trial = 0; trial < 400; ++trial) {
    Vector<3> center, lower, upper;
    const double size = std::pow(10.0, random.uniform(-2, 0.7));
    for (int k = 0; k < 3; ++k) {
      center[k] = random.uniform(-3, 3);
      lower[k] = center[k] + random.uniform(-1.2, 1.1);
      upper[k] = lower[k] + size * random.uniform(0.2, 1);
    }
    expect_right(center, 1, {lower, upper});
  }
}

TEST(BallInCells, IsRightInEveryDegenerateCase) {
  const double root = std::sqrt(0.5), third = std::sqrt(1.0 / 3), next = std::nextafter(1.0, 0.0);
  const std::vector<double> places = {-2,   -1,    -next, -0.8, -root, -0.6, -third, 0,
                                      1e-9, third, 0.6,   root, 0.8,   next, 1,      2};
  // Planes through the centre, tangent ones, corners on the sphere (3-4-5 and others), slabs and columns that
  // reach through, the ball in the box and the box in the ball: all pairs of neighbours but two axes at once.
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    for (std::size_t j = 0; j + 1 < places.size(); ++j) {
      for (const auto& [low, high] : {std::pair{-2.0, 2.0}, {0.0, 0.6}, {-0.8, root}, {third, 1.0}}) {
        expect_right({0, 0, 0}, 1, {{places[i], places[j], low}, {places[i + 1], places[j + 1], high}});
        expect_right({0, 0, 0}, 1, {{low, places[i], places[j]}, {high, places[i + 1], places[j + 1]}});
      }
    }
  }
}

TEST(BallInCells, KnowsVolumesByHeart) {
  const double ball = 4.0 / 3 * pi * 8;
  const Vector<3> c(1, -2, 3);
  const auto within = [&](const Vector<3>& lower, const Vector<3>& upper) {
    return ball_in_box(c, 2, {c + lower, c + upper});
  };
  EXPECT_NEAR(within({-2, -2, -2}, {2, 2, 2}), ball, 1e-14 * ball);       // in the box, touching
  EXPECT_NEAR(within({-5, -5, -5}, {5, 5, 5}), ball, 1e-14 * ball);       // far within
  EXPECT_NEAR(within({0, -5, -5}, {5, 5, 5}), ball / 2, 1e-14 * ball);    // half
  EXPECT_NEAR(within({0, 0, 0}, {5, 5, 5}), ball / 8, 1e-14 * ball);      // an octant
  EXPECT_NEAR(within({1, -5, -5}, {5, 5, 5}), 5 * pi / 3, 1e-14 * ball);  // a cap: π h² (3 r - h) / 3
  EXPECT_EQ(within({2, -1, -1}, {3, 1, 1}), 0);                           // touches a face
  EXPECT_EQ(within({1.5, 1.5, -1}, {3, 3, 1}), 0);                        // passes an edge
  EXPECT_EQ(within({1.2, 1.2, 1.2}, {3, 3, 3}), 0);                       // passes a corner
  EXPECT_EQ(within({-1, -1, -1}, {1, 1, 1}), 8);                          // the box in the ball
  // A small box below the top of the ball, of which this is missing: y² + z² over 2 r, in the mean.
  const double edge = 2e-3, missing = edge * edge * (edge * edge / 6) / 4;
  EXPECT_NEAR(within({2 - edge, -edge / 2, -edge / 2}, {2, edge / 2, edge / 2}), edge * edge * edge - missing,
              1e-14);
}

TEST(BallInCells, CellsOfAGridSumUpAndAreTheirBoxes) {
  Random random(5, stream(Stream::test));
  for (int trial = 0; trial < 30; ++trial) {
    BallInCells cells;
    for (auto& planes : cells.planes) {
      planes.push_back(random.uniform(-1.2, -0.2));
      for (int i = 0; i < 9; ++i) planes.push_back(planes.back() + random.uniform(0.01, 0.4));
    }
    const auto at = cells.planes;
    std::vector<double> volumes(9 * 9 * 9, 0.0);
    cells.add(1, 1e9, volumes.data(), 9, 81);  // cells within the ball are told by their mark
    double sum = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t j = 0; j < 9; ++j) {
        for (std::size_t i = 0; i < 9; ++i) {
          const Bounds<3> cell{{at[0][i], at[1][j], at[2][k]}, {at[0][i + 1], at[1][j + 1], at[2][k + 1]}};
          double volume = volumes[81 * k + 9 * j + i];
          if (volume == 1e9) volume = cell.volume();
          EXPECT_NEAR(volume, ball_in_box({0, 0, 0}, 1, cell), 1e-14);
          sum += volume;
        }
      }
    }
    const Bounds<3> all{{at[0][0], at[1][0], at[2][0]}, {at[0][9], at[1][9], at[2][9]}};
    EXPECT_NEAR(sum, ball_in_box({0, 0, 0}, 1, all), 1e-13);
  }
}

TEST(BallInCells, DiscsAreTheirChords) {
  Random random(7, stream(Stream::test));
  for (int trial = 0; trial < 2000; ++trial) {
    Vector<2> center, lower, upper;
    for (int k = 0; k < 2; ++k) {
      center[k] = random.uniform(-3, 3);
      lower[k] = center[k] + random.uniform(-2.5, 2.2);
      upper[k] = lower[k] + std::pow(10.0, random.uniform(-3, 0.7));
    }
    const double area = disc_in_rectangle(center, 2, {lower, upper});
    EXPECT_NEAR(area, area_by_chords(2, {lower - center, upper - center}), 1e-14 * 4 * pi * 4);
  }
  EXPECT_NEAR(disc_in_rectangle({1, 1}, 2, {{-1, -1}, {3, 3}}), 4 * pi, 1e-14);
  EXPECT_EQ(disc_in_rectangle({1, 1}, 2, {{0, 0}, {2, 2}}), 4);
  EXPECT_EQ(disc_in_rectangle({1, 1}, 2, {{3, 0}, {4, 2}}), 0);
}

}  // namespace ball_in_cells_test
}  // namespace bernal
