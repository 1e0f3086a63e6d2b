#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

// What an exchange of sizes makes of ordinary packings, and that it is nothing but denser: the sizes are the
// same to the bit, there are no crystals, and like sizes do not gather. Ordinary packings, and the rod model,
// have 0.672, 0.707 and 0.66 here. Berthier, Coslovich, Ninarello & Ozawa (2016), Kapteijns et al. (2019) and
// Hoy, arXiv 2506.16521 (2025), have 0.70 to 0.75 for such sizes.
namespace bernal {
namespace exchange_test {

struct Sizes {
  const char* name;
  const char* diameter;
  double least;
};

constexpr Sizes asked[] = {
    {"Lognormal03", "{ distribution = \"lognormal\", median = 1.0, sigma = 0.3 }", 0.700},
    {"Lognormal05", "{ distribution = \"lognormal\", median = 1.0, sigma = 0.5 }", 0.725},
    // The density d^-3 by number is the same everywhere by volume.
    {"InverseCube", "{ distribution = \"uniform\", min = 1.0, max = 2.2, basis = \"volume\" }", 0.693}};

Packing certified(const Plan& plan) {
  Packing packing = run(plan, {{}, 1, {}});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  return packing;
}

struct Measured {
  Packing packing;
  Measurements of;
};

Measured packed(const Sizes& sizes, bool exchange) {
  Packing packing = certified(testing::plan_of(
      fmt::format("unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\ncount = 10000\ndraw = "
                  "\"quantiles\"\ndiameter = {}\n[[stage]]\ndo = \"relax\"\nexchange = {}\n",
                  sizes.diameter, exchange)));
  Measurements measured = measure(packing.spheres, packing.domain);
  return {std::move(packing), std::move(measured)};
}

void tell(const std::string& what, double before, double after) {
  ::testing::Test::RecordProperty(what, fmt::format("{:.4f} {:.4f}", before, after));
}

void expect_no_crystals(const BondOrder& ordinary, const BondOrder& exchanged) {
  tell("mean_q6", ordinary.mean_q6, exchanged.mean_q6);
  // Of 10,000 spheres none to some ten look crystalline by chance.
  EXPECT_LE(exchanged.all.fraction(), ordinary.all.fraction() + 0.001);
  EXPECT_NEAR(exchanged.mean_q6, ordinary.mean_q6, 4 * std::hypot(exchanged.q6_error, ordinary.q6_error));
}

/// What separates has a correlation of neighbours, and of spheres farther apart, that ordinary packings lack.
/// C(d) itself swings up to 2.4 mean diameters in both, the more the sharper contacts are: the mean over all
/// pairs does not.
void expect_no_separation(const SizeCorrelation& ordinary, const SizeCorrelation& exchanged) {
  ASSERT_TRUE(ordinary.neighbours && exchanged.neighbours);
  tell("neighbours", ordinary.neighbours->correlation, exchanged.neighbours->correlation);
  EXPECT_LT(exchanged.neighbours->correlation, 0.03);
  EXPECT_NEAR(exchanged.neighbours->correlation, ordinary.neighbours->correlation, 0.03);
  const double near = ordinary.mean_between(1, 2)->c, near_exchanged = exchanged.mean_between(1, 2)->c;
  tell("one_to_two", near, near_exchanged);
  EXPECT_NEAR(near_exchanged, near, 0.03);
  for (const SizeCorrelation* of : {&ordinary, &exchanged}) {
    const SizeCorrelation::Mean far = of->mean_between(2.5, 5).value();
    EXPECT_LT(std::abs(far.c), 4 * far.error);
    for (std::size_t k = 0; k < of->c.size(); ++k) {
      if (of->d[k] < 2.5 * of->mean_diameter) continue;
      EXPECT_LT(std::abs(of->c[k]), 5 * of->error[k]) << of->d[k] / of->mean_diameter;
    }
  }
}

class Exchanged : public ::testing::TestWithParam<Sizes> {};

INSTANTIATE_TEST_SUITE_P(, Exchanged, ::testing::ValuesIn(asked),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Exchanged, IsDenserAndAsDisorderedWithTheSameSizes) {
  const Measured ordinary = packed(GetParam(), false), exchanged = packed(GetParam(), true);
  tell("packing_fraction", ordinary.of.packing_fraction, exchanged.of.packing_fraction);
  EXPECT_GE(exchanged.of.packing_fraction, GetParam().least);
  EXPECT_EQ(exchanged.packing.spheres.r, ordinary.packing.spheres.r);
  expect_no_crystals(ordinary.of.order.value(), exchanged.of.order.value());
  expect_no_separation(ordinary.of.size_correlation.value(), exchanged.of.size_correlation.value());
}

Plan plan_of_part(bool exchange) {
  return testing::plan_of(fmt::format(
      "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = "
      "\"{}/meshes/block_fillets_bore.step\"\n[spheres]\nfill = "
      "true\ndraw = \"quantiles\"\ndiameter = {{ distribution = \"lognormal\", median = 1.5, sigma = 0.3 "
      "}}\n[[stage]]\ndo = \"relax\"\nexchange = {}\n",
      BERNAL_DATA, exchange));
}

TEST(ExchangedInACadPart, HasADenserCore) {
  const Packing ordinary = certified(plan_of_part(false)), exchanged = certified(plan_of_part(true));
  // A block 20 mm thick: its core is more than 4.7 mm from all walls.
  const auto profile = [](const Packing& of) { return wall_profile(of.spheres, of.domain).value(); };
  const WallProfile before = profile(ordinary), after = profile(exchanged);
  tell("core", before.core_packing_fraction, after.core_packing_fraction);
  ASSERT_TRUE(before.has_core && after.has_core);
  EXPECT_LT(before.core_packing_fraction, 0.67);
  EXPECT_GE(after.core_packing_fraction, 0.68);
  EXPECT_GT(exchanged.packing_fraction(), ordinary.packing_fraction() + 0.02);
  EXPECT_EQ(bond_order(exchanged.spheres, exchanged.domain)->all.crystalline / 100, 0u);
  const auto drawn = compare_with_drawn(exchanged.spheres.r,
                                        {*plan_of_part(true).radii, exchanged.seed, Draw::quantiles}, true);
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->missing, 0u);
  tell("size_near_the_wall", before.segregation->volume_ratio, after.segregation->volume_ratio);
}

}  // namespace exchange_test
}  // namespace bernal
