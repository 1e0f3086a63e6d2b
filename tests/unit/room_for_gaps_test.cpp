#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"
#include "core/rounding.hpp"
#include "run/take_coats_off.hpp"
#include "sizes/enlarged.hpp"
#include "support/gap_oracle.hpp"
#include "support/meshes.hpp"
#include "support/scenes_under_test.hpp"
#include "support/starts.hpp"

// What stands between the gaps that a scene asks for and stages that know of none: larger spheres, walls that
// stand elsewhere, and the way back.
namespace bernal {
namespace room_for_gaps_test {

using testing::plan_of;

TEST(SumRounded, IsTheNextDoubleOnThatSideOfTheTrueSum) {
  Random random(1, 1);
  int exact = 0;
  for (int k = 0; k < 20000; ++k) {
    const double scale = std::exp2(std::floor(random.uniform(-60, 60)));
    const double a = random.uniform(-1, 1),
                 b = k % 5 == 0 ? std::ldexp(1, -k % 30) : scale * random.uniform(-1, 1);
    const double up = sum_rounded_up(a, b), down = sum_rounded_down(a, b);
    // Of numbers that lie no more than 60 bits apart, __float128 has the sum without error.
    const __float128 sum = static_cast<__float128>(a) + static_cast<__float128>(b);
    EXPECT_TRUE(static_cast<__float128>(up) >= sum && static_cast<__float128>(down) <= sum);
    EXPECT_TRUE(up == down || up == std::nextafter(down, 1e300));
    exact += up == down;
    EXPECT_EQ(up == down, static_cast<__float128>(a + b) == sum);
  }
  EXPECT_GT(exact, 100);
}

TEST(Enlarged, HasTheLawOfRadiiThatAreAllByOneLengthLarger) {
  const auto of = make_lognormal(1, 0.5, Basis::number, 0, std::numeric_limits<double>::infinity());
  const Enlarged larger(*of, 0.25);
  Random one(1, 1), other(1, 1);
  std::vector<double> drawn;
  for (int k = 0; k < 200000; ++k) {
    const double r = of->sample(one);
    drawn.push_back(larger.sample(other));
    ASSERT_EQ(drawn.back(), sum_rounded_up(r, 0.25));
  }
  for (int k = 0; k <= 3; ++k) {
    double mean = 0, square = 0, above = 0;
    for (const double r : drawn) {
      mean += std::pow(r, k) / 2e5;
      square += std::pow(r, 2 * k) / 2e5;
      above += r > 1.5 ? std::pow(r, k) / 2e5 : 0;
    }
    const double error = 5 * std::sqrt(square / 2e5) + 1e-9;  // five deviations of the mean
    EXPECT_NEAR(larger.moment(k), mean, error) << k;
    EXPECT_NEAR(larger.moment_above(k, 1.5), above, error) << k;
  }
  for (const double p : {0.01, 0.3, 0.9}) EXPECT_NEAR(larger.cumulative(larger.quantile(p)), p, 1e-12);
  EXPECT_EQ(larger.cumulative(0.2), 0);
  EXPECT_TRUE(std::isinf(larger.max()));
  EXPECT_EQ(larger.min(), 0.25);
}

TEST(Enlarged, KeepsItsAtoms) {
  const auto of = make_classes({0.1, 0.3}, {1, 3}, Basis::number);
  const Enlarged larger(*of, 0.2);
  ASSERT_EQ(larger.atoms().size(), 2u);
  for (const double r : larger.atoms())
    EXPECT_EQ(larger.cumulative(r), of->cumulative(r - 0.2 > 0.2 ? 0.3 : 0.1));
}

std::vector<Domain> domains() {
  return {Box{Vector<3>(0.3, -2, 7), Vector<3>(1, 1.1, 0.9)},
          Box{Vector<2>(0.1, 0.7), Vector<2>(1.3, 0.9)},
          periodic_box(Vector<3>(1, 1.2, 0.9), {false, true, false}),
          Cylinder{.base = {0.1, 0.2, 0.3}, .axis = {0, -3, 0}, .radius = 0.7, .height = 1.1},
          Cylinder{.base = {10.1, -7.2, 0.3}, .axis = {1, 2, -3}, .radius = 0.7, .height = 1.1},
          Cylinder{.radius = 0.7, .height = 1.3, .periodic = true},
          Sphere{{0.1, 0.2, 0.3}, 0.9}};
}

// Decided without rounding on either side.
TEST(WallsMoved, LeaveOnlyBallsThatClearTheWallsByThatMuch) {
  Random random(3, 1);
  for (const Domain& domain : domains()) {
    SCOPED_TRACE(name_of(domain));
    for (const double by : {0.1, 0.03125, -0.02, 0.0}) {
      const Domain moved = with_walls_moved(domain, by);
      const auto container = make_container(moved, WallArithmetic::exact, 0);
      const Bounds<3> bounds = container->bounds();
      int touching = 0;
      for (int k = 0; k < 300; ++k) {
        Vector<3> c = uniform_point<3>(random, bounds);
        if (dimension_of(domain) == 2) c[2] = 0;
        // The largest ball there, to the last bit.
        double r = container->clearance(c) * (1 + 1e-14) + 1e-15;
        if (!(r > 0.05)) continue;
        while (!container->contains(c, r)) r = std::nextafter(r, 0);
        ++touching;
        const double wall_gap = by > 0 ? by : 0, less = by > 0 ? 0 : -by;
        Spheres<dynamic> ball(dimension_of(domain));
        // clearance >= r + by: with a gap of `by`, or of a ball that is by so much smaller.
        const double smaller = less > 0 ? sum_rounded_down(r, -less) : r;
        ball.push_back(Vector<dynamic>(c.head(dimension_of(domain))), smaller);
        const Certificate certificate = certify(ball, domain, {.wall_gap = wall_gap});
        ASSERT_EQ(certificate.protruding_spheres, 0u) << certificate.statement << " by " << by;
        // And not by more than an oblique cylinder is rounded by: four times 32 roundoffs of lengths of 12.
        EXPECT_LT(testing::plain::wall_gap(ball.center(0), ball.r[0], domain).gap, wall_gap + 3e-13);
      }
      EXPECT_GT(touching, 20) << by;
    }
  }
}

TEST(WallsMoved, AreNotRoundedWhereTheyNeedNotBe) {
  const Box box = std::get<Box>(with_walls_moved(Box{Vector<3>(0, 0.5, 1), Vector<3>(1, 1, 1)}, 0.25));
  EXPECT_EQ(Vector<3>(box.corner), Vector<3>(0.25, 0.75, 1.25));
  EXPECT_EQ(Vector<3>(box.size), Vector<3>(0.5, 0.5, 0.5));
  const auto cylinder =
      std::get<Cylinder>(with_walls_moved(Cylinder{.axis = {0, 0, -2}, .radius = 1, .height = 2}, 0.25));
  EXPECT_EQ(cylinder.base, Vector<3>(0, 0, -0.25));
  EXPECT_EQ(cylinder.radius, 0.75);
  EXPECT_EQ(cylinder.height, 1.5);
}

/// Against the container of the facets themselves.
TEST(InsetContainer, AnswersForAWallThatStandsElsewhere) {
  Random random(5, 1);
  const Mesh mesh = test::l_shape_mesh();
  const auto facets = make_container(mesh, WallArithmetic::filtered, 1e-16);
  for (const double inset : {0.07, -0.05}) {
    Mesh moved = mesh;
    moved.inset = inset;
    const auto container = make_container(moved, WallArithmetic::filtered, 1e-16);
    EXPECT_EQ(container->inset(), inset);
    EXPECT_NEAR(container->volume(), facets->volume() - inset * area_of(mesh), 1e-12);
    std::vector<NearFacet> near;
    std::vector<WallContact> contacts, of_facets;
    for (int k = 0; k < 2000; ++k) {
      const Vector<3> c = uniform_point<3>(random, facets->bounds());
      const double clearance = facets->clearance(c);
      EXPECT_NEAR(container->clearance(c), clearance - inset, 1e-15);
      for (const double reach : {0.0, 0.01, 0.3})
        EXPECT_NEAR(container->clearance_within(c, reach), std::min(reach, clearance - inset), 1e-15);
      const double r = random.uniform(0, 0.3);
      EXPECT_EQ(container->contains(c, r), facets->contains(c, std::max(0.0, sum_rounded_up(r, inset))));
      if (!facets->contains(c, std::max(0.0, inset))) continue;
      near.clear();
      container->facets_near(c, r, near);
      double least = r;
      for (const NearFacet& n : near) {
        EXPECT_NEAR(distance(n.facet, c), n.distance, 1e-14);
        EXPECT_NEAR((c - closest_point(n.facet, c)).norm(), std::abs(n.distance), 1e-14);
        EXPECT_LE(n.distance, r);
        least = std::min(least, n.distance);
      }
      EXPECT_NEAR(least, container->clearance_within(c, r), 1e-14);
      contacts.clear();
      of_facets.clear();
      container->contacts(c, r, contacts);
      if (r + inset > 0) facets->contacts(c, r + inset, of_facets);
      ASSERT_EQ(contacts.size(), of_facets.size());
      for (std::size_t n = 0; n < contacts.size(); ++n)
        EXPECT_NEAR(contacts[n].distance, of_facets[n].distance - inset, 1e-14);
      // A ball that lies inside goes as far as its wall, not that of the facets.
      if (!container->contains(c, r + 1e-6)) continue;
      const Vector<3> u = uniform_direction<3>(random);
      const double way = container->first_contact(c, r, u, 5);
      EXPECT_GE(container->clearance(c + way * u), r);
      // Nor does a centre pass the facets, if the wall is behind them.
      EXPECT_LT(container->clearance(c + (way + 1e-7) * u), std::max(r, -inset) + 1e-6);
    }
  }
}

TEST(Coats, ComeOffSoThatTheDrawnRadiiAreLeft) {
  const auto radii = make_uniform(0.1, 0.2, Basis::number);
  Supply::Source source{.radii = *radii, .seed = 4, .coat = 0.03};
  Target target;
  target.count = 500;
  Supply supply(source, 1, target);
  RadiusSequence sequence(*radii, 4, Draw::random);
  std::vector<double> drawn;
  for (int k = 0; k < 500; ++k) drawn.push_back(sequence.next());
  std::vector<double> in_order = supply.radii(), reversed = in_order;
  for (std::size_t k = 0; k < 500; ++k) EXPECT_GE(in_order[k], drawn[k] + 0.03 * (1 - 1e-15));
  std::vector<std::uint32_t> tags(500);
  std::iota(tags.begin(), tags.end(), 0u);
  EXPECT_EQ(take_coats_off(in_order, tags, supply, 0.03), 1);
  EXPECT_EQ(in_order, drawn);
  std::ranges::reverse(reversed);
  std::ranges::reverse(tags);
  take_coats_off(reversed, tags, supply, 0.03);
  std::ranges::reverse(reversed);
  std::ranges::reverse(tags);
  EXPECT_EQ(reversed, drawn);

  for (const double scale : {1.01, 0.99}) {
    Supply scaled(source, 1, target);
    scaled.multiply_by(scale);
    std::vector<double> grown = scaled.radii();
    const double of_drawn = take_coats_off(grown, tags, scaled, 0.03);
    double least = 1;
    for (std::size_t k = 0; k < 500; ++k) {
      EXPECT_NEAR(grown[k], of_drawn * drawn[k], 1e-15);
      EXPECT_LE(grown[k] + 0.03, scaled.radii()[k] * (1 + 1e-15));
      least = std::min(least, scaled.radii()[k] - grown[k] - 0.03);
    }
    EXPECT_LT(least, 1e-15);  // no smaller than they have to be
  }
}

TEST(RoomForGaps, IsWhatExplainCountsIn) {
  const auto plan_with = [](double gap, double wall_gap) {
    return plan_of(
        fmt::format("{}[spheres]\nradius = 0.05\ngap = {}\nwall_gap = {}\n", testing::box, gap, wall_gap));
  };
  const double without = plan_with(0, 0).expected_packing_fraction;
  // Nearly the share that is left without coats; the walls take a little less or more.
  const double share = std::pow(0.05 / 0.06, 3);
  EXPECT_NEAR(plan_with(0.02, 0.01).expected_packing_fraction, without * share * 0.98 * 0.98 * 0.98, 0.02);
  EXPECT_GT(plan_with(0.02, 0).expected_packing_fraction, plan_with(0.02, 0.01).expected_packing_fraction);
  EXPECT_NEAR(plan_with(0, 0.05).expected_packing_fraction, without * 0.9 * 0.9 * 0.9, 0.01);
  for (const auto& [gap, wall_gap] : {std::pair(0.02, 0.0), std::pair(0.02, 0.03), std::pair(0.0, 0.05)}) {
    const Plan plan = plan_with(gap, wall_gap);
    const Packing packing = testing::run_with(plan);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_NEAR(packing.packing_fraction(), plan.expected_packing_fraction, 0.03);
    EXPECT_NEAR(packing.history.back().packing_fraction, packing.packing_fraction(), 0.01);
  }
}

TEST(RoomForGaps, IsNoneThatASceneDoesNotAskFor) {
  const std::string toml = testing::box + "[spheres]\nradius = 0.05\ncount = 300\n";
  const std::string hash = hash_of(testing::run_with(plan_of(toml)).spheres);
  EXPECT_EQ(hash_of(testing::run_with(plan_of(toml + "gap = 0\nwall_gap = 0.0\n")).spheres), hash);
}

// A sphere of radius 1/4 with a gap of 1/4 from the walls of the unit box has one place.
TEST(RoomForGaps, IsEnoughWhereItJustIs) {
  const std::string toml = testing::box + "[spheres]\ncount = 1\nradius = 0.25\nwall_gap = 0.25\n";
  const Packing packing = testing::run_with(plan_of(toml));
  ASSERT_EQ(packing.spheres.size(), 1u) << packing.reason;
  EXPECT_EQ(packing.spheres.center(0), Vector<3>(0.5, 0.5, 0.5));
  EXPECT_TRUE(certify(packing.spheres, packing.domain, {.wall_gap = 0.25}).certified);
}

TEST(RoomForGaps, LeavesABoxThatFollowsItsProportionsAndItsPackingFraction) {
  const std::string toml =
      "[container]\nkind = \"periodic\"\nsize = [1.0, 2.0, 1.0]\nscalable = true\nwalls = [2]\n[spheres]\n"
      "count = 200\nradius = 1\ngap = 0.2\nwall_gap = 0.5\n";
  const Packing stated = testing::run_with(plan_of(toml + "packing_fraction = 0.35\n"));
  const Packing followed = testing::run_with(plan_of(toml));
  EXPECT_NEAR(stated.packing_fraction(), 0.35, 1e-12);
  EXPECT_EQ(stated.outcome, Outcome::converged) << stated.reason;
  const Vector<dynamic> edges = bounds_of<dynamic>(stated.domain).size();
  EXPECT_NEAR(edges[1], 2 * edges[0], 1e-12 * edges[1]);
  EXPECT_NEAR(edges[2], edges[0], 1e-12 * edges[2]);
  // What is between the walls grew as one, and the gap from them did not.
  const Vector<dynamic> grown = bounds_of<dynamic>(followed.domain).size();
  EXPECT_NEAR(grown[1], 2 * grown[0], 1e-12 * grown[1]);
  EXPECT_NEAR(grown[2], grown[0], 0.01 * grown[2]);
  EXPECT_GT(followed.packing_fraction(), 0.35);
}

// A prediction becomes a number of four digits, which scene.toml holds: the packing is that of the number.
TEST(RoomForGaps, PacksAPredictionAsTheNumberThatIsWritten) {
  const std::string toml =
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 200\nradius = 0.5\ngap = 0.1\npacking_fraction "
      "= ";
  const Plan predicted = plan_of(toml + "\"predicted\"\n");
  const Plan written = plan_of(toml + fmt::format("{}\n", predicted.scene.target.packing_fraction.value()));
  EXPECT_EQ(bounds_of<dynamic>(predicted.domain).size(), bounds_of<dynamic>(written.domain).size());
  EXPECT_EQ(hash_of(testing::run_with(predicted).spheres), hash_of(testing::run_with(written).spheres));
}

TEST(RoomForGaps, HoldsContactsAtTheGap) {
  const std::string toml =
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 300\nradius = 1\ngap = 0.1\n[[stage]]\n"
      "do = \"relax\"\npolish = 1e-10\n";
  const Packing packing = testing::run_with(plan_of(toml));
  // What touches to the precision of the polish, and nothing that is only near.
  const Measurements with = measure(packing.spheres, packing.domain, {}, {.gap = 0.1, .contact_gap = 1e-8});
  const Measurements without = measure(packing.spheres, packing.domain);
  EXPECT_GT(with.contacts.coordination, 5);
  EXPECT_EQ(without.contacts.coordination, 0);
  EXPECT_EQ(with.packing_fraction, without.packing_fraction);
  ASSERT_TRUE(with.contacts.isostatic);
  EXPECT_NEAR(static_cast<double>(with.contacts.backbone_contacts()),
              static_cast<double>(*with.contacts.isostatic),
              0.01 * static_cast<double>(*with.contacts.isostatic));
}

TEST(RoomForGaps, IsRefusedWithOneLineWhereThereIsNone) {
  const auto refusal = [](const std::string& toml) {
    const Error error = testing::error_of([&] { plan_of(toml); });
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_GT(error.location().line, 0);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return std::string(error.what());
  };
  const auto expect_words = [](const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  const std::string spheres = testing::box + "[spheres]\nradius = 0.1\n";
  expect_words(refusal(spheres + "gap = -0.1\n"), {"\"gap\"", "-0.1"});
  expect_words(refusal(spheres + "wall_gap = nan\n"), {"\"wall_gap\"", "at least 0", "nan"});
  expect_words(refusal(spheres + "gap = inf\n"), {"\"gap\"", "at least 0", "inf"});
  expect_words(refusal(spheres + "gap = 1.0\n"), {"\"gap\"", "wide", "units"});
  expect_words(refusal(spheres + "wall_gap = 2\n"), {"\"wall_gap\"", "wide", "units"});
  expect_words(refusal(spheres + "wall_gap = 0.45\n"), {"radius 0.1", "does not fit", "gaps", "up to 0.05"});
  expect_words(refusal(spheres + "wall_gap = 0.6\n"), {"no sphere fits", "gaps"});
  expect_words(refusal("[container]\nkind = \"periodic\"\nedge = 1\n[spheres]\ncount = 2\nradius = 0.3\n"
                       "gap = 0.5\n"),
               {"does not fit", "gaps"});
  expect_words(refusal("[container]\nkind = \"periodic\"\nedge = 1\n[spheres]\ncount = 2\nradius = 0.3\n"
                       "wall_gap = 0.1\n"),
               {"\"wall_gap\"", "without effect", "no walls"});
  expect_words(refusal("[container]\nkind = \"periodic\"\nedge = 1\n[spheres]\ncount = 2\nradius = 0.1\n"
                       "gap = 0.1\n[accuracy]\noverlap = 0.1\n"),
               {"\"gap\"", "\"overlap\"", "exclude"});
}

using GapStart = testing::starts::StartFixture;

TEST_F(GapStart, NearerThanTheGapIsRefusedOrPushedApart) {
  using namespace testing::starts;
  folder.write("near.csv", "x,y,z,r\n2,2,2,1\n4.05,2,2,1\n6,6,6,1\n");
  const std::string spheres = "[spheres]\nstart = \"near.csv\"\ngap = 0.1\n";
  for (const std::string& container : {box, periodic(8)}) {
    const bool is_box = container == box;
    const std::string text = refusal(container + spheres + stage(is_box ? "insert" : "fly"));
    EXPECT_NE(text.find("nearer to that of line 2 than the gap of 0.1"), std::string::npos) << text;
    EXPECT_NE(text.find("relax"), std::string::npos) << text;
    const Packing packing = packed(container + spheres + stage("relax"));
    ASSERT_EQ(packing.spheres.size(), 3u) << packing.reason;
    EXPECT_EQ(packing.spheres.r, (std::vector<double>{1, 1, 1}));
    EXPECT_GE(testing::least_gap(packing.spheres, packing.domain), 0.1 - 1e-14);
    EXPECT_TRUE(certify(packing.spheres, packing.domain, {.gap = 0.1}).certified);
  }
  folder.write("wall.csv", "x,y,z,r\n1.05,2,2,1\n");
  const std::string at_wall = "[spheres]\nstart = \"wall.csv\"\nwall_gap = 0.1\n";
  EXPECT_NE(refusal(box + at_wall + stage("insert")).find("nearer to the wall than the gap of 0.1"),
            std::string::npos);
  const Packing packing = packed(box + at_wall + stage("relax"));
  ASSERT_EQ(packing.spheres.size(), 1u);
  EXPECT_GE(packing.spheres.x[0][0], 1.1);
}

}  // namespace room_for_gaps_test
}  // namespace bernal
