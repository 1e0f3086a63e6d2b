#include "bernal/figures/figures.hpp"

#include <algorithm>
#include <string>

#include "bernal/core/error.hpp"
#include "figures/figure_files.hpp"
#include "figures/write_files.hpp"

namespace bernal {
namespace {

struct Entry {
  Figure figure;
  figures::Files (*make)(const FigureOptions&);
};

constexpr Entry entries[] = {
    {{"fig1", "lognormal spheres, sigma 0 to 3, and the error of Farr's fit", false}, figures::figure_1},
    {{"fig2", "lognormal spheres: the rod model against packings", true}, figures::figure_2},
    {{"fig5", "mixtures of two lognormal populations: 9 panels, ratios 1, 2, 4 and 8", false},
     figures::figure_5},
    {{"fig6", "the densest mixtures of three sizes, over both ratios of sizes", true}, figures::figure_6},
    {{"table1", "packing fractions and milliseconds of the rod model", false}, figures::table_1},
    {{"table2", "mixtures of two lognormal populations: the rod model against packings (and figure 4)", true},
     figures::table_2}};

}  // namespace

std::span<const Figure> all_figures() {
  static const auto all = [] {
    std::vector<Figure> list;
    for (const Entry& entry : entries) list.push_back(entry.figure);
    return list;
  }();
  return all;
}

std::vector<std::filesystem::path> write_figure(std::string_view name, const std::filesystem::path& folder,
                                                const FigureOptions& options) {
  const auto entry = std::ranges::find(entries, name, [](const Entry& e) { return e.figure.name; });
  if (entry == std::end(entries))
    throw Error(ErrorCode::bad_argument, "there is no figure \"" + std::string(name) + "\"");
  return figures::write_files(entry->make(options), folder);
}

}  // namespace bernal
