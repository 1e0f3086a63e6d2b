#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "figures/figure_files.hpp"
#include "figures/page.hpp"

namespace bernal::figures {
namespace {

/// A CSV of ours: no quotes in it.
class Columns {
 public:
  explicit Columns(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line, field;
    for (bool is_head = true; std::getline(lines, line); is_head = false) {
      std::istringstream fields(line + ",");
      for (std::size_t k = 0; std::getline(fields, field, ','); ++k) {
        if (is_head)
          names_.push_back(field);
        else
          columns_[names_.at(k)].push_back(field);
      }
    }
  }

  std::size_t rows() const { return columns_.at(names_.front()).size(); }
  bool has(const std::string& name) const { return columns_.contains(name); }
  const std::string& text(const std::string& name, std::size_t row) const { return columns_.at(name)[row]; }
  double number(const std::string& name, std::size_t row) const { return std::stod(text(name, row)); }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::vector<std::string>> columns_;
};

/// What the parts have written.
class Parts {
 public:
  void take(Files files) {
    for (File& file : files) all_.push_back(std::move(file));
  }
  Columns csv(std::string_view name) const {
    return Columns(std::ranges::find(all_, name, &File::name)->text);
  }
  Files files() && { return std::move(all_); }

 private:
  Files all_;
};

std::string rounded(double v, int digits) { return fmt::format("{:.{}f}", v, digits); }

std::string table_1_of(const Columns& c) {
  std::vector<std::vector<std::string>> rows;
  double worst = 0;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    rows.push_back({c.text("sigma", k), c.text("rods", k), c.text("phi_published", k),
                    c.text("phi_with_published_erfc", k), c.text("phi", k),
                    c.text("milliseconds_published", k), c.text("milliseconds", k)});
    worst = std::max(worst, std::abs(c.number("phi_with_published_erfc", k) - c.number("phi_published", k)));
  }
  return "## Table 1: the rod model\n\n" +
         markdown_table({"sigma", "rods", "printed", "with the erfc of the published program",
                         "with an exact erfc", "ms printed", "ms here"},
                        rows) +
         fmt::format(
             R"(
The published program evaluates erfc by a formula that is right to 1.5e-7; with it the printed digits come
out to {:.0e}, and an exact one changes the fifth at sigma = 1. Printed times are of a 3.2 GHz Pentium.

)",
             std::max(worst, 1e-6));
}

std::string table_2_of(const Columns& rods, const Columns& grown) {
  std::vector<std::string> head = {"sizes",       "rods printed", "rods here",
                                   "KTS printed", "growth here",  "difference"};
  if (rods.has("phi_relax")) head.emplace_back("relax here");
  std::vector<std::vector<std::string>> rows;
  double least = 1, most = -1;
  for (std::size_t k = 0; k < rods.rows(); ++k) {
    const bool one = rods.text("ratio", k).empty();
    const double off = grown.number("phi", k) - rods.number("phi_kts", k);
    least = std::min(least, off);
    most = std::max(most, off);
    std::string sizes =
        one ? "σ " + rods.text("sigma_a", k)
            : fmt::format("σ {} and σ {}, 1 : 2", rods.text("sigma_a", k), rods.text("sigma_b", k));
    rows.push_back({std::move(sizes), rods.text("phi_rods_published", k),
                    rounded(rods.number("phi_rods", k), 4),
                    rods.text("phi_kts", k) + " ± " + rods.text("error_kts", k),
                    rounded(grown.number("phi", k), 4), fmt::format("{:+.4f}", off)});
    if (rods.has("phi_relax")) rows.back().push_back(rounded(rods.number("phi_relax", k), 4));
  }
  return "## Table 2 and figures 3 and 4: mixtures\n\n![figure 4](table2.svg)\n![figure 3](fig3.svg)\n\n" +
         markdown_table(head, rows) +
         fmt::format(
             R"(
Growth with delta = 0.1 and the printed number of spheres and first packing fraction, one seed. It ends
{:+.4f} to {:+.4f} from print: when their growth stopped and how often it was rescaled is not in the text.

)",
             least, most);
}

std::string figure_1_of(const Columns& c) {
  double worst = 0, at = 0;
  for (std::size_t k = 0; k < c.rows(); ++k)
    if (const double off = std::abs(c.number("fit_minus_rods", k)); off > worst) {
      worst = off;
      at = c.number("sigma", k);
    }
  return fmt::format(
      R"(## Figure 1: one lognormal population

![figure 1](fig1.svg)

The curve and, in the inset, how far the fit of eq. 27 is off: at most {:.1e}, at sigma = {:g}. The
printed curve is not in the text; its values at 0, 0.5 and 1 are those of table 1.

)",
      worst, at);
}

std::string figure_2_of(const Columns& c) {
  std::vector<std::vector<std::string>> rows;
  std::map<std::string, double> rods;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    const std::string& source = c.text("source", k);
    const std::string sigma = rounded(c.number("sigma", k), 2);
    if (source == "rods")
      rods[sigma] = c.number("phi", k);
    else
      rows.push_back(
          {source == "KTS" ? "KTS, printed" : source + ", here", sigma, c.text("spheres", k),
           rounded(c.number("phi", k), 4),
           source == "KTS" ? rounded(rods[sigma], 4) : rounded(c.number("phi_rods_of_them", k), 4)});
  }
  return "## Figure 2: packings of lognormal spheres\n\n![figure 2](fig2.svg)\n\n" +
         markdown_table({"source", "sigma", "spheres", "packing fraction", "rod model of these"}, rows) +
         R"(
Of the printed points those of table 2 alone are in the text. The rod model is that of the very spheres that
were packed, which are so many and no more; of KTS, of the distribution. At sigma = 1 sizes end four sigmas
above the median by number, so that 16 % of the volume are cut off: larger spheres leave the box of 50,000
too little room.

)";
}

std::string figure_5_of(const Columns& c) {
  // The lower left panel: equal spheres, and wide ones.
  std::map<double, double> least;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    if (c.number("sigma_a", k) != 0 || c.number("sigma_b", k) != 0.6 ||
        std::abs(c.number("share_b", k) - 0.3) > 1e-6)
      continue;
    least[c.number("ratio", k)] = c.number("phi", k);
  }
  const bool as_printed = least.at(2) < least.at(1);
  return fmt::format(
      R"(## Figure 5: mixtures of two populations

![figure 5](fig5.svg)

Printed: in the lower left panel, where equal spheres (a) are mixed with wide ones (b, sigma 0.6), the
lowest packing fraction need not be at equal means. Here, where 30 % of the volume are b: {:.4f} at equal
means and {:.4f} at means of 1 : 2: {}.

)",
      least.at(1), least.at(2), as_printed ? "so it is" : "it is not so at this share");
}

std::string figure_6_of(const Columns& c) {
  double least = 1, most = 0;
  for (std::size_t k = 0; k < c.rows(); ++k) {
    if (c.text("source", k) != "rods") continue;
    least = std::min(least, c.number("phi", k));
    most = std::max(most, c.number("phi", k));
  }
  return fmt::format(
      R"(## Figure 6: the densest of three sizes

![figure 6](fig6.svg)

Printed: contours at every 0.01, bold from 0.65 at the bottom left to 0.9 near the top right. Here: from
{:.4f} to {:.4f}, so the same bold contours are {}.

)",
      least, most, least < 0.65 && most > 0.9 ? "in it" : "not all in it");
}

}  // namespace

/// All figures and tables of Farr (2013), and a page about them.
Files farr_2013(const FigureOptions& options) {
  const Stopwatch watch;
  Parts parts;
  for (Files (*make)(const FigureOptions&) :
       {figure_1, figure_2, figure_3, figure_5, figure_6, table_1, table_2}) {
    Files files = make(options);
    if (files.empty()) return {};
    parts.take(std::move(files));
  }
  std::string page = table_1_of(parts.csv("table1.csv")) +
                     table_2_of(parts.csv("table2.csv"), parts.csv("fig3.csv")) +
                     figure_1_of(parts.csv("fig1.csv")) + figure_2_of(parts.csv("fig2.csv")) +
                     figure_5_of(parts.csv("fig5.csv")) + figure_6_of(parts.csv("fig6.csv"));
  page = fmt::format(
             R"(# Farr (2013), done again

R. S. Farr: *Random close packing fractions of lognormal distributions of hard spheres*. Powder Technology
245 (2013) 28–34. Written by `bernal reproduce farr2013{}` in {:.0f} s on: {}.

)",
             options.pack ? " --pack" : "", watch.seconds(), processor_name()) +
         page;
  Files files = std::move(parts).files();
  files.insert(files.begin(), {"farr2013.md", std::move(page)});
  return files;
}

}  // namespace bernal::figures
