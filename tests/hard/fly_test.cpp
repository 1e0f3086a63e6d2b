#include <gtest/gtest.h>

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "fly/fly.hpp"
#include "fly/fly_events.hpp"
#include "fly/fly_patent.hpp"
#include "support/fill_work.hpp"
#include "support/nearest_images.hpp"
#include "support/plans.hpp"

// Flight where it is hard: spheres at rest in contact, as large as the box, at corners; steps that would jump
// over a neighbour; targets that nothing reaches. It ends by itself, says how, and nothing overlaps, by
// rational arithmetic.
namespace bernal {
namespace fly_test {

using testing::plan_of;

void expect_free_of_overlap(const Packing& packing) {
  const Box& box = std::get<Box>(packing.domain);
  for (const Arithmetic arithmetic : {Arithmetic::filtered, Arithmetic::exact}) {
    const Certificate c = certify(packing.spheres, packing.domain, {.arithmetic = arithmetic});
    EXPECT_TRUE(c.certified) << c.statement;
  }
  if (box.has_walls()) return;
  with_dimension(packing.spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    EXPECT_TRUE(oracle::centers_in_box<D>(packing.spheres.in<D>(), box.size));
    EXPECT_EQ(oracle::overlapping_pairs<D>(packing.spheres.in<D>(), box.size), 0u);
  });
}

Packing packed(const std::string& toml) {
  RunOptions options;
  options.threads = 1;
  Packing packing = run(plan_of(toml), options);
  expect_free_of_overlap(packing);
  EXPECT_FALSE(packing.reason.empty());
  return packing;
}

/// Spheres in a box of their own, flying as a test tells them.
template <int D>
struct Flyers {
  Flyers(std::vector<double> radii, double edge, std::vector<bool> walls = {})
      : filled(std::move(radii), Vector<dynamic>::Constant(D, edge)) {
    filled.task.walls = std::move(walls);
    spheres.emplace(filled.in_box);
  }
  void put(const Vector<D>& c, const Vector<D>& v) {
    ASSERT_TRUE(spheres->is_free(c, spheres->waiting_radius(0)));
    spheres->accept(0, c, random);
    spheres->set_velocity(static_cast<std::uint32_t>(spheres->size() - 1), v);
  }
  void expect_apart() const {
    SpheresInBox there = filled.in_box;
    there.leave(spheres->write_to(there.spheres));
    Packing packing;
    packing.spheres = there.spheres;
    packing.domain = periodic_box(there.edges, there.task.walls);
    expect_free_of_overlap(packing);
  }

  testing::FillCase filled;
  Random random{1, stream(Stream::test)};
  std::optional<FlyingSpheres<D>> spheres;
};

class HardFlight : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string scene(const std::string& box, const std::string& spheres,
                           const std::string& stage = "") {
    return fmt::format(
        "[container]\nkind = \"periodic\"\n{}\n[spheres]\n{}\n[[stage]]\ndo = \"fly\"\nmethod = \"{}\"\n{}\n",
        box, spheres, GetParam(), stage);
  }
  static bool is_patent() { return GetParam() == std::string("patent"); }

  /// So many stretches or steps of flight with whoever is there.
  template <int D>
  static double energy_after(Flyers<D>& flyers, int steps, double dt = 0.05) {
    const Fly options{.dt = dt};
    const auto fly = [&](auto flight) {
      for (int step = 0; step < steps; ++step) flight.fly();
    };
    if (is_patent())
      fly(PatentFlight<D>(*flyers.spheres, options, flyers.random));
    else
      fly(EventFlight<D>(*flyers.spheres, options, flyers.random));
    flyers.expect_apart();
    return flyers.spheres->kinetic_energy();
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, HardFlight, ::testing::Values("patent", "flight"), [](const auto& tested) {
  return std::string(tested.param) == "patent" ? "Patent" : "Events";
});

// Every collision changes the energy by a few roundoffs of it.
TEST_P(HardFlight, ConservesEnergyToRounding) {
  std::vector<double> radii;
  for (int i = 0; i < 60; ++i) radii.push_back(1 + i / 60.0);
  Flyers<3> flyers(radii, 17);
  const Fly options{.batch = 2000, .dt = 0.01};
  while (!flyers.spheres->queue().empty())
    PatentFlight<3>(*flyers.spheres, options, flyers.filled.report.random(Stream::fly)).insert();
  const double before = flyers.spheres->kinetic_energy();
  EXPECT_NEAR(energy_after(flyers, 500) / before, 1, 1e-11);
}

// A unit sphere flies at one that rests; they meet after a way of 1 and exchange their velocities.
TEST_P(HardFlight, LetsEqualSpheresExchangeVelocities) {
  Flyers<2> flyers({1, 1}, 20);
  flyers.put({5, 10}, {1, 0});
  flyers.put({8, 10}, {0, 0});
  energy_after(flyers, is_patent() ? 200 : 30, 0.025);
  EXPECT_NEAR(flyers.spheres->velocity(0)[0], 0, 1e-12);
  EXPECT_NEAR(flyers.spheres->velocity(1)[0], 1, 1e-9);
  EXPECT_NEAR(flyers.spheres->velocity(1)[1], 0, 1e-9);
  EXPECT_NEAR(flyers.spheres->center(0)[0], 6, 1e-8);
}

TEST_P(HardFlight, OfAPairThatTouchesAtRestLeavesItThere) {
  Flyers<3> flyers({1, 1}, 20);
  flyers.put({10, 10, 10}, {0, 0, 0});
  flyers.put({10 + 2 * (1 + flyers.spheres->margin()) + 1e-14, 10, 10}, {0, 0, 0});
  EXPECT_EQ(energy_after(flyers, 50), 0);
  EXPECT_EQ(flyers.spheres->center(0), (Vector<3>(10, 10, 10)));
}

// The pair meets across the corner, where each of them has seven images nearby.
TEST_P(HardFlight, OfAPairAtACornerMeetsOnce) {
  Flyers<3> flyers({1, 1}, 6.2);
  flyers.put({0.8, 0.8, 0.8}, {-1, -1, -1});
  flyers.put({5, 5, 5}, {1, 1, 1});
  EXPECT_NEAR(energy_after(flyers, 300), 3, 1e-9);
}

TEST_P(HardFlight, BetweenWallsStaysThere) {
  Flyers<2> flyers({1, 1, 1}, 8, {true, false});
  flyers.put({1.5, 2}, {-1, 0.1});
  flyers.put({6.5, 2.1}, {1, 0.3});
  flyers.put({4, 6}, {0.5, -1});
  EXPECT_NEAR(energy_after(flyers, 400), 0.5 * (1.01 + 1.09 + 1.25), 1e-9);
}

TEST_P(HardFlight, OfOneSphereAsLargeAsTheBox) {
  for (const int dimension : {1, 2, 3, 8}) {
    const Packing packing =
        packed(scene(fmt::format("dimension = {}\nedge = 2.0", dimension), "count = 1\nradius = 1.0"));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_EQ(packing.spheres.size(), 1u);
  }
}

TEST_P(HardFlight, OfSpheresWiderThanTheBoxIsRefused) {
  for (const char* spheres : {"count = 3\nradius = 1.0",
                              "count = 40\nradius = { distribution = \"classes\", values = [0.6, 0.1], "
                              "shares = [1, 9] }\ndraw = \"quantiles\""}) {
    try {
      packed(scene("edge = 1.0", spheres));
      ADD_FAILURE() << "was packed: " << spheres;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("does not fit"), std::string::npos) << error.what();
    }
  }
}

// Steps a hundred diameters long are cut to what cannot jump over a sphere.
TEST_P(HardFlight, WithALongStepDoesNotTunnel) {
  const Packing packing =
      packed(scene("edge = 10.0", "packing_fraction = 0.25\nradius = 1.0", "dt = 100.0\nbatch = 50"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
}

TEST_P(HardFlight, OfAnUnreachableTargetEndsAndSaysHowFarItCame) {
  for (const int dimension : {1, 2, 3, 5}) {
    const Packing packing =
        packed(scene(fmt::format("dimension = {}\nedge = {}", dimension, dimension == 5 ? 4.0 : 10.0),
                     "packing_fraction = 0.99\nradius = 1.0", "patience = 2"));
    EXPECT_EQ(packing.outcome, Outcome::full);
    EXPECT_GT(packing.spheres.size(), 0u);
    EXPECT_NE(packing.reason.find("in a row"), std::string::npos) << packing.reason;
  }
}

TEST_P(HardFlight, InABoxOfLessThanFourRadiiSeesEveryImage) {
  for (int count = 1; count <= 4; ++count) {
    const Packing packing = packed(scene("size = [3.0, 5.0, 3.6]",
                                         fmt::format("count = {}\nradius = {{ distribution = \"uniform\", "
                                                     "min = 0.7, max = 1.0 }}",
                                                     count),
                                         "patience = 300"));
    EXPECT_GE(packing.spheres.size(), 1u);
  }
}

TEST_P(HardFlight, FillsBoxesThatAreMixedByAxis) {
  for (const char* walls : {"walls = [0]", "walls = [0, 2]", "walls = [0, 1, 2]"}) {
    const Packing packing = packed(
        scene(fmt::format("size = [10.0, 12.0, 9.0]\n{}", walls), "packing_fraction = 0.25\nradius = 0.9"));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    const Box& box = std::get<Box>(packing.domain);
    for (std::size_t k = 0; k < 3; ++k)
      for (const double x : packing.spheres.x[k]) {
        if (!box.has_wall(static_cast<int>(k))) continue;
        EXPECT_GE(x, 0.9);
        EXPECT_LE(x, box.size[static_cast<int>(k)] - 0.9);
      }
  }
}

TEST_P(HardFlight, KeepsEveryPrescribedRadiusToTheLastBit) {
  const Plan plan = plan_of(scene("edge = 1.0",
                                  "packing_fraction = 0.3\nradius = { distribution = \"lognormal\", median = "
                                  "0.05, sigma = 0.3 }"));
  const Packing packing = run(plan);
  expect_free_of_overlap(packing);
  RadiusSequence drawn(*plan.radii, packing.seed, *plan.scene.draw);
  for (const double r : packing.spheres.r) EXPECT_EQ(r, drawn.next());
}

// ---- the protocol

TEST(FillChoice, GoesByTargetAndSizes) {
  const auto method = [](FillTask task) { return choose_filling(FillMethod::automatic, task).method; };
  EXPECT_EQ(method({.packing_fraction = 0.4, .attainable = 0.64}), FillMethod::relaxation);
  EXPECT_EQ(method({.packing_fraction = 0.6, .attainable = 0.64}), FillMethod::relaxation);
  EXPECT_EQ(method({.packing_fraction = 0.6, .attainable = 0.8, .size_ratio = 10}), FillMethod::classes);
  EXPECT_EQ(method({.packing_fraction = 0.6, .attainable = 0.64, .has_walls = true}), FillMethod::relaxation);
  EXPECT_EQ(method({.packing_fraction = 0.2, .attainable = 0.64, .has_walls = true}), FillMethod::relaxation);
  EXPECT_EQ(method({.packing_fraction = 0.4, .attainable = 0.64, .has_walls = true}), FillMethod::relaxation);
  EXPECT_EQ(choose_filling(FillMethod::patent, {.packing_fraction = 0.9}).method, FillMethod::patent);
  EXPECT_THROW(choose_filling(FillMethod::classes, {.has_walls = true}), Error);
}

TEST(Fly, ReachesByEveryMethodWhatIsAskedFor) {
  for (const char* method : {"auto", "patent", "flight", "classes", "relaxation"})
    for (const int dimension : {1, 2, 3, 4, 6}) {
      const double phi[] = {0.5, 0.4, 0.25, 0.15, 0, 0.05};
      const Packing packing =
          packed(fmt::format("[container]\nkind = \"periodic\"\ndimension = {}\nscalable = true\n[spheres]\n"
                             "count = 150\npacking_fraction = {}\nradius = 1.0\n[[stage]]\ndo = \"fly\"\n"
                             "method = \"{}\"\n",
                             dimension, phi[dimension - 1], method));
      EXPECT_EQ(packing.outcome, Outcome::converged) << method << ": " << packing.reason;
      EXPECT_NEAR(packing.packing_fraction(), phi[dimension - 1], 1e-12);
      EXPECT_NE(packing.reason.find(" by "), std::string::npos) << packing.reason;
    }
}

TEST(Fly, BelowALastPlaceKeepsTheLargestOfTheQueue) {
  // The small ones come last, and for them patience ends.
  const Packing packing = packed(
      "[container]\nkind = \"periodic\"\nedge = 1.0\n[spheres]\npacking_fraction = 0.9\n"
      "radius = { distribution = \"uniform\", min = 0.05, max = 0.08 }\n[[stage]]\ndo = \"fly\"\n"
      "method = \"flight\"\npatience = 1\n");
  EXPECT_EQ(packing.outcome, Outcome::full);
  EXPECT_GT(packing.packing_fraction(), 0.3);
  EXPECT_NE(packing.reason.find(" of "), std::string::npos) << packing.reason;
}

}  // namespace fly_test
}  // namespace bernal
