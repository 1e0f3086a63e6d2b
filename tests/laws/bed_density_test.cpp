#include "soft/bed_density.hpp"
#include "bernal/run/run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/measure/rest.hpp"
#include "bernal/verify/certificate.hpp"

#include "settle/roll_to_rest.hpp"
#include "support/plain_check.hpp"
#include "support/plans.hpp"

// Beds are as dense as they are asked to be, and at rest: without friction, or with that of an angle which is
// told and judged here sphere by sphere, by trying ways.
namespace bernal {
namespace bed_density_test {

const Vector<3> down(0, 0, -1);

Packing bed_of(double diameters, int count, const std::string& keys, std::uint64_t seed = 1,
               const Monitor& monitor = {}) {
  RunOptions options;
  options.seed = seed;
  options.monitor = monitor;
  return run(testing::plan_of(fmt::format(
                 "[container]\nkind = \"cylinder\"\nradius = {}\nheight = {}\n[spheres]\ncount = {}\n"
                 "diameter = 1.0\n{}\n[[stage]]\ndo = \"settle\"\n",
                 diameters / 2, 4.0 * count / (diameters * diameters), count, keys)),
             options);
}

/// Three diameters, or a quarter of the height, from floor and surface left out, which is twice as high as
/// the spheres on average.
double porosity_of_core(const Packing& packing, double diameters) {
  double top = 0, filled = 0;
  for (const double z : packing.spheres.x[2]) top += 2 * z / static_cast<double>(packing.spheres.size());
  const double low = std::min(3.0, top / 4), high = top - low;
  for (const double z : packing.spheres.x[2]) {
    const auto below = [&](double level) {
      const double t = std::clamp(level - z + 0.5, 0.0, 1.0);
      return t * t * (3 - 2 * t);
    };
    filled += (below(high) - below(low)) * std::numbers::pi / 6;
  }
  return 1 - filled / (std::numbers::pi / 4 * diameters * diameters * (high - low));
}

TEST(BedDensity, LawsAreAsPrinted) {
  for (const auto& [across, poured] : {std::pair{1.5, 0.640}, {4.0, 0.456}, {10.0, 0.404}, {50.0, 0.391}})
    EXPECT_NEAR(porosity_poured(across), poured, 6e-4);
  EXPECT_NEAR(porosity_vibrated(4), 0.4618, 1e-4);
  EXPECT_NEAR(porosity_vibrated(6), 0.3956, 1e-4);
  EXPECT_NEAR(porosity_loose(4), 0.5346, 1e-4);
  EXPECT_NEAR(porosity_loose(6), 0.4493, 1e-4);
}

TEST(BedDensity, ColumnsAreKnownAndOtherShapesGoByTheirHydraulicDiameter) {
  const auto across = [](const Domain& domain, const Vector<3>& direction) {
    return across_of(*make_container(domain, WallArithmetic::filtered, 1e-12), direction, 0.5);
  };
  const Domain column = Cylinder{.base = Vector<3>::Zero(), .axis = {0, 0, 1}, .radius = 2, .height = 30};
  EXPECT_TRUE(across(column, down).is_column);
  EXPECT_DOUBLE_EQ(across(column, down).diameters, 8);
  EXPECT_FALSE(across(column, {1, 0, 0}).is_column);
  const Across box = across(Box{Vector<3>::Zero(), Vector<3>(2, 3, 20)}, down);
  EXPECT_FALSE(box.is_column);
  EXPECT_NEAR(box.diameters, 2 * 2 * 3 / 5.0 / 0.5, 0.2);
  const Across slab = across(Box{Vector<3>::Zero(), Vector<3>(2, 20, 20), {false, true, false}}, down);
  EXPECT_NEAR(slab.diameters, 2 * 2 / 0.5, 0.3);
}

/// Of other sizes and shapes, and below four diameters, what holds is said.
TEST(BedDensity, SaysWhatItAimsAt) {
  BedTarget target;
  EXPECT_FALSE(aim_of(target, {6, true}, 1).first);
  target.density = BedTarget::Density::vibrated;
  EXPECT_NEAR(aim_of(target, {6, true}, 1).first->porosity, 0.3956, 1e-4);
  EXPECT_EQ(aim_of(target, {6, true}, 1).first->words.find("guess"), std::string::npos);
  EXPECT_NE(aim_of(target, {6, false}, 1).first->words.find("guess"), std::string::npos);
  EXPECT_NEAR(aim_of(target, {6, true}, 1.1).first->porosity, 1 - 1.1 * (1 - 0.3956), 1e-4);
  EXPECT_NE(aim_of(target, {6, true}, 1.1).first->words.find("guess"), std::string::npos);
  EXPECT_FALSE(aim_of(target, {3.9, true}, 1).first);
  EXPECT_NE(aim_of(target, {3.9, true}, 1).second.find("geometry"), std::string::npos);
}

void expect_aim_reached(double diameters, int count, std::uint64_t seed) {
  const Packing vibrated = bed_of(diameters, count, "bed = \"vibrated\"", seed),
                poured = bed_of(diameters, count, "bed = \"poured\"", seed),
                loose = bed_of(diameters, count, "bed = \"loose\"", seed);
  for (const Packing* packing : {&vibrated, &poured, &loose}) {
    EXPECT_EQ(packing->outcome, Outcome::converged) << packing->reason;
    EXPECT_EQ(testing::plain_objection(packing->spheres, packing->domain, 0), "");
    EXPECT_EQ(packing->spheres.size(), static_cast<std::size_t>(count));
  }
  EXPECT_EQ(measure_rest(vibrated.spheres, vibrated.domain, down).unsettled, 0u);
  EXPECT_EQ(measure_rest(poured.spheres, poured.domain, down).unsettled, 0u);
  EXPECT_EQ(measure_rest(loose.spheres, loose.domain, down, {.friction = BedTarget::most_friction}).unsettled,
            0u);
  const double as_vibrated = porosity_of_core(vibrated, diameters),
               as_poured = porosity_of_core(poured, diameters), as_loose = porosity_of_core(loose, diameters);
  EXPECT_LT(as_vibrated, as_poured);
  EXPECT_LT(as_poured, as_loose);
  EXPECT_NEAR(as_vibrated, porosity_vibrated(diameters), 0.008) << vibrated.reason;
  EXPECT_NEAR(as_loose, porosity_loose(diameters), 0.008) << loose.reason;
  EXPECT_NE(vibrated.reason.find("Zou and Yu's law of dense beds"), std::string::npos) << vibrated.reason;
}

TEST(BedDensity, OfColumnsIsThatOfTheLaws) { expect_aim_reached(8, 500, 1); }

TEST(BedDensity, IsThePorosityThatIsAskedFor) {
  for (const char* porosity : {"0.41", "0.48"}) {
    const Packing packing = bed_of(10, 900, std::string("porosity = ") + porosity);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    const std::string text = "the bed has a porosity of ";
    EXPECT_NEAR(std::stod(packing.reason.substr(packing.reason.find(text) + text.size())),
                std::stod(porosity), 0.0055);
  }
  const Packing beyond = bed_of(6, 150, "porosity = 0.25");
  EXPECT_EQ(beyond.outcome, Outcome::hit_limit) << beyond.reason;
  EXPECT_NE(beyond.reason.find("they find no room"), std::string::npos) << beyond.reason;
}

/// The sine of the steepest way down that is free, of some thousand tried: none leads into what is touched.
double steepest_way_tried(const Packing& packing, std::size_t i, double radius_of_column) {
  const Spheres<dynamic>& spheres = packing.spheres;
  const Vector<3> p = spheres.center(i);
  const double r = spheres.r[i], touching = 1e-6 * r;
  std::vector<Vector<3>> normals;
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const Vector<3> away = p - Vector<3>(spheres.center(k));
    if (k != i && away.norm() < r + spheres.r[k] + touching) normals.push_back(away.normalized());
  }
  if (p[2] < r + touching) normals.push_back({0, 0, 1});
  const Vector<3> outwards(p[0], p[1], 0);
  if (outwards.norm() > radius_of_column - r - touching) normals.push_back(-outwards.normalized());
  double steepest = 0;
  constexpr int around = 720, slopes = 180;
  for (int a = 0; a < around; ++a)
    for (int s = 1; s <= slopes; ++s) {
      const double phi = 2 * std::numbers::pi * a / around, slope = 0.5 * std::numbers::pi * s / slopes;
      const Vector<3> u(std::cos(slope) * std::cos(phi), std::cos(slope) * std::sin(phi), -std::sin(slope));
      if (std::ranges::all_of(normals, [&](const auto& n) { return n.dot(u) >= 0; }))
        steepest = std::max(steepest, std::sin(slope));
    }
  return steepest;
}

TEST(BedDensity, FrictionHoldsNoSphereBeyondItsAngle) {
  const Packing packing = bed_of(8, 250, "porosity = 0.6");
  const Rest rest =
      measure_rest(packing.spheres, packing.domain, down, {.friction = BedTarget::most_friction});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  ASSERT_GT(rest.held_by_friction, 0u) << packing.reason;
  EXPECT_EQ(rest.unsettled, 0u);
  EXPECT_NE(
      packing.reason.find(fmt::format("{} spheres are held by friction, up to an angle of {:.3g} degrees",
                                      rest.held_by_friction, rest.friction)),
      std::string::npos)
      << packing.reason;
  double steepest = 0;
  std::size_t held = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const double way = steepest_way_tried(packing, i, 4);
    steepest = std::max(steepest, way);
    held += way > 0.02;
  }
  const double told = std::sin(rest.friction * std::numbers::pi / 180);
  EXPECT_LE(steepest, told + 1e-6);
  EXPECT_GE(steepest, told - 0.02);
  EXPECT_LE(held, rest.held_by_friction);
  EXPECT_GE(held + 6, rest.held_by_friction);
  // Without friction these do not rest.
  EXPECT_EQ(measure_rest(packing.spheres, packing.domain, down).unsettled, rest.held_by_friction);
  EXPECT_EQ(measure_rest(packing.spheres, packing.domain, down, {.friction = 0.5 * rest.friction}).unsettled +
                measure_rest(packing.spheres, packing.domain, down, {.friction = 0.5 * rest.friction})
                    .held_by_friction,
            rest.held_by_friction);
}

/// However it is laid and wherever it is stopped once its spheres have places, some of them stand there.
TEST(BedDensity, AStoppedBedKeepsWhatIsThere) {
  constexpr int count = 200;
  for (const char* const density : {"bed = \"poured\"", "bed = \"vibrated\"", "porosity = 0.37"}) {
    std::atomic<int> asked = 0;
    int most = std::numeric_limits<int>::max();
    const Monitor monitor{{}, [&] { return ++asked > most; }};
    EXPECT_NE(bed_of(6, count, density, 1, monitor).outcome, Outcome::cancelled);
    const int all = asked;
    ASSERT_GT(all, 2.1 * count) << density;  // each is asked for once while it is looked for a place
    for (const double share : {0.05, 0.2, 0.4, 0.6, 0.8, 0.95}) {
      asked = 0;
      most = 2 * count + static_cast<int>(share * (all - 2 * count));
      const Packing packing = bed_of(6, count, density, 1, monitor);
      EXPECT_EQ(packing.outcome, Outcome::cancelled) << packing.reason;
      EXPECT_GT(packing.spheres.size(), 0U) << density << ", stopped at " << share;
      EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
    }
  }
}

}  // namespace bed_density_test
}  // namespace bernal
