#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bernal/figures/figures.hpp"
#include "support/folder.hpp"

// Figure 6 of Farr, Powder Technology 245, 28 (2013), claims what no packing was made for: the densest
// mixtures of three sizes. Four of its points are packed here in three dimensions, one of them with
// all three sizes.
namespace bernal {
namespace densest_of_three_sizes_test {

TEST(DensestOfThreeSizes, PacksAsDenselyAsTheRodModelSays) {
  const testing::Folder folder;
  FigureOptions options;
  options.pack = true;
  ASSERT_EQ(write_figure("fig6", folder.path(), options).size(), 2u);
  const std::string csv = testing::text_of(folder.path() / "fig6.csv");
  int packed = 0, three = 0;
  double corner = 0;
  std::map<long, double> two_sizes;  // the densest of D1 and D3 alone, by 1e4 ln D3 / D1, from the first row
  for (std::size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1) {
    const std::string line = csv.substr(at, csv.find('\n', at) - at);
    double second = 0, third = 0, phi = 0, shares[3], predicted = 0;
    if (std::sscanf(line.c_str(), "rods,%lf,%lf,%lf", &second, &third, &phi) == 3) {
      corner = phi;
      const long ratio = std::lround(1e4 * std::log(second * third));
      if (third == 1) two_sizes[ratio] = phi;
      // The digits of the ratios are six, so that equal ones may round apart.
      for (const long k : {ratio - 1, ratio, ratio + 1}) {
        if (!two_sizes.contains(k)) continue;
        EXPECT_GT(phi, two_sizes[k] - 1e-4) << "D2 / D1 " << second << ", D3 / D2 " << third;
      }
    }
    if (std::sscanf(line.c_str(), "relax,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &second, &third, &phi, &shares[0],
                    &shares[1], &shares[2], &predicted) != 7)
      continue;
    ++packed;
    RecordProperty(fmt::format("{}_{}", second, third), fmt::format("{:.4f} of {:.4f}", phi, predicted));
    // Where three sizes are in it `relax` stays below the model: 0.025 at 1 : 3 : 9, less the slower it is.
    const bool has_three = std::ranges::min(shares) > 0;
    three += has_three;
    EXPECT_NEAR(phi, predicted, has_three ? 0.03 : 0.01) << "D2 / D1 " << second << ", D3 / D2 " << third;
    EXPECT_GT(phi, 0.67);  // denser than any of the three sizes alone
  }
  EXPECT_EQ(packed, 4);
  EXPECT_EQ(three, 1);
  EXPECT_GT(corner, 0.9);  // the last point of the grid, 1 : 10 : 100
}

}  // namespace densest_of_three_sizes_test
}  // namespace bernal
