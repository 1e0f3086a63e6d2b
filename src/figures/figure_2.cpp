#include <cmath>
#include <optional>

#include "bernal/core/error.hpp"
#include "bernal/figures/check_prediction.hpp"
#include "bernal/hard/grow.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/packings.hpp"
#include "figures/published.hpp"

namespace bernal::figures {
namespace {

/// Packings by growth: as printed, delta = 0.1, as long as that jams; beyond with the growth of our own, and
/// so many spheres that the largest of them leaves the box room. At sigma = 1 that is not so with 50,000:
/// they are cut, and 200,000 have come to 0.34 only after five minutes.
struct Grown {
  double sigma;
  int spheres;
  bool as_printed;
  std::optional<double> widest =
      {};  ///< where sizes are cut, in sigmas from the mean of ln(diameter) by volume
};
constexpr Grown grown[] = {{0, 1024, true},    {0.1, 2048, true},    {0.2, 2048, true},
                           {0.3, 2048, true},  {0.4, 2048, true},    {0.5, 2048, true},
                           {0.6, 5000, false}, {0.8, 20'000, false}, {1, 50'000, false, 1.0}};

Scene scene_of(const Grown& point, const FigureOptions& options) {
  CheckOptions check;
  check.spheres = point.spheres;
  check.seed = options.seed;
  check.stage = point.as_printed ? Grow{.delta = 0.1, .phi_init = point.sigma == 0 ? 0.2 : 0.15}
                                 : Grow{.pressure = 1e3};
  SceneSizes sizes = sizes_of({.sigma_a = point.sigma, .share = 0});
  if (point.widest) {
    Lognormal& cut = std::get<Lognormal>(sizes);
    cut.max = *cut.median * std::exp(*point.widest * point.sigma);
  }
  return scene_to_check(sizes, true, check);
}

}  // namespace

/// Farr's figure 2: lognormal spheres by rods and by packing them.
Files figure_2(const FigureOptions& options) {
  constexpr int rods = 16000;
  constexpr double widest = 1, widest_packed = 0.7;
  const std::vector<double> sigmas = spread(0, widest, 100);
  const auto sizes = [&](std::size_t i) { return make_two_populations({.sigma_a = sigmas[i], .share = 0}); };
  const std::vector<Prediction> predictions =
      predict_all(sigmas.size(), sizes, rods, "figure 2", options.monitor);
  if (predictions.empty()) return {};

  std::string csv = "source,sigma,phi,error,spheres,phi_rods_of_them\n";
  std::vector<double> phi;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    phi.push_back(predictions[i].phi);
    csv += fmt::format("rods,{},{:.7f},{:.2g},,\n", sigmas[i], phi[i], predictions[i].error);
  }

  Plot plot({78, 136, 700, 440}, {0, widest, "width σ of ln(diameter)"}, {0.62, 0.82, "packing fraction φ"});
  plot.axes();
  plot.line(sigmas, phi, "line heavy");
  legend_line(plot, 100, 58, "line heavy", "rod model, 16,000 rods");
  legend_marker(plot, Marker::triangle, 340, 58, "KTS, 1,024 and 2,048 spheres (Farr, table 2)");
  for (const PublishedMixture& row : published_mixtures) {
    if (!row.is_one_population()) continue;
    csv += fmt::format("KTS,{},{},{},{},\n", row.mix.sigma_a, row.kts, row.kts_error, row.spheres);
    add_error_bar(plot, row.mix.sigma_a, row.kts, row.kts_error);
    add_marker(plot, Marker::triangle, row.mix.sigma_a, row.kts);
  }
  if (options.pack) {
    legend_marker(plot, Marker::disc, 340, 80, "packed by relax, 10,000 spheres");
    legend_marker(plot, Marker::ring, 340, 102, "packed by growth: σ to 0.5 as KTS, then slower");
    for (const double sigma : spread(0, widest_packed, 7)) {
      const std::optional<PredictionCheck> packed =
          packed_for_a_figure({.sigma_a = sigma, .share = 0}, "figure 2", sigma / widest_packed, options);
      if (!packed) return {};
      csv += fmt::format("relax,{:.1f},{:.6f},,{},{:.6f}\n", sigma, packed->phi, packed->spheres,
                         packed->predicted);
      add_marker(plot, Marker::disc, sigma, packed->phi);
    }
    std::vector<PackingTask> tasks;
    for (const Grown& point : grown)
      tasks.push_back({.scene = scene_of(point, options), .cost = point.spheres * (1 + 2 * point.sigma)});
    const std::optional<std::vector<DonePacking>> done = pack_all(tasks, "figure 2", options);
    if (!done) return {};
    for (std::size_t k = 0; k < done->size(); ++k) {
      const DonePacking& each = (*done)[k];
      if (!is_packed(each.packing.outcome))
        throw Error(ErrorCode::bad_argument, "a packing for figure 2 did not jam");
      csv += fmt::format("grow,{:.1f},{:.6f},,{},{:.6f}\n", grown[k].sigma, each.phi,
                         each.packing.spheres.size(), predicted_for(each.packing.spheres.r));
      add_marker(plot, Marker::ring, grown[k].sigma, each.phi);
    }
  }
  return {{"fig2.svg",
           svg_document(730, 500, "Random close packing of lognormal spheres", std::move(plot).finish())},
          {"fig2.csv", csv}};
}

}  // namespace bernal::figures
