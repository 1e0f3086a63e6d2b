#include "surfaces/cut_ball.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <vector>

// The eight parts of a ball that three ends of periods cut, as they are written for periodic boxes.
namespace bernal {
namespace cut_ball_test {

using PlacesOfCorners = std::set<std::array<double, 3>>;

struct Part {
  bool closes = true;
  std::array<PlacesOfCorners, 3> in_plane;  // the corners of its faces there
  double volume = 0, farthest_beyond = 0;   // of a corner, beyond a plane
};

Part part_of_ball(int frequency, double radius, const std::vector<BallPlane>& planes, int which) {
  CutBall ball(frequency, radius, planes);
  Part part;
  for (int k = 0; k < 3; ++k) part.closes = part.closes && ball.cut(k, (which >> k & 1) != 0);
  const auto place = [&](std::uint32_t v) -> const Vector<3>& { return ball.corners()[v].place; };
  for (const CutBall::Face& face : ball.faces()) {
    for (const std::uint32_t v : face.corners) {
      if (face.plane >= 0)
        part.in_plane[static_cast<std::size_t>(face.plane)].insert({place(v)[0], place(v)[1], place(v)[2]});
      for (int k = 0; k < 3; ++k) {
        const double side = (which >> k & 1) != 0 ? 1 : -1;
        const BallPlane& plane = planes[static_cast<std::size_t>(k)];
        const double beyond = side * (plane.normal.dot(place(v)) - plane.offset);
        part.farthest_beyond = std::max(part.farthest_beyond, beyond);
      }
      EXPECT_LE(place(v).norm(), radius * (1 + 1e-12));
    }
    for (const auto& [a, b, c] : ball.triangles_of(face))
      part.volume += place(a).dot(place(b).cross(place(c))) / 6;
  }
  return part;
}

std::vector<BallPlane> ends_at(double x, double y, double z) {
  return {{Vector<3>::UnitX(), x, 0}, {Vector<3>::UnitY(), y, 2}, {Vector<3>::UnitZ(), z, 4}};
}

/// A corner near one end moves out along the sphere to lie on it, and came to lie beyond another end.
TEST(CutBall, CornersNearAnEdgeStayWithinBothEnds) {
  const auto planes = ends_at(-2.3260229034349327, -3.0977386515587573, 4.94932529982174);
  for (int which = 0; which < 8; ++which)
    EXPECT_LE(part_of_ball(5, 5.99992, planes, which).farthest_beyond, 0) << which;
}

/// Three corners were near one end, all came to lie in it, and the face was lost to both halves.
TEST(CutBall, NoFaceOfTheSphereComesToLieInAnEnd) {
  const auto planes = ends_at(0, 7.98542748671025, 0);
  std::array<PlacesOfCorners, 2> polygon;
  for (const bool below : {false, true}) {
    CutBall ball(5, 9.99992, planes);
    ASSERT_TRUE(ball.cut(1, below));
    for (const CutBall::Face& face : ball.faces())
      for (const std::uint32_t v : face.corners)
        if (const Vector<3>& p = ball.corners()[v].place; face.plane == 1)
          polygon[below ? 1 : 0].insert({p[0], p[1], p[2]});
  }
  EXPECT_EQ(polygon[0], polygon[1]);
  EXPECT_GE(polygon[0].size(), 18u);
}

TEST(CutBall, PartsStayWithinTheirEndsMeetInTheSamePolygonsAndMakeUpTheBall) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> end(-1.02, 1.02);
  int cut = 0, apart = 0;
  constexpr int balls = 1000;
  for (int n = 0; n < balls; ++n) {
    const auto planes = ends_at(end(random), end(random), end(random));
    const int frequency = 3 + n % 4;
    Part all;
    std::array<Part, 8> parts;
    for (int which = 0; which < 8; ++which) {
      const Part& part = parts[static_cast<std::size_t>(which)] = part_of_ball(frequency, 1, planes, which);
      all.closes = all.closes && part.closes;
      all.volume += part.volume;
      all.farthest_beyond = std::max(all.farthest_beyond, part.farthest_beyond);
    }
    if (!all.closes) continue;  // another frequency is tried
    ++cut;
    ASSERT_LE(all.farthest_beyond, 1e-15) << n;
    const double whole = icosphere(frequency).volume;
    ASSERT_GE(all.volume, 0.97 * whole) << n;
    ASSERT_LE(all.volume, 4.18879020478640) << n;
    bool meets = true;
    for (std::size_t which = 0; which < 8; ++which)
      for (std::size_t k = 0; k < 3; ++k)
        meets = meets && parts[which].in_plane[k] == parts[which ^ std::size_t{1} << k].in_plane[k];
    apart += !meets;
  }
  EXPECT_GE(cut, 0.99 * balls);
  EXPECT_LE(apart, 0.01 * balls);  // by slivers, and another frequency is tried
}

}  // namespace cut_ball_test
}  // namespace bernal
