#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include <fmt/format.h>

#include "bernal/predict/predict.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/flights.hpp"
#include "support/plans.hpp"

// Event-driven growth against what others have found with it.
namespace bernal {
namespace grow_test {

/// Farr, Powder Technology 245, 28 (2013), table 2: two lognormal populations whose d43 differ by the ratio
/// R, half the volume of each.
struct Row {
  const char* name;
  int count;
  const char* diameter;
  double phi_init;
  double phi, error;  ///< of the paper's KTS, and three repeats' standard error

  friend std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.diameter; }
};

class FarrTable2 : public ::testing::TestWithParam<Row> {};

/// Three repeats. Growth as published may end denser than in the paper, which does not say when it stopped;
/// looser by three of its errors it may not.
TEST_P(FarrTable2, IsReached) {
  double sum = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    const Packing packing = run(testing::plan_of(
        fmt::format("seed = {}\n[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\ndiameter = {}\n"
                    "[[stage]]\ndo = \"grow\"\ndelta = 0.1\nphi_init = {}\n",
                    seed, GetParam().count, GetParam().diameter, GetParam().phi_init)));
    ASSERT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    sum += packing.packing_fraction();
  }
  RecordProperty("packing_fraction", fmt::format("{:.4f}", sum / 3));
  EXPECT_GT(sum / 3, GetParam().phi - 3 * GetParam().error);
  EXPECT_LT(sum / 3, GetParam().phi + 0.012);
}

#define LOGNORMAL(d43_by_median) \
  "{ distribution = \"lognormal\", median = " d43_by_median ", sigma = 0.3, basis = \"volume\" }"
#define EQUAL(d) "{ distribution = \"constant\", value = " d " }"
#define MIXTURE(a, b) \
  "{ distribution = \"mixture\", of = [" a ", " b "], shares = [0.5, 0.5], basis = \"volume\" }"
// d43 = median e^(sigma²/2) by volume.
#define ONE LOGNORMAL("0.9559974818")
#define TWO LOGNORMAL("1.9119949636")

INSTANTIATE_TEST_SUITE_P(
    Rows, FarrTable2,
    ::testing::Values(Row{"Equal", 1024, "1.0", 0.2, 0.6426, 0.0005},
                      Row{"Lognormal", 2048, ONE, 0.15, 0.6671, 0.0006},
                      Row{"TwoSizes", 2048, MIXTURE(EQUAL("1.0"), EQUAL("2.0")), 0.15, 0.6736, 0.0007},
                      Row{"LognormalAndTwice", 2048, MIXTURE(ONE, EQUAL("2.0")), 0.15, 0.6939, 0.0011},
                      Row{"OneAndLognormal", 2048, MIXTURE(EQUAL("1.0"), TWO), 0.15, 0.6724, 0.0005},
                      Row{"TwoLognormals", 2048, MIXTURE(ONE, TWO), 0.15, 0.6931, 0.0002}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// 10,000 spheres, one packing of each: within -0.012 and 0.005 of what the rod model predicts. At
/// compositions in which the small spheres just fill what the large ones leave, that takes the masses of one
/// material and patience: with equal masses it is up to 0.022 less. One packing scatters by 0.002 to 0.003
/// there; mixtures that the band holds on average only, a tenth small, or not at all, 15 %, are left out: see
/// `grow`.
struct TestedMixture {
  const char* name;
  const char* radius;
  const char* stage;

  friend std::ostream& operator<<(std::ostream& out, const TestedMixture& mixture) {
    return out << mixture.radius;
  }
};

class RodModel : public ::testing::TestWithParam<TestedMixture> {};

TEST_P(RodModel, IsReached) {
  const Plan plan = testing::plan_of(
      fmt::format("[container]\nkind = \"periodic\"\n[spheres]\ncount = 10000\nradius = {}\ndraw = "
                  "\"quantiles\"\n[[stage]]\ndo = \"grow\"\npressure = 1e4\n{}",
                  GetParam().radius, GetParam().stage));
  const Packing packing = run(plan);
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified) << packing.reason;
  const double predicted = predict_packing_fraction(*plan.radii).phi;
  RecordProperty("packing_fraction", fmt::format("{:.4f}", packing.packing_fraction()));
  EXPECT_GT(packing.packing_fraction(), predicted - 0.012);
  EXPECT_LT(packing.packing_fraction(), predicted + 0.005);
}

#define ONE_TO_FIVE(large, small) \
  "{ distribution = \"classes\", values = [5.0, 1.0], shares = [" large ", " small "], basis = \"volume\" }"
#define WITH_PATIENCE "masses = \"volume\"\nrate = 0.0025\n"
INSTANTIATE_TEST_SUITE_P(
    Mixtures, RodModel,
    ::testing::Values(TestedMixture{"Lognormal",
                                    "{ distribution = \"lognormal\", median = 1.0, sigma = 0.5 }", ""},
                      TestedMixture{"OneToFiveThreeQuartersSmall", ONE_TO_FIVE("25", "75"), ""},
                      TestedMixture{"OneToFiveHalfSmall", ONE_TO_FIVE("50", "50"), ""},
                      TestedMixture{"OneToFiveThreeTenthsSmall", ONE_TO_FIVE("70", "30"), ""},
                      TestedMixture{"OneToFiveAFifthSmall", ONE_TO_FIVE("79", "21"), WITH_PATIENCE}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// In containers growth reaches what relaxation is expected to, and a hundredth more.
TEST(GrowthInContainers, GoesBeyondWhatIsExpected) {
  for (const char* container :
       {"kind = \"cylinder\"\nradius = 1.0\nheight = 2.0", "kind = \"box\"\nsize = [1.4, 1.4, 1.4]",
        "kind = \"sphere\"\nradius = 0.9"}) {
    SCOPED_TRACE(container);
    const std::string scene = fmt::format("[container]\n{}\n[spheres]\nradius = 0.07\n", container);
    const std::string grow = "[[stage]]\ndo = \"grow\"\n";
    const double expected = testing::plan_of(scene + grow).attainable_packing_fraction;
    const Packing packing =
        run(testing::plan_of(fmt::format("{}packing_fraction = {}\n{}", scene, expected + 0.01, grow)));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GE(packing.packing_fraction(), expected + 0.01);
  }
}

/// Carnahan & Starling, J. Chem. Phys. 51, 635 (1969), is within 0.3 % of simulations up to 0.49. 2,000
/// spheres, 1,600 collisions each: the mean pressure has a standard error of about 0.05 %.
TEST(Fluid, HasThePressureOfCarnahanAndStarling) {
  for (const double eta : {0.3, 0.4}) {
    const testing::Gas<3> gas(testing::equal_radii(2000), 0.3);
    HardSpheres<3> flight(gas.spheres, gas.edges, Random(1, stream(Stream::test, 2)));
    const double size = std::cbrt(eta / 0.3);
    while (flight.size() < size) flight.fly(0.05, size);
    for (int k = 0; k < 10; ++k) flight.fly(0);
    const double energy = flight.kinetic_energy();
    double sum = 0, time = 0;
    for (int k = 0; k < 100; ++k) {
      const FlightPeriod period = flight.fly(0);
      sum += period.compressibility_factor * period.time;
      time += period.time;
    }
    const double expected = (1 + eta + eta * eta - eta * eta * eta) / std::pow(1 - eta, 3);
    EXPECT_NEAR(sum / time / expected, 1, 0.005) << eta;
    EXPECT_NEAR(flight.kinetic_energy() / energy, 1, 1e-10) << eta;
  }
}

}  // namespace grow_test
}  // namespace bernal
