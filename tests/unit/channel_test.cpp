// Meshes that repeat themselves: their walls, and their certificate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "geometry/measures.hpp"
#include "geometry/openings.hpp"
#include "support/channels.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace channel_test {

using test::closed_channel;
using test::corrugated_channel;
using test::repeating;
using test::spheres;
using test::void_of_gyroid;
using test::void_of_simple_cubic;

constexpr double pi = std::numbers::pi;

struct Named {
  std::string name;
  Mesh mesh;
  friend void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }
};

/// Periods that are long and short beside the width, of one axis, two and three.
std::vector<Named> channels() {
  const auto square = [](double, double) { return std::sqrt(2.0); };
  Mesh slit = test::box_mesh({0, 0, 0}, {2, 3, 1});
  return {{"Square", repeating(closed_channel(square, 4, 1, 0, 3))},
          {"Corrugated", repeating(corrugated_channel())},
          {"ShortWaves", repeating(corrugated_channel(100, 0.5))},
          {"LongWaves", repeating(corrugated_channel(-3e3, 16))},
          {"Slit", repeating(slit, {true, true, false})},
          {"SimpleCubic", repeating(void_of_simple_cubic(6), {true, true, true})},
          {"Gyroid", repeating(void_of_gyroid(6), {true, true, true})},
          {"GyroidAlongX", repeating(void_of_gyroid(6), {true, false, false})}};
}

class Channels : public ::testing::TestWithParam<Named> {
 protected:
  const Mesh& mesh() const { return GetParam().mesh; }
  Bounds<3> bounds() const { return bounds_of(mesh()); }
  /// In the period and several before and behind it.
  Vector<3> random_point(double periods) {
    Vector<3> p = uniform_point<3>(random, bounds());
    for (int k = 0; k < 3; ++k)
      if (mesh().periodic[static_cast<std::size_t>(k)])
        p[k] += std::floor(random.uniform(-periods, periods)) * bounds().size()[k];
    return p;
  }
  std::array<int, 3> images(double reach) const {
    std::array<int, 3> all{};
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh().periodic[k])
        all[k] = 1 + static_cast<int>(std::ceil(reach / bounds().size()[static_cast<int>(k)]));
    return all;
  }
  template <class Visit>
  void for_each_wall_within(const Vector<3>& p, double reach, const Visit& visit) const {
    const Boundary<3> boundary = boundary_of<3>(mesh());
    const Vector<3> home = boundary.wrap(p), shift = p - home;
    const std::array<int, 3> more = images(reach);
    for (const FaceCorners& t : triangles_of_walls(mesh()))
      for (int x = -more[0]; x <= more[0]; ++x)
        for (int y = -more[1]; y <= more[1]; ++y)
          for (int z = -more[2]; z <= more[2]; ++z) {
            const Vector<3> by = shift + boundary.edges.cwiseProduct(Vector<3>(x, y, z));
            const Facet facet{.kind = Facet::Kind::triangle,
                              .a = mesh().vertices[t[0]] + by,
                              .b = mesh().vertices[t[1]] + by,
                              .c = mesh().vertices[t[2]] + by};
            if (const double d = distance(facet, p); reach == 0 || d < reach) visit(d);
          }
  }
  /// The nearest point of a wall is at most half a period away along an axis that has one.
  double distance_from_walls(const Vector<3>& p) const {
    double least = 2 * bounds().diagonal();
    for_each_wall_within(p, 0, [&](double d) { least = std::min(least, d); });
    return least;
  }
  double rounding() const {
    return 64 * 2.3e-16 *
               std::max(bounds().lower.cwiseAbs().maxCoeff(), bounds().upper.cwiseAbs().maxCoeff()) +
           1e-14;
  }

  Random random{7, stream(Stream::test)};
  std::unique_ptr<Container> container = make_mesh_container(mesh(), WallArithmetic::filtered, 0);
};

TEST_P(Channels, ClearanceIsTheDistanceFromAllImages) {
  std::unique_ptr<Container> closed = make_mesh_container(
      [&] {
        Mesh copy = mesh();
        copy.periodic = {};
        return copy;
      }(),
      WallArithmetic::exact, 0);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector<3> p = random_point(4);
    const double away = distance_from_walls(p);
    // Within the period, the side is that of the closed solid.
    const double side = closed->clearance(boundary_of<3>(mesh()).wrap(p)) >= 0 ? 1 : -1;
    ASSERT_NEAR(container->clearance(p), side * away, rounding()) << p.transpose();
    ASSERT_NEAR(container->clearance_within(p, 0.1), std::min(0.1, side * away), rounding());
    const double r = 0.8 * random.uniform() * away;
    if (side > 0) {
      ASSERT_TRUE(container->contains(p, std::max(0.0, r - rounding())));
      ASSERT_FALSE(container->contains(p, away + rounding()));
      ++inside;
    }
  }
  EXPECT_GT(inside, 20);
}

TEST_P(Channels, GiveTheFacetsOfAllImagesHoweverFar) {
  for (int i = 0; i < 8; ++i) {
    const Vector<3> p = random_point(3);
    for (const double reach : {0.2, 0.7, 3.0}) {
      std::vector<double> distances;
      for_each_wall_within(p, reach, [&](double d) { distances.push_back(d); });
      std::ranges::sort(distances);
      std::vector<NearFacet> facets;
      container->facets_near(p, reach, facets);
      ASSERT_EQ(facets.size(), distances.size()) << reach << " at " << p.transpose();
      for (std::size_t k = 0; k < facets.size(); ++k) {
        ASSERT_NEAR(facets[k].distance, distances[k], rounding());
        ASSERT_NEAR(distance(facets[k].facet, p), facets[k].distance, rounding());
      }
    }
  }
}

TEST_P(Channels, AreLeftByNobodyOnAnyWay) {
  int met = 0;
  for (int i = 0; i < 60; ++i) {
    const Vector<3> p = random_point(2);
    const double clearance = container->clearance(p);
    if (!(clearance > 0.02)) continue;
    const double r = random.uniform(0.1, 0.7) * clearance, limit = 9;
    const Vector<3> direction = uniform_direction<3>(random);
    for (const bool skin : {false, true}) {
      const double path = skin ? container->first_contact(p, r, direction, limit)
                               : container->free_path(p, r, direction, limit);
      ASSERT_LE(path, limit);
      for (int step = 0; step <= 40; ++step)
        ASSERT_GE(container->clearance(p + path * step / 40 * direction), r - 1e-9);
      if (path == limit) continue;
      ++met;
      EXPECT_NEAR(container->clearance(p + path * direction), r, 1e-6);
      EXPECT_LT(container->clearance(p + (path + 1e-4) * direction), r);
    }
  }
  EXPECT_GT(met, 10);
}

TEST_P(Channels, VolumeAndAreaAreThoseOfOnePeriod) {
  int inside = 0;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) inside += container->clearance(uniform_point<3>(random, bounds())) > 0;
  const double share = volume_of(mesh()) / bounds().volume();
  EXPECT_NEAR(static_cast<double>(inside) / n, share, 4 * std::sqrt(share * (1 - share) / n) + 1e-12);
  EXPECT_EQ(container->volume(), volume_of(mesh()));
  EXPECT_NEAR(area_of(Domain(mesh())), area_of(mesh(), triangles_of_walls(mesh())), 1e-12);
  EXPECT_LT(area_of(Domain(mesh())), area_of(mesh()));
}

// Also where the ball stands for one in another period, and reaches into the next.
TEST_P(Channels, TheCertificateDecidesAsTheDistancesDo) {
  const Boundary<3> boundary = boundary_of<3>(mesh());
  double half = 1e9;  // of the shortest period: wider ones meet themselves
  for (const double period : boundary.edges)
    if (period > 0) half = std::min(half, 0.49 * period);
  Spheres<dynamic> balls(3);
  std::vector<bool> fits;
  for (int i = 0; i < 100; ++i) {
    const Vector<3> p = random_point(3);
    const double clearance = container->clearance(p);
    for (const double factor : {0.3, 1 - 1e-9, 1 + 1e-9, 1.5}) {
      const double r = factor * std::abs(clearance);
      if (!(r > 1e-6 && r < half)) continue;
      balls.push_back(p, r);
      fits.push_back(clearance > 0 && factor < 1);
    }
  }
  const Certificate c = certify(balls, mesh(), {.list = balls.size()});
  std::vector<bool> inside(balls.size(), true);
  for (const auto& protrusion : c.protrusions) inside[protrusion.sphere] = false;
  EXPECT_EQ(c.protruding_spheres, c.protrusions.size());
  EXPECT_EQ(inside, fits);
  EXPECT_GT(std::ranges::count(fits, true), 10);
  EXPECT_GT(std::ranges::count(fits, false), 10);
}

INSTANTIATE_TEST_SUITE_P(All, Channels, ::testing::ValuesIn(channels()),
                         [](const auto& named) { return named.param.name; });

TEST(ChannelCertificate, RefusesASphereInTheWallOfTheNextPeriodAndAnOverlapThroughTheEnd) {
  // A neck of radius 0.75 in the middle of the period, at z = 0; 1.25 at its ends, z = ±1.5.
  const Domain channel = repeating(corrugated_channel());
  const double neck = std::cos(pi / 12) * 0.75;
  EXPECT_TRUE(certify(spheres({{0, 0, 0, 0.9 * neck}}), channel).certified);
  // Half a period further there is room, and at the next neck, through the end, there is none.
  EXPECT_TRUE(certify(spheres({{0, 0.4, 1.5, 0.6}}), channel).certified);
  EXPECT_FALSE(certify(spheres({{0, 0.4, 3, 0.6}}), channel).certified);
  EXPECT_FALSE(certify(spheres({{0, 0.4, 3e6, 0.6}}), channel).certified);
  EXPECT_TRUE(certify(spheres({{0, 0.4, 3e6 + 1.5, 0.6}}), channel).certified);
  // It reaches the neck of the next period only.
  const double touching = [] {
    double low = 0, high = 1.5;  // how far beyond the end
    const auto walls = make_mesh_container(repeating(corrugated_channel()), WallArithmetic::exact, 0);
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (walls->contains({0.2, 0, 1.5 + middle}, 0.7) ? low : high) = middle;
    }
    return low;
  }();
  ASSERT_GT(touching, 0.1);
  EXPECT_TRUE(certify(spheres({{0.2, 0, 1.5 + touching - 1e-9, 0.7}}), channel).certified);
  EXPECT_FALSE(certify(spheres({{0.2, 0, 1.5 + touching + 1e-9, 0.7}}), channel).certified);

  // Two that touch through the end: 1.4375 + 1.4375 + 0.125 = 3.
  EXPECT_TRUE(certify(spheres({{0, 0, -1.4375, 0.0625}, {0, 0, 1.4375, 0.0625}}), channel).certified);
  const Certificate c =
      certify(spheres({{0, 0, -1.4375, 0.0625}, {0, 0, std::nextafter(1.4375, 2), 0.0625}}), channel);
  EXPECT_FALSE(c.certified);
  EXPECT_EQ(c.overlapping_pairs, 1u);
  EXPECT_EQ(c.protruding_spheres, 0u);
  EXPECT_NE(c.statement.find("overlapping pair"), std::string::npos) << c.statement;
}

TEST(ChannelCertificate, IsExactAtAWallOfASquareChannel) {
  const Domain channel = repeating(test::box_mesh({0, 0, 0}, {4, 4, 8}));
  const Domain box = Box{Vector<3>(0, 0, 0), Vector<3>(4, 4, 8), {false, false, true}};
  for (const double x : {1.0, std::nextafter(1.0, 0), std::nextafter(1.0, 2)})
    for (const double z : {-9.0, 0.0, 0.5, 8.0, 8.5, 1e9}) {
      const Spheres<dynamic> one = spheres({{x, 2, z, 1}});
      EXPECT_EQ(certify(one, channel).certified, x >= 1) << x << " " << z;
      EXPECT_EQ(certify(one, box).certified, x >= 1);
    }
  EXPECT_EQ(kind_of(channel), "mesh");
  EXPECT_EQ(name_of(channel), "periodic mesh");
  EXPECT_TRUE(is_periodic(channel));
  EXPECT_EQ(volume_of(channel), 128);
  EXPECT_EQ(area_of(channel), 128);
  EXPECT_EQ(boundary_of<3>(channel).edges, Vector<3>(0, 0, 8));
}

// What the certificate cannot decide exactly, or what is no channel, it says.
TEST(ChannelCertificate, RefusesWhatIsNoChannel) {
  const auto refusal = [](const Mesh& mesh) -> std::string {
    try {
      certify(spheres({{0, 0, 0, 0.1}}), mesh);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Mesh shifted = repeating(corrugated_channel());
  ASSERT_EQ(refusal(shifted), "");
  for (Vector<3>& v : shifted.vertices)
    if (v[2] == 1.5) v[0] += 1e-9;
  EXPECT_NE(refusal(shifted).find("not closed"), std::string::npos) << refusal(shifted);
  Mesh rough = repeating(corrugated_channel());
  for (Vector<3>& v : rough.vertices) v[2] = v[2] * 1.1 + 0.1 / 3;
  EXPECT_NE(refusal(rough).find("exactly"), std::string::npos) << refusal(rough);
  Mesh nothing = test::box_mesh({0, 0, 0}, {1, 1, 1});
  nothing.periodic = {true, true, true};
  EXPECT_NE(refusal(nothing).find("no walls"), std::string::npos) << refusal(nothing);
}

// The frame of the packer keeps the period, and corners plus periods, exactly.
TEST(ChannelFrame, KeepsThePeriodExactly) {
  for (const auto& [lower, period] :
       {std::pair(0.1, 1.7), std::pair(-1e4 / 3, 0.31), std::pair(1e-7, 1e-3)}) {
    Mesh mesh = corrugated_channel(0, 1);
    for (Vector<3>& v : mesh.vertices) v = Vector<3>(v[0], v[1], lower + period * v[2]);
    if (period < 1)
      for (Vector<3>& v : mesh.vertices) v.head<2>() *= period;
    const Domain channel = repeating(mesh);
    const Frame frame = frame_of(channel);
    const Mesh local = std::get<Mesh>(to_local(channel, frame));
    const Bounds<3> bounds = bounds_of(local);
    EXPECT_EQ(boundary_of<3>(local).edges[2] * frame.scale, boundary_of<3>(channel).edges[2]);
    for (const Vector<3>& v : local.vertices)
      for (const int k : {-16, -1, 1, 16}) {
        const long double exact =
            static_cast<long double>(v[2]) + k * static_cast<long double>(bounds.size()[2]);
        EXPECT_EQ(static_cast<long double>(static_cast<double>(exact)), exact);
      }
    EXPECT_NO_THROW(certify(Spheres<dynamic>(3), local));
    EXPECT_NO_THROW(certify(spheres({{0, 0, 0, 1e-9}}), local));
  }
}

}  // namespace channel_test
}  // namespace bernal
