#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/contact_list.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

// Crystals: known packing fractions and numbers of neighbours.
namespace bernal {
namespace insert_crystal_test {

using testing::plan_of;

struct Known {
  std::string layout;
  std::uint32_t neighbours;
  double density;
};
const Known known[] = {{"fcc", 12, std::numbers::pi / std::sqrt(18.0)},
                       {"bcc", 8, std::numbers::pi* std::sqrt(3.0) / 8},
                       {"hcp", 12, std::numbers::pi / std::sqrt(18.0)},
                       {"sc", 6, std::numbers::pi / 6}};

Packing packed(const std::string& container, const std::string& spheres, const std::string& layout,
               const std::string& keys = "") {
  const Packing packing = run(plan_of("unit = \"mm\"\n[container]\n" + container + "[spheres]\n" + spheres +
                                      "[[stage]]\ndo = \"insert\"\nlayout = \"" + layout + "\"\n" + keys),
                              {.threads = 1});
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << layout << ": " << certificate.statement;
  return packing;
}

std::string refusal(const std::string& container, const std::string& spheres, const std::string& layout,
                    const std::string& keys = "") {
  try {
    packed(container, spheres, layout, keys);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Of the spheres that are so far from all walls that all their neighbours fit, every one has them all.
std::size_t expect_neighbours(const Packing& packing, double diameter, std::uint32_t neighbours) {
  const ContactSums sums = contact_sums(packing.spheres, packing.domain, {.contact_gap = 1e-6});
  const auto bounds = bounds_of<dynamic>(packing.domain);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    EXPECT_LE(sums.coordination[i], neighbours);
    const Vector<dynamic> c = packing.spheres.center(i);
    bool is_inside = true;
    for (int k = 0; k < c.size(); ++k)
      is_inside = is_inside && std::min(c[k] - bounds.lower[k], bounds.upper[k] - c[k]) > 2.3 * diameter;
    if (!is_inside) continue;
    EXPECT_EQ(sums.coordination[i], neighbours) << i;
    ++inside;
  }
  return inside;
}

TEST(InsertCrystal, InABoxHasTheNeighboursOfItsName) {
  for (const Known& k : known) {
    SCOPED_TRACE(k.layout);
    const Packing packing =
        packed("kind = \"box\"\nsize = [11.3, 12.1, 10.7]\n", "fill = true\ndiameter = 1\n", k.layout);
    EXPECT_EQ(packing.outcome, Outcome::converged);
    EXPECT_GT(expect_neighbours(packing, 1, k.neighbours), 200u);
    EXPECT_GT(packing.packing_fraction(), 0.75 * k.density);
    EXPECT_LT(packing.packing_fraction(), k.density);
  }
}

TEST(InsertCrystal, OfABoxOfWholeDiametersTouchesAllItsWalls) {
  const Packing packing =
      packed("kind = \"box\"\nsize = [10, 10, 10]\n", "fill = true\ndiameter = 1\n", "sc");
  EXPECT_EQ(packing.spheres.size(), 1000u);
  const Packing third = packed("kind = \"box\"\nsize = [10, 10, 10]\ncorner = [-3, 0.5, 7]\n",
                               "fill = true\ndiameter = 1.25\n", "sc");
  EXPECT_EQ(third.spheres.size(), 512u);
}

/// Where the planes of sites are no coordinates that the packer's unit has.
TEST(InsertCrystal, LeavesNoPlaneOut) {
  for (const auto& [layout, sites] : {std::pair{"bcc", 2000.0}, std::pair{"fcc", 2048.0}}) {
    const Packing packing = packed("kind = \"box\"\nsize = [12, 12, 12]\ncorner = [0.1, 1.7, -3.3]\n",
                                   "fill = true\ndiameter = 1\n", layout);
    for (int k = 0; k < 3; ++k) {
      std::vector<double> planes = packing.spheres.x[static_cast<std::size_t>(k)];
      std::ranges::sort(planes);
      double widest = 0;
      for (std::size_t i = 1; i < planes.size(); ++i) widest = std::max(widest, planes[i] - planes[i - 1]);
      EXPECT_LT(widest, 0.72) << layout;
      EXPECT_GT(planes.back() - planes.front(), 11 - 0.72) << layout;
    }
    EXPECT_GE(static_cast<double>(packing.spheres.size()), sites) << layout;
  }
}

TEST(InsertCrystal, FillsAPeriodicBoxThatItDivides) {
  const double edges[][3] = {{5 * std::sqrt(2.0), 5 * std::sqrt(2.0), 4 * std::sqrt(2.0)},
                             {6 * 2 / std::sqrt(3.0), 5 * 2 / std::sqrt(3.0), 5 * 2 / std::sqrt(3.0)},
                             {6, 4 * std::sqrt(3.0), 4 * std::sqrt(8.0 / 3)},
                             {6, 7, 8}};
  for (std::size_t n = 0; n < 4; ++n) {
    const Known& k = known[n];
    SCOPED_TRACE(k.layout);
    const auto box = [&](double more) {
      return fmt::format("kind = \"periodic\"\nsize = [{:.12f}, {:.12f}, {:.12f}]\n", edges[n][0] * more,
                         edges[n][1] * more, edges[n][2] * more);
    };
    const Packing packing = packed(box(n == 3 ? 1 : 1 + 1e-10), "fill = true\ndiameter = 1\n", k.layout);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_NEAR(packing.packing_fraction(), k.density, 1e-8);
    const ContactSums sums = contact_sums(packing.spheres, packing.domain, {.contact_gap = 1e-6});
    for (const std::uint32_t own : sums.coordination) EXPECT_EQ(own, k.neighbours);
    // A count takes the first sites, and what is too many is told.
    EXPECT_EQ(packed(box(1 + 1e-10), "count = 50\ndiameter = 1\n", k.layout).outcome, Outcome::converged);
    const Packing full = packed(box(1 + 1e-10), "count = 5000\ndiameter = 1\n", k.layout);
    EXPECT_EQ(full.outcome, Outcome::full);
    EXPECT_EQ(full.spheres.size(), packing.spheres.size());
  }
}

TEST(InsertCrystal, RefusesPeriodsThatItDoesNotDivideAndNamesTheNearest) {
  const std::string wrong =
      refusal("kind = \"periodic\"\nsize = [7.2, 7.2, 5.7]\n", "fill = true\ndiameter = 1\n", "fcc");
  EXPECT_NE(wrong.find("does not fit into periods of 7.2, 7.2, 5.7; it fits into 7.07106781"),
            std::string::npos)
      << wrong;
  // What is offered is accepted.
  const std::string offered = wrong.substr(wrong.find("into 7.07") + 5);
  EXPECT_EQ(refusal("kind = \"periodic\"\nsize = [" + offered + "]\n", "fill = true\ndiameter = 1\n", "fcc"),
            "");
  EXPECT_NE(refusal("kind = \"cylinder\"\nradius = 4\nheight = 9.3\nperiodic = true\n",
                    "fill = true\ndiameter = 1\n", "sc")
                .find("it fits into 9.0000000"),
            std::string::npos);
  EXPECT_NE(
      refusal("kind = \"periodic\"\nedge = 9\n", "fill = true\ndiameter = 1\n", "random").find("layout"),
      std::string::npos);
  EXPECT_NE(refusal("kind = \"periodic\"\n", "count = 32\ndiameter = 1\n", "fcc").find("size"),
            std::string::npos);
}

/// As it is refused, so it is not planned.
TEST(InsertCrystal, IsRefusedBeforeItIsRun) {
  const auto scene = [](const std::string& container, const std::string& keys) {
    return "unit = \"mm\"\n[container]\n" + container +
           "[spheres]\nfill = true\ndiameter = 1\n[[stage]]\ndo = \"insert\"\nlayout = \"fcc\"\n" + keys;
  };
  EXPECT_THROW(plan_of(scene("kind = \"periodic\"\nsize = [5, 5, 5]\n", "")), Error);
  EXPECT_THROW(plan_of(scene("kind = \"box\"\nsize = [9, 9, 9]\n", "spacing = 0.5\n")), Error);
  EXPECT_NO_THROW(plan_of(scene("kind = \"box\"\nsize = [9, 9, 9]\n", "spacing = 1.5\n")));
  EXPECT_NO_THROW(plan_of(scene("kind = \"periodic\"\nedge = 7.0710678119\n", "")));
}

TEST(InsertCrystal, TakesASpacing) {
  const std::string spheres = "fill = true\ndiameter = 1\n";
  const Packing wide =
      packed("kind = \"periodic\"\nsize = [6, 7.2, 8.4]\n", spheres, "sc", "spacing = 1.2\n");
  EXPECT_EQ(wide.spheres.size(), 5u * 6 * 7);
  EXPECT_EQ(contact_sums(wide.spheres, wide.domain).coordination.front(), 0u);
  const Packing box = packed("kind = \"box\"\nsize = [9, 9, 9]\n", spheres, "bcc", "spacing = 1.3\n");
  const ContactSums sums = contact_sums(box.spheres, box.domain, {.contact_gap = 0.3 + 1e-9});
  EXPECT_EQ(sums.spheres_by_contacts().size(), 9u);  // up to eight
  EXPECT_NE(refusal("kind = \"box\"\nsize = [9, 9, 9]\n", spheres, "sc", "spacing = 0.9\n")
                .find("less than the largest diameter"),
            std::string::npos);
  EXPECT_NE(
      refusal("kind = \"box\"\nsize = [9, 9, 9]\n", spheres, "lattice", "spacing = 1.2\n").find("spacing"),
      std::string::npos);
}

TEST(InsertCrystal, LiesInRoundContainersAndBetweenWalls) {
  for (const Known& k : known) {
    SCOPED_TRACE(k.layout);
    const std::string spheres = "fill = true\ndiameter = 0.1\n";
    const Packing cylinder = packed("kind = \"cylinder\"\nradius = 0.71\nheight = 1.37\n", spheres, k.layout);
    EXPECT_GT(cylinder.packing_fraction(), 0.7 * k.density);
    const Packing ball = packed("kind = \"sphere\"\nradius = 0.77\n", spheres, k.layout);
    EXPECT_GT(ball.packing_fraction(), 0.65 * k.density);
    const ContactSums sums = contact_sums(ball.spheres, ball.domain, {.contact_gap = 1e-6});
    for (std::size_t i = 0; i < ball.spheres.size(); ++i)
      if (ball.spheres.center(i).norm() < 0.5) {
        EXPECT_EQ(sums.coordination[i], k.neighbours);
      }
  }
  const Packing slab =
      packed("kind = \"periodic\"\nsize = [6, 7, 8.4]\nwalls = [2]\n", "fill = true\ndiameter = 1\n", "sc");
  EXPECT_EQ(slab.spheres.size(), 6u * 7 * 8);
}

TEST(InsertCrystal, OfACountStandsOnTheFloor) {
  const Packing packing = packed("kind = \"box\"\nsize = [8, 8, 8]\n", "count = 100\ndiameter = 1\n", "sc");
  ASSERT_EQ(packing.spheres.size(), 100u);
  for (const double z : packing.spheres.x[2]) EXPECT_LT(z, 2);
}

TEST(InsertCrystal, OfDiscsIsTheHexagonalOrTheSquareLattice) {
  const std::string box = "kind = \"box\"\nsize = [12, 11]\n", spheres = "fill = true\ndiameter = 1\n";
  EXPECT_GT(expect_neighbours(packed(box, spheres, "hcp"), 1, 6), 20u);
  EXPECT_EQ(packed(box, spheres, "sc").spheres.size(), 132u);
  EXPECT_NE(refusal(box, spheres, "bcc").find("discs"), std::string::npos);
}

TEST(InsertCrystal, HoldsSizesThatDifferBetweenWhatStandsThere) {
  const std::string box = "kind = \"box\"\nsize = [9, 9, 9]\n";
  const Packing packing =
      packed(box, "fill = true\ndiameter = { distribution = \"uniform\", min = 0.5, max = 1 }\n", "fcc");
  EXPECT_EQ(packing.spheres.size(), 12u * 12 * 12 / 2);
}

}  // namespace insert_crystal_test
}  // namespace bernal
