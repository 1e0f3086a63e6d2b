#include <algorithm>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "bernal/figures/figures.hpp"
#include "support/folder.hpp"

// What the pages of `bernal reproduce` claim, held against print. The published loop with 10,000 spheres, a
// minute and a half each, is left to the command; relax_table2_test.cpp has it with 1,000.
namespace bernal {
namespace papers_test {

using testing::Folder;
using testing::text_of;

/// The lines of a CSV, each by the names of its columns.
std::vector<std::map<std::string, std::string>> lines_of(const std::filesystem::path& file) {
  std::istringstream in(text_of(file));
  std::string line, field;
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> lines;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::vector<std::string> row;
    for (bool quoted = false; std::getline(fields, field, ',');) {
      quoted ? row.back() += "," + field : row.emplace_back(field);
      if (std::ranges::count(field, '"') % 2 == 1) quoted = !quoted;
    }
    if (names.empty()) {
      names = row;
      continue;
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (k == 0) lines.emplace_back();
      lines.back()[names[k]] = k < row.size() ? row[k] : "";
    }
  }
  return lines;
}

double number(const std::map<std::string, std::string>& line, const std::string& name) {
  return std::stod(line.at(name));
}

/// 26,787 spheres at 52.89 %, and what local directions and shaking buy.
TEST(Han2005, IsReachedAndItsPartsBuyPackingFraction) {
  const Folder folder;
  ASSERT_FALSE(write_figure("han2005", folder.path(), {.spheres = 26'787}).empty());
  std::map<std::string, double> phi;
  int as_printed = 0;
  for (const auto& line : lines_of(folder.path() / "han2005.csv")) {
    if (line.at("group") == "as printed") {
      ++as_printed;
      EXPECT_EQ(number(line, "spheres"), 26'787);
      // Uniform radii are drawn evenly: their volume is right to one sphere in some thousands.
      EXPECT_NEAR(number(line, "phi"), 0.5289, 5e-4);
    }
    if (line.at("group") == "protocols") phi[line.at("protocol")] = number(line, "phi");
  }
  EXPECT_EQ(as_printed, 2);
  EXPECT_GT(phi.at("\"local directions, refilling\""), phi.at("\"one direction, refilling\"") + 0.02);
  EXPECT_GT(phi.at("\"one direction, shaking, refilling\""), phi.at("\"one direction, refilling\"") + 0.02);
  EXPECT_GT(phi.at("\"local directions, shaking, refilling\""), phi.at("\"local directions, refilling\""));
}

/// Figure 3 packs the rows of table 2: looser than print by three of its errors it may not be.
TEST(Farr2013, Figure3IsAsDenseAsPrinted) {
  const Folder folder;
  ASSERT_FALSE(write_figure("fig3", folder.path()).empty());
  const auto lines = lines_of(folder.path() / "fig3.csv");
  ASSERT_EQ(lines.size(), 6u);
  for (const auto& line : lines) {
    EXPECT_EQ(number(line, "spheres"), line.at("row") == "1" ? 1024 : 2048);
    EXPECT_GT(number(line, "phi"), number(line, "phi_kts") - 0.003);
    EXPECT_LT(number(line, "phi"), number(line, "phi_kts") + 0.012);
  }
  const std::string svg = text_of(folder.path() / "fig3.svg");
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

/// The published loop, 1,000 spheres: a fixed short period costs packing fraction, and the sizes that the
/// printed formula draws pack less densely than those that it is said to draw.
TEST(Zhao2007, PeriodsAndTheMissingFactor) {
  const Folder folder;
  ASSERT_FALSE(write_figure("zhao2007", folder.path(), {.spheres = 1000}).empty());
  std::map<std::string, double> phi;
  for (const auto& line : lines_of(folder.path() / "zhao2007.csv")) {
    if (line.at("spheres") != "1000" || line.at("phi0") != "0.86" || line.at("seed") != "1") continue;
    phi[line.at("sizes") + " " + line.at("loop") + " " + line.at("period")] = number(line, "phi");
  }
  EXPECT_GT(phi.at("equal reference adaptive"), phi.at("equal reference 20") + 0.005);
  // 0.6645 and 0.6545 with 10,000 spheres; one packing of 1,000 scatters by 0.002 and is 0.002 looser.
  EXPECT_NEAR(phi.at("lognormal 0.3 reference adaptive"), 0.6645, 0.009);
  EXPECT_NEAR(phi.at("lognormal 0.212 reference adaptive"), 0.6545, 0.009);
  EXPECT_GT(phi.at("lognormal 0.3 reference adaptive"), phi.at("lognormal 0.212 reference adaptive"));
}

}  // namespace papers_test
}  // namespace bernal
