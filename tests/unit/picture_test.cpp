#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "report/outline.hpp"
#include "report/write_svg.hpp"
#include "support/packings.hpp"
#include "viewer/view.hpp"

namespace bernal {
namespace picture_test {

using testing::scattered;

const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};

struct Disc {
  double x, y, r;
};

/// The spheres of a picture in the order in which they are painted; the key's discs come last and are left
/// out.
std::vector<Disc> painted(const std::string& svg) {
  static const std::regex circle("<circle cx=\"([^\"]+)\" cy=\"([^\"]+)\" r=\"([^\"]+)\"");
  const std::string spheres = svg.substr(0, svg.find("<g font-family"));
  std::vector<Disc> discs;
  for (std::sregex_iterator it(spheres.begin(), spheres.end(), circle), end; it != end; ++it) {
    discs.push_back({std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3])});
  }
  return discs;
}

TEST(Picture, WhatIsOnTopIsWhatIsNearest) {
  // The oracle looks along every line of sight for the nearest surface. Coordinates in the picture are
  // rounded to 0.1, so lines that pass nearer than that to an edge of any disc do not decide.
  const Spheres<3> spheres = scattered(600, 0.05, 2, bounds_of(box), 11, true);
  ASSERT_GT(spheres.size(), 300u);
  const std::string svg = svg_of(spheres, box, "mm");
  const std::vector<Disc> discs = painted(svg);
  const View view(drawable_mesh(box).vertices, 1000, 12, 480);
  Random random(1, stream(Stream::test));
  int decided = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double x = random.uniform(0, view.width()), y = random.uniform(0, view.height());
    double nearest = -std::numeric_limits<double>::infinity();
    CanvasPoint expected;
    bool clear = true;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const CanvasPoint c = view(spheres.center(i));
      const double r = view.scale() * spheres.r[i], off = std::hypot(x - c.x, y - c.y);
      clear = clear && std::abs(off - r) > 0.3;
      if (off >= r) continue;
      const double depth = c.depth + std::sqrt(r * r - off * off);
      if (depth > nearest) {
        nearest = depth;
        expected = c;
      }
    }
    if (!clear) continue;
    const auto top = std::find_if(discs.rbegin(), discs.rend(),
                                  [&](const Disc& d) { return std::hypot(x - d.x, y - d.y) < d.r; });
    ASSERT_EQ(top == discs.rend(), std::isinf(nearest)) << x << " " << y;
    if (top == discs.rend()) continue;
    EXPECT_NEAR(top->x, expected.x, 0.051);
    EXPECT_NEAR(top->y, expected.y, 0.051);
    ++decided;
  }
  EXPECT_GT(decided, 500);
}

TEST(Picture, LeavesOutWhatCannotBeSeenAndStaysSmall) {
  Spheres<3> spheres;
  for (int i = 0; i < 31 * 31 * 31; ++i) {
    spheres.push_back({0.5 + i % 31, 0.5 + i / 31 % 31, 0.5 + i / 961}, 0.5);
  }
  const std::string svg = svg_of(spheres, Box{Vector<3>::Zero(), Vector<3>::Constant(31)}, "mm");
  EXPECT_LT(svg.size(), 1'500'000u);
  const std::size_t drawn = painted(svg).size();
  // Of a simple cubic block one sees the three faces towards the eye and some way down between the spheres.
  EXPECT_GE(drawn, 3u * 31 * 31 - 3 * 31 + 1);
  EXPECT_LT(drawn, 4u * 3 * 31 * 31);
}

TEST(Picture, ShowsASphereHoweverSmall) {
  Spheres<3> spheres;
  spheres.push_back({5, 5, 5}, 1e-6);
  EXPECT_EQ(painted(svg_of(spheres, box, "mm")).size(), 1u);
  spheres.push_back(spheres.center(0) + 2 * View::towards_eye(), 1);  // and not when one stands before it
  EXPECT_EQ(painted(svg_of(spheres, box, "mm")).size(), 1u);
}

TEST(Picture, OutlinesOfABoxAreItsTwelveEdges) {
  const Mesh mesh = drawable_mesh(box);
  const View view(mesh.vertices, 1000, 12, 480);
  double shown = 0, hidden = 0;
  for (const Stroke& s : outline_of(mesh, view)) {
    (s.hidden ? hidden : shown) += std::hypot(s.to.x - s.from.x, s.to.y - s.from.y);
  }
  // From above and the side nine edges are seen and three, which meet in the far lower corner, are not. By
  // parallel projection the edges come in three sets of four of equal length: hidden is a third of shown.
  EXPECT_NEAR(hidden / shown, 1.0 / 3.0, 0.01);
}

TEST(Picture, OfATiltedBoxIsThatOfItsCell) {
  const Box tilted = periodic_box(Vector<3>(10, 8, 6), {}, {4, -3, 2});
  const Mesh mesh = drawable_mesh(tilted);
  EXPECT_NEAR(volume_of(Domain(mesh)), 480, 1e-9);
  const Vector<3> far_end(10 + 4 - 3, 8 + 2, 6);
  EXPECT_TRUE(
      std::ranges::any_of(mesh.vertices, [&](const Vector<3>& v) { return (v - far_end).norm() < 1e-12; }));
  // A sphere of the brick that lies outside of the cell is drawn where its image in the cell lies.
  Spheres<dynamic> in_brick(3), in_cell(3);
  in_brick.push_back(Vector<3>(1, 7, 0.5), 0.5);
  in_cell.push_back(Vector<3>(11, 7, 0.5), 0.5);
  const auto at = painted(svg_of(in_brick, tilted, "mm")), there = painted(svg_of(in_cell, tilted, "mm"));
  ASSERT_EQ(at.size(), 1u);
  EXPECT_EQ(at[0].x, there.at(0).x);
  EXPECT_EQ(at[0].y, there.at(0).y);
}

TEST(Picture, ShowsDiscsInTheCellOfATiltedBox) {
  const Box tilted = periodic_box(Vector<2>(10, 8), {}, {4, 0, 0});
  Spheres<2> discs;
  discs.push_back({7, 4}, 1);      // in the middle
  discs.push_back({0.5, 7.9}, 1);  // at the upper side, left of the cell: its images at both sides
  const std::string svg = svg_of(discs, tilted, "mm");
  const std::string clipped = svg.substr(svg.find("clip-path="));
  EXPECT_EQ(painted(clipped).size(), 1u + 2);
  // Of the outline's four corners none is above another, as in the brick.
  static const std::regex corner("[ML]([0-9.]+) ([0-9.]+)");
  const std::string path = svg.substr(svg.find(" d=\"") + 4, 200);
  std::vector<double> x;
  for (std::sregex_iterator it(path.begin(), path.end(), corner), end; it != end && x.size() < 4; ++it)
    x.push_back(std::stod((*it)[1]));
  ASSERT_EQ(x.size(), 4u);
  EXPECT_NEAR((x[3] - x[0]) / (x[1] - x[0]), 0.4, 1e-3);
}

TEST(Picture, EveryContainerIsClosedAndSeenFromOutside) {
  for (const Domain& shape :
       {Domain(box), Domain(Cylinder{{1, 2, 3}, {1, 1, 2}, 2, 7}), Domain(Sphere{{5, 5, 5}, 3})}) {
    const Mesh mesh = drawable_mesh(shape);
    EXPECT_GT(volume_of(Domain(mesh)), 0) << kind_of(shape);
    const View view(mesh.vertices, 1000, 12, 480);
    EXPECT_FALSE(outline_of(mesh, view).empty());
    for (const Vector<3>& vertex : mesh.vertices) {
      const CanvasPoint p = view(vertex);
      EXPECT_GE(p.x, 11.999);
      EXPECT_LE(p.x, view.width() - 11.999);
      EXPECT_GE(p.y, 11.999);
      EXPECT_LE(p.y, view.height() - 11.999);
    }
  }
}

TEST(Picture, DoesNotDependOnTheUnitOrThePlace) {
  const Spheres<3> spheres = scattered(200, 0.2, 1, bounds_of(box), 3, true);
  const std::string here = svg_of(spheres, box, "mm");
  const double scale = 0x1p-40;
  Spheres<3> moved;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    moved.push_back(scale * spheres.center(i), scale * spheres.r[i]);
  const std::string there = svg_of(moved, Box{scale * box.corner, scale * box.size}, "mm");
  EXPECT_EQ(painted(here).size(), painted(there).size());
  EXPECT_EQ(here.substr(0, here.find("<g font-family")), there.substr(0, there.find("<g font-family")));
}

TEST(Picture, ShowsDiscsAndTheImagesThatReachIntoTheBox) {
  // In the middle; across one side, so twice; in a corner, so four times. What crosses the frame is drawn
  // once more, faintly, beyond it.
  Spheres<2> discs;
  discs.push_back({5, 5}, 1);
  discs.push_back({0.5, 5}, 1);
  discs.push_back({9.9, 9.9}, 1);
  const Box square = periodic_box(Vector<2>(10, 10));
  const std::string svg = svg_of(discs, square, "mm");
  EXPECT_EQ(painted(svg).size(), 1u + 2 + 4 + 2 + 4);
  const std::string clipped = svg.substr(svg.find("clip-path="));
  EXPECT_EQ(painted(clipped).size(), 1u + 2 + 4);
  // Up is up: the second axis points against the canvas.
  Spheres<2> low;
  low.push_back({5, 2}, 1);
  EXPECT_GT(painted(svg_of(low, square, "mm")).front().y, painted(svg).front().y);
}

/// The ends of the key are the least and the greatest radius, however few spheres have them.
TEST(Picture, KeyNamesTheSmallestAndTheLargest) {
  const auto key = [](const Spheres<2>& discs) {
    const std::string svg = svg_of(discs, periodic_box(Vector<2>(40, 40)), "mm");
    return svg.substr(svg.find("<g font-family"));
  };
  Spheres<2> discs;
  for (int i = 0; i < 40 * 40; ++i) discs.push_back({i % 40 + 0.5, i / 40 + 0.5}, 0.15);
  EXPECT_NE(key(discs).find(">radius 0.15 mm<"), std::string::npos) << key(discs);
  discs.push_back({20, 20}, 0.3);
  EXPECT_NE(key(discs).find(">radius 0.15<"), std::string::npos) << key(discs);
  EXPECT_NE(key(discs).find(">0.3 mm<"), std::string::npos) << key(discs);
  discs.push_back({30, 20}, 0.01);
  EXPECT_NE(key(discs).find(">radius 0.01<"), std::string::npos) << key(discs);
  Spheres<2> near;
  near.push_back({1, 1}, 1);
  near.push_back({5, 5}, 1.002);
  EXPECT_NE(key(near).find(">1.002 mm<"), std::string::npos) << key(near);
}

TEST(Picture, OfVeryManyDiscsShowsAPart) {
  Spheres<2> discs;
  for (int i = 0; i < 400 * 400; ++i) discs.push_back({i % 400 + 0.5, i / 400 + 0.5}, 0.5);
  const std::string svg = svg_of(discs, periodic_box(Vector<2>(400, 400)), "mm");
  EXPECT_LT(svg.size(), 2'000'000u);
  EXPECT_NE(svg.find("a corner of the box"), std::string::npos);
}

TEST(Picture, ThereIsNoneOfOtherDimensions) {
  EXPECT_EQ(svg_of(Spheres<1>{}, periodic_box(Vector<1>(1)), "mm"), "");
  EXPECT_EQ(svg_of(Spheres<4>{}, periodic_box(Vector<4>(1, 1, 1, 1)), "mm"), "");
}

TEST(Picture, OfAPeriodicBoxHoldsWhatSticksOut) {
  Spheres<3> spheres;
  for (int corner = 0; corner < 8; ++corner)
    spheres.push_back(Vector<3>(corner & 1, corner >> 1 & 1, corner >> 2) * 9.99, 2);
  const std::string svg = svg_of(spheres, periodic_box(Vector<3>(10, 10, 10)), "mm");
  for (const Disc& d : painted(svg)) {
    EXPECT_GE(d.x - d.r, 0);
    EXPECT_LE(d.x + d.r, 1000);
    EXPECT_GE(d.y - d.r, 0);
    EXPECT_LE(d.y + d.r, 1000);
  }
}

TEST(Picture, OfAPeriodicCylinderHoldsWhatSticksOutAtItsEnds) {
  Spheres<3> spheres;
  for (int i = 0; i < 5; ++i) spheres.push_back({3, -1, 2.0 + 1.99 * i}, 2);
  const std::string svg = svg_of(spheres, Cylinder{{3, -1, 2}, {0, 0, 1}, 2, 8, true}, "mm");
  ASSERT_EQ(painted(svg).size(), 5u);
  for (const Disc& d : painted(svg)) {
    EXPECT_GE(d.x - d.r, 0);
    EXPECT_LE(d.x + d.r, 1000);
    EXPECT_GE(d.y - d.r, 0);
    EXPECT_LE(d.y + d.r, 1000);
  }
}

TEST(Picture, OfABoxOfTwoDimensionsDoesNotDependOnItsPlace) {
  Spheres<2> here, there;
  for (const Vector<2>& c : {Vector<2>(0.5, 5), {3, 9.75}, {6, 1}}) {
    here.push_back(c, 1);
    there.push_back(c + Vector<2>(64, -32), 1);
  }
  const std::vector<bool> periodic = {true, false};
  EXPECT_EQ(svg_of(there, Box{{64, -32}, {10, 10}, periodic}, "mm"),
            svg_of(here, Box{{0, 0}, {10, 10}, periodic}, "mm"));
}

TEST(DepthBuffer, HidesABallOnlyBehindWhatCoversAllOfIt) {
  DepthBuffer buffer(100, 100, 0.5);
  EXPECT_FALSE(buffer.hides_ball({50, 50, 0}, 10));
  buffer.draw_ball({50, 50, 0}, 30, 0);
  EXPECT_TRUE(buffer.hides_ball({50, 50, -20}, 10));
  EXPECT_FALSE(buffer.hides_ball({50, 50, 25}, 10));    // sticks out towards the eye
  EXPECT_FALSE(buffer.hides_ball({75, 50, -20}, 10));   // and sideways
  EXPECT_FALSE(buffer.hides_ball({-50, 50, -20}, 10));  // off the canvas there is nothing to hide behind
}

}  // namespace picture_test
}  // namespace bernal
