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
  if (!packed.certified || packed.outcome != Outcome::converged)
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
