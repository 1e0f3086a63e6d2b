#include <optional>

#include "bernal/figures/check_prediction.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/published.hpp"

namespace bernal::figures {

/// Farr's figure 2: lognormal spheres by rods and by packing them.
Files figure_2(const FigureOptions& options) {
  constexpr int rods = 16000;
  constexpr double widest = 1, widest_packed = 0.7;
  const std::vector<double> sigmas = spread(0, widest, 100);
  const auto sizes = [&](std::size_t i) { return make_two_populations({.sigma_a = sigmas[i], .share = 0}); };
  const std::vector<Prediction> predictions =
      predict_all(sigmas.size(), sizes, rods, "figure 2", options.monitor);
  if (predictions.empty()) return {};

  std::string csv = "source,sigma,phi,error,spheres\n";
  std::vector<double> phi;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    phi.push_back(predictions[i].phi);
    csv += fmt::format("rods,{},{:.7f},{:.2g},\n", sigmas[i], phi[i], predictions[i].error);
  }

  Plot plot({78, 116, 700, 440}, {0, widest, "width σ of ln(diameter)"}, {0.62, 0.82, "packing fraction φ"});
  plot.axes();
  plot.line(sigmas, phi, "line heavy");
  legend_line(plot, 100, 58, "line heavy", "rod model, 16,000 rods");
  legend_marker(plot, Marker::triangle, 340, 58, "KTS, 1,024 and 2,048 spheres (Farr, table 2)");
  for (const PublishedMixture& row : published_mixtures) {
    if (!row.is_one_population()) continue;
    csv += fmt::format("KTS,{},{},{},{}\n", row.mix.sigma_a, row.kts, row.kts_error, row.spheres);
    add_error_bar(plot, row.mix.sigma_a, row.kts, row.kts_error);
    add_marker(plot, Marker::triangle, row.mix.sigma_a, row.kts);
  }
  if (options.pack) {
    legend_marker(plot, Marker::disc, 340, 80, "packed by relax, 10,000 spheres");
    for (const double sigma : spread(0, widest_packed, 7)) {
      const std::optional<PredictionCheck> packed =
          packed_for_a_figure({.sigma_a = sigma, .share = 0}, "figure 2", sigma / widest_packed, options);
      if (!packed) return {};
      csv += fmt::format("relax,{:.1f},{:.6f},,{}\n", sigma, packed->phi, packed->spheres);
      add_marker(plot, Marker::disc, sigma, packed->phi);
    }
  }
  return {{"fig2.svg",
           svg_document(730, 500, "Random close packing of lognormal spheres", std::move(plot).finish())},
          {"fig2.csv", csv}};
}

}  // namespace bernal::figures
