// What meshers are given: the pieces of every ball make up the ball, contacts are what they are said to be.
#include "solids/solids.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <numbers>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "solids/narrow_places.hpp"
#include "support/ball_in_box.hpp"
#include "support/export_packings.hpp"

namespace bernal {
namespace solids_test {

using testing::exports::in_cylinder;
using testing::exports::packing_in;
using Rational = boost::multiprecision::cpp_rational;

/// Spheres that fill a periodic box to its ends and touch there and inside: a lattice, a little disturbed.
Packing lattice(std::uint64_t seed, const std::vector<bool>& walls = {}) {
  Packing packing = testing::exports::periodic();
  const Vector<3> edges(4, 5, 6);
  Random random(seed, stream(Stream::test));
  Spheres<3> spheres;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 6; ++z) {
        const double r = (x + y + z) % 2 ? 0.5 : 0.5 - 0.02 * random.uniform();
        const Vector<3> at(x + 0.5, y + 0.5, z + 0.5);
        spheres.push_back(at, r);
      }
  // One shift for all along axes that repeat themselves: cuts of every kind.
  for (std::size_t k = 0; k < 3; ++k) {
    const double shift = k < walls.size() && walls[k] ? 0 : random.uniform();
    for (double& c : spheres.x[k]) c += shift;
  }
  packing.spheres = spheres;
  packing.domain = periodic_box(edges, walls);
  packing.volume = volume_of(packing.domain);
  wrap(packing.spheres, packing.domain);
  return packing;
}

std::vector<Packing> periodic_packings() {
  return {lattice(1), lattice(2, {false, false, true}), lattice(3, {true, false, true}),
          testing::exports::periodic()};
}

/// The solids with the periods where they are.
Solids solids_in_place(const Packing& packing) {
  Solids made{
      .spheres = packing.spheres, .domain = packing.domain, .pieces = {}, .bridges = {}, .contacts = {}};
  wrap(made.spheres, made.domain);
  made.pieces = pieces_of(made.spheres, made.domain);
  return made;
}

double volume_between_ends(const Piece& piece) {
  Bounds<3> box{piece.center - Vector<3>::Constant(2 * piece.radius),
                piece.center + Vector<3>::Constant(2 * piece.radius)};
  for (const Cut& cut : piece.cuts) {
    if (cut.face == Cut::contact) continue;
    const int axis = cut.face / 2;
    (cut.face % 2 == 0 ? box.lower : box.upper)[axis] = cut.keeps.normal[axis] * cut.keeps.offset;
  }
  return testing::ball_in_box(piece.center, piece.radius, box);
}

double volume_of_balls_by_hand(const Spheres<dynamic>& spheres) {
  double sum = 0;
  for (const double r : spheres.r) sum += 4. / 3 * std::numbers::pi * r * r * r;
  return sum;
}

TEST(Solids, PiecesMakeUpTheBalls) {
  for (const Packing& packing : periodic_packings())
    for (const Solids& solids : {solids_in_place(packing), solids_of(packing.spheres, packing.domain, {})}) {
      double sum = 0;
      for (const Piece& piece : solids.pieces) sum += volume_between_ends(piece);
      // A few roundoffs a piece.
      EXPECT_NEAR(sum / volume_of_balls_by_hand(packing.spheres), 1, 1e-12);
      EXPECT_EQ(solids.contacts.change_of_porosity(), 0);
    }
}

TEST(Solids, WhatOneEndCutsOffStandsAtTheOther) {
  std::size_t cuts = 0;
  for (const Packing& packing : periodic_packings()) {
    const Solids solids = solids_in_place(packing);
    const Boundary<3> boundary = boundary_of<3>(solids.domain);
    for (const Piece& piece : solids.pieces)
      for (const Cut& cut : piece.cuts) {
        ++cuts;
        const int axis = cut.face / 2, along = cut.face % 2 == 0 ? 1 : -1;
        Vector<3> beyond = piece.center;
        beyond[axis] += along * boundary.edges[axis];
        // Beside an edge what stands in the domain need not reach the plane that crosses the ball.
        double squared = 0;
        for (int k = 0; k < 3; ++k)
          if (boundary.repeats(k))
            squared += std::pow(std::max({0.0, boundary.origin[k] - beyond[k],
                                          beyond[k] - boundary.origin[k] - boundary.edges[k]}),
                                2);
        if (squared > piece.radius * piece.radius * (1 - 1e-9)) continue;
        const auto twin = std::ranges::find_if(solids.pieces, [&](const Piece& other) {
          return other.sphere == piece.sphere && (other.center - beyond).norm() < 1e-12;
        });
        ASSERT_NE(twin, solids.pieces.end());
        const auto opposite =
            std::ranges::find_if(twin->cuts, [&](const Cut& c) { return c.face == (cut.face ^ 1); });
        ASSERT_NE(opposite, twin->cuts.end());
        EXPECT_EQ(opposite->keeps.normal, -cut.keeps.normal);
      }
    // Seams are those of the sphere, wherever its image stands.
    const std::vector<Seam> seams = seams_of(solids);
    for (std::size_t a = 0; a < seams.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (solids.pieces[a].sphere == solids.pieces[b].sphere) {
          EXPECT_EQ(seams[a].pole, seams[b].pole);
          EXPECT_EQ(seams[a].meridian, seams[b].meridian);
        }
  }
  EXPECT_GT(cuts, 100u);
}

/// In rational arithmetic, over all images: the doubles are what they are.
void expect_exact_gap(const Spheres<dynamic>& spheres, const Domain& domain, double gap) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  const auto* box = std::get_if<Box>(&domain);
  ASSERT_NE(box, nullptr);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (boundary.repeats(k)) continue;
      const Rational c(spheres.x[static_cast<std::size_t>(k)][i]), r(spheres.r[i]),
          wide = r * (1 + Rational(gap));
      EXPECT_GE(c - Rational(box->corner[k]), wide);
      EXPECT_GE(Rational(box->corner[k] + box->size[k]) - c, wide);
    }
    for (std::size_t j = 0; j <= i; ++j) {
      const Rational least = (Rational(spheres.r[i]) + Rational(spheres.r[j])) * (1 + Rational(gap));
      for (int m = 0; m < 27; ++m) {
        const std::array<int, 3> image = {m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
        if (i == j && m == 13) continue;
        Rational squared = 0;
        bool exists = true;
        double about = 0;
        for (std::size_t k = 0; k < 3; ++k)
          about +=
              std::pow(spheres.x[k][i] - spheres.x[k][j] + image[k] * boundary.edges[static_cast<int>(k)], 2);
        const double sum = spheres.r[i] + spheres.r[j];
        if (about > 1.1 * sum * sum) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          exists = exists && (image[k] == 0 || boundary.repeats(static_cast<int>(k)));
          const Rational d = Rational(spheres.x[k][i]) - Rational(spheres.x[k][j]) +
                             image[k] * Rational(boundary.edges[static_cast<int>(k)]);
          squared += d * d;
        }
        if (exists && squared < least * least) ADD_FAILURE() << i << " and " << j;
      }
    }
  }
}

TEST(Solids, ShrinkingLeavesTheGapExactly) {
  for (const ContactTreatment treatment : {ContactTreatment::gap, ContactTreatment::shrink})
    for (const double gap : {0.01, 0.003}) {
      const Packing packing = lattice(4, {false, true, false});
      const Solids solids = solids_of(packing.spheres, packing.domain, {.contact = treatment, .gap = gap});
      expect_exact_gap(solids.spheres, solids.domain, gap);
      EXPECT_EQ(solids.contacts.proven_gap, gap);
      EXPECT_EQ(solids.contacts.changed,
                treatment == ContactTreatment::shrink ? 120u : solids.contacts.changed);
      EXPECT_NEAR(solids.contacts.volume_after, volume_of_balls_by_hand(solids.spheres), 1e-9);
      EXPECT_NEAR(solids.contacts.volume_before, volume_of_balls_by_hand(packing.spheres), 1e-9);
      // No more than that takes: somebody stands at the gap.
      double least = std::numeric_limits<double>::infinity();
      const Boundary<3> boundary = boundary_of<3>(solids.domain);
      for (std::size_t i = 0; i < solids.spheres.size(); ++i) {
        const double y = solids.spheres.x[1][i], r = solids.spheres.r[i];
        least = std::min({least, y / r - 1, (5 - y) / r - 1});
        for (std::size_t j = 0; j < i; ++j) {
          const Vector<3> d = solids.spheres.center(i) - solids.spheres.center(j);
          least = std::min(least, boundary.minimum_image(d).norm() / (r + solids.spheres.r[j]) - 1);
        }
      }
      EXPECT_NEAR(least, gap, 1e-12);
    }
}

TEST(Solids, ShrinkingDependsOnNoOrderAndSparesTheLonely) {
  Packing packing = lattice(5);
  // In the hole between eight of the lattice's spheres.
  packing.spheres.push_back(Vector<3>(packing.spheres.center(0)) + Vector<3>(0.5, 0.5, 0.5), 0.01);
  wrap(packing.spheres, packing.domain);
  Spheres<dynamic> spheres = packing.spheres, reversed = spheres;
  for (auto& column : reversed.x) std::ranges::reverse(column);
  std::ranges::reverse(reversed.r);
  const Domain domain = packing.domain;
  shrink_contacts(spheres, domain, ContactTreatment::gap, 0.01, false);
  shrink_contacts(reversed, domain, ContactTreatment::gap, 0.01, false);
  std::ranges::reverse(reversed.r);
  EXPECT_EQ(spheres.r, reversed.r);
  EXPECT_EQ(spheres.r.back(), 0.01);
}

/// At the gap to the last bit, where rounding has to be made room for; nobody else shrinks for it.
TEST(Solids, StrangersStayWhateverAGapTakes) {
  const Domain box = Box{Vector<3>(-5, -5, -5), Vector<3>(10, 10, 10)};
  for (const double gap : {0.01, 0.02, 0.05}) {
    Spheres<3> three;
    three.push_back({-0.5 * (1 + gap), 0, 0}, 0.5);
    three.push_back({0.5 * (1 + gap), 0, 0}, 0.5);
    three.push_back({0, 3, 0}, 0.5);
    Spheres<dynamic> spheres = three;
    ASSERT_FALSE(has_gap(spheres, box, gap));
    const ContactReport report = shrink_contacts(spheres, box, ContactTreatment::gap, gap, false);
    EXPECT_EQ(spheres.r[2], 0.5);
    EXPECT_EQ(report.changed, 2U);
    EXPECT_LT(report.largest_change, 1e-9);
    expect_exact_gap(spheres, box, gap);
    Spheres<dynamic> all = three;
    shrink_contacts(all, box, ContactTreatment::shrink, gap, false);
    EXPECT_LT(all.r[2], 0.5);
    EXPECT_EQ(all.r[2], all.r[0]);
  }
}

TEST(Solids, ShrinkingKeepsSinglePrecision) {
  const Packing packing = lattice(6);
  Spheres<dynamic> spheres = packing.spheres;
  for (auto& column : spheres.x)
    for (double& x : column) x = static_cast<float>(x);
  for (double& r : spheres.r) r = 0.5 * static_cast<float>(2 * r);
  shrink_contacts(spheres, packing.domain, ContactTreatment::gap, 0.02, true);
  for (const double r : spheres.r) EXPECT_EQ(static_cast<double>(static_cast<float>(2 * r)), 2 * r);
  expect_exact_gap(spheres, packing.domain, 0.02);
}

TEST(Solids, NoShrinkingHelpsASphereOutside) {
  Spheres<3> spheres;
  spheres.push_back({-0.1, 0.5, 0.5}, 0.2);
  Spheres<dynamic> outside = spheres;
  EXPECT_THROW(shrink_contacts(outside, Box{Vector<3>(0, 0, 0), Vector<3>(1, 1, 1)}, ContactTreatment::gap,
                               0.01, false),
               Error);
}

bool holds(const std::vector<Cut>& cuts, const Vector<3>& p) {
  return std::ranges::all_of(cuts,
                             [&](const Cut& cut) { return cut.keeps.normal.dot(p) <= cut.keeps.offset; });
}
bool holds(const Piece& piece, const Vector<3>& p) {
  return (p - piece.center).squaredNorm() <= piece.radius * piece.radius && holds(piece.cuts, p);
}
bool holds(const Solids& solids, const Bridge& bridge, const Vector<3>& p) {
  const Vector<3> along = (bridge.rims[1] - bridge.rims[0]).normalized(), d = p - bridge.rims[0];
  const double h = d.dot(along);
  if (h < -bridge.radius || h > (bridge.rims[1] - bridge.rims[0]).norm() + bridge.radius) return false;
  if ((d - h * along).norm() > bridge.radius || !holds(bridge.cuts, p)) return false;
  for (std::size_t end = 0; end < 2; ++end) {
    const double r = solids.spheres.r[bridge.spheres[end]];
    const double rim = std::sqrt(r * r - bridge.radius * bridge.radius);
    if ((p - bridge.rims[end] - (end == 0 ? -rim : rim) * along).norm() < r) return false;
  }
  return true;
}

/// By Monte Carlo in the whole domain: no point is in two solids, and so many are in one as volumes say.
TEST(Solids, CapsAndBridgesAreWhatTheirVolumesSay) {
  for (const auto& [treatment, gap] :
       {std::pair{ContactTreatment::cap, 0.05}, {ContactTreatment::bridge, 0.02}}) {
    const Packing packing = lattice(7);
    const Solids solids =
        solids_of(packing.spheres, packing.domain, {.contact = treatment, .gap = gap, .bridge_radius = 0.3});
    EXPECT_EQ(solids.contacts.proven_gap, treatment == ContactTreatment::cap ? gap : 0);
    if (treatment == ContactTreatment::bridge) {
      EXPECT_GE(solids.bridges.size(), solids.contacts.pairs);  // those at the ends come twice
    }
    EXPECT_EQ(solids.contacts.meetings, 0u);
    // Of the volume that was changed: points near contacts count, those well inside of spheres do not.
    const Bounds<3> bounds = bounds_of(solids.domain);
    Random random(8, stream(Stream::test));
    constexpr int samples = 40000;
    int inside = 0, before = 0;
    for (int s = 0; s < samples; ++s) {
      const Vector<3> p = uniform_point(random, bounds);
      int in = 0;
      bool in_ball = false;
      for (const Piece& piece : solids.pieces) {
        in += holds(piece, p);
        in_ball = in_ball || (p - piece.center).norm() < piece.radius;
      }
      for (const Bridge& bridge : solids.bridges) in += holds(solids, bridge, p);
      EXPECT_LE(in, 1);
      inside += in;
      before += in_ball;
    }
    const double changed = (solids.contacts.volume_after - solids.contacts.volume_before) / bounds.volume();
    const double found = static_cast<double>(inside - before) / samples;
    // What changes is a share of points p: its standard deviation is sqrt(p / n).
    EXPECT_NEAR(found, changed, 4 * std::sqrt(std::abs(changed) / samples));
    EXPECT_NE(changed, 0);
  }
}

TEST(Solids, CapsAtRoundWallsLeaveTheGap) {
  Spheres<3> spheres;
  spheres.push_back({1.5, 0, 1}, 0.5);
  const Cylinder cylinder{.radius = 2, .height = 3};
  constexpr double gap = 0.02;
  const Solids solids = solids_of(spheres, cylinder, {.contact = ContactTreatment::cap, .gap = gap});
  ASSERT_EQ(solids.pieces.front().cuts.size(), 1u);
  Random random(9, stream(Stream::test));
  for (int s = 0; s < 100000; ++s) {
    Vector<3> v;
    for (int k = 0; k < 3; ++k) v[k] = 2 * random.uniform() - 1;
    const Vector<3> p = Vector<3>(1.5, 0, 1) + 0.5 * v.normalized();
    if (holds(solids.pieces.front(), p)) {
      EXPECT_GE(2 - std::hypot(p[0], p[1]), 0.5 * gap * (1 - 1e-5));
    }
  }
}

TEST(Solids, BridgesTellOfThirdSpheres) {
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 0.5);
  spheres.push_back({2, 1, 1}, 0.5);
  spheres.push_back({1.5, 1.12, 1}, 0.005);
  const Box box{Vector<3>(0, 0, 0), Vector<3>(4, 4, 4)};
  const SolidsOptions options{.contact = ContactTreatment::bridge, .gap = 0.01, .bridge_radius = 0.3};
  EXPECT_EQ(solids_of(spheres, box, options).contacts.meetings, 1u);
  spheres.x[1][2] = 1.3;
  const Solids solids = solids_of(spheres, box, options);
  EXPECT_EQ(solids.contacts.meetings, 0u);
  EXPECT_NEAR(solids.contacts.smallest_angle, 90 + std::asin(0.3) * 180 / std::numbers::pi, 1e-9);
}

TEST(Solids, EndsStayClearOfSpheres) {
  for (const Packing& packing : periodic_packings()) {
    const Boundary<3> given = boundary_of<3>(packing.domain);
    const ClearEnds clear = with_clear_ends(packing.spheres, packing.domain);
    const Boundary<3> moved = boundary_of<3>(clear.domain);
    EXPECT_EQ(moved.edges, given.edges);
    Spheres<dynamic> spheres = packing.spheres;
    wrap(spheres, clear.domain);
    // Over all faces, edges and corners that ends have, by hand.
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres.size(); ++i)
      for (int which = 1; which < 8; ++which)
        for (int side = 0; side < 8; ++side) {
          double squared = 0;
          bool exists = true;
          for (int k = 0; k < 3; ++k) {
            if (!(which >> k & 1)) continue;
            exists = exists && moved.repeats(k);
            const double at = moved.origin[k] + (side >> k & 1 ? moved.edges[k] : 0);
            squared += std::pow(spheres.x[static_cast<std::size_t>(k)][i] - at, 2);
          }
          if (exists) least = std::min(least, std::abs(std::sqrt(squared) - spheres.r[i]) / spheres.r[i]);
        }
    EXPECT_NEAR(clear.distance, least, 1e-9);
    EXPECT_GT(least, 0.005);
  }
}

TEST(Solids, EndsStayClearOfBridgedSpheresToo) {
  Spheres<dynamic> spheres(3);  // rows along a period, shifted so that an end is near one of them everywhere
  for (int k = 0; k < 1728; ++k)
    spheres.push_back(Vector<3>(k % 12 + std::fmod(0.618 * (k / 12), 1.0), k / 12 % 12, k / 144), 0.495);
  const Domain box = Box{Vector<3>(0, -1, -1), Vector<3>(12, 13, 13), {true, false, false}};
  SolidsOptions options{.contact = ContactTreatment::bridge, .gap = 0.05};
  const std::size_t bridges = solids_of(spheres, box, options).bridges.size();
  options.clear_of_ends = true;
  const Solids solids = solids_of(spheres, box, options);
  EXPECT_TRUE(solids.cleared > 0 && solids.bridges.size() == bridges);
  const double end = boundary_of<3>(solids.domain).origin[0];
  const auto nearly_touches = [](double h) { return h > 0.98 + 1e-9 && h < 1.01 - 1e-9; };
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (const double at : {end, end + 12})
      EXPECT_FALSE(nearly_touches(std::abs(solids.spheres.x[0][i] - at) / solids.spheres.r[i]));
}

TEST(Solids, NarrowPlacesAreAtContacts) {
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 0.5);
  spheres.push_back({2.01, 1, 1}, 0.5);
  spheres.push_back({3.5, 3, 3}, 0.3);
  const Solids solids = solids_of(spheres, Box{Vector<3>(0, 0, 0), Vector<3>(4, 4, 4)}, {});
  const std::vector<NarrowPlace> places = narrow_places_of(solids, 0.3, 2.5);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_NEAR((places[0].point - Vector<3>(1.505, 1, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(places[0].size, 2.5 * 0.01, 1e-12);
  EXPECT_NEAR(places[0].size_beside, 0.3 * 0.5, 1e-15);
}

}  // namespace solids_test
}  // namespace bernal
