#include "bernal/figures/figures.hpp"

#include <algorithm>
#include <string>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "figures/figure_files.hpp"
#include "figures/published.hpp"
#include "io/staged_folder.hpp"

namespace bernal {
namespace {

constexpr int least_spheres_of_a_figure = 100;

struct Entry {
  Figure figure;
  figures::Files (*make)(const FigureOptions&);
};

constexpr Entry entries[] = {
    {{"fig1", "Farr: lognormal spheres, sigma 0 to 3, and the error of his fit", "1 s", false, false},
     figures::figure_1},
    {{"fig2", "Farr: lognormal spheres, the rod model against packings", "1 s, with --pack 3 min", true,
      false},
     figures::figure_2},
    {{"fig2soft", "Farr: figure 2 with soft particles, packed by LAMMPS, which it needs", "1 min", false,
      true},
     figures::soft_particles},
    {{"fig3", "Farr: pictures of the packings of table 2, by growth", "15 s", false, false},
     figures::figure_3},
    {{"fig4", "Farr: the data of table 2, drawn; the files of table2", "1 s, with --pack 20 s", true, false},
     figures::table_2},
    {{"fig5", "Farr: mixtures of two lognormal populations, 9 panels, ratios 1, 2, 4 and 8", "1 s", false,
      false},
     figures::figure_5},
    {{"fig6", "Farr: the densest mixtures of three sizes, over both ratios of sizes", "1 min", true, false},
     figures::figure_6},
    {{"table1", "Farr: packing fractions and milliseconds of the rod model", "1 s", false, false},
     figures::table_1},
    {{"table2", "Farr: mixtures of two lognormal populations, the rod model against packings",
      "1 s, with --pack 20 s", true, false},
     figures::table_2},
    {{"farr2013", "all of these, and a page of printed and own values", "90 s, with --pack 5 min", true,
      false},
     figures::farr_2013},
    {{"zhao2007", "Zhao, Li & Liu: figures 1, 2, 5, 8 to 12, table 2, and a page",
      "5 min, with --pack 10 min", true, true},
     figures::zhao_2007},
    {{"han2005", "Han, Feng & Owen: the cylinder, local directions, shaking, time, and a page", "2 min",
      false, true},
     figures::han_2005}};

}  // namespace

std::vector<std::filesystem::path> figures::write_files(const Files& files,
                                                        const std::filesystem::path& folder) {
  if (files.empty()) return {};
  StagedFolder staged(folder);
  for (const File& file : files) staged.write(file.name, file.text);
  return staged.publish();
}

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
  if (options.spheres != 0 && options.spheres < least_spheres_of_a_figure)
    throw Error(ErrorCode::bad_argument,
                "a figure needs packings of at least 100 spheres, not " + std::to_string(options.spheres));
  try {
    const Interruptible listening(options.monitor);
    return figures::write_files(entry->make(options), folder);
  } catch (const Cancelled&) {
    return {};
  }
}

std::optional<PredictionCheck> figures::packed_for_a_figure(const Scene& scene, std::string_view figure,
                                                            double done, const FigureOptions& options) {
  CheckOptions check;
  check.monitor.cancelled = options.monitor.cancelled;
  check.monitor.on_progress = [&](const Progress& progress) {
    options.monitor.report({figure, done, progress.detail});
  };
  const PredictionCheck packed = check_prediction(scene, check);
  if (packed.outcome == Outcome::cancelled) return std::nullopt;
  if (!packed.certified || !is_packed(packed.outcome))
    throw Error(ErrorCode::bad_argument, "a packing for the figure did not converge, or is not certified");
  return packed;
}

std::optional<PredictionCheck> figures::packed_for_a_figure(const TwoPopulations& sizes,
                                                            std::string_view figure, double done,
                                                            const FigureOptions& options) {
  CheckOptions check;
  check.spheres = 10'000;
  check.seed = options.seed;
  return packed_for_a_figure(scene_to_check(sizes_of(sizes), true, check), figure, done, options);
}

}  // namespace bernal
