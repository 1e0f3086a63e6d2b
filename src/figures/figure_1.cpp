#include "bernal/predict/mixtures.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"

namespace bernal::figures {

/// Farr's figure 1: phi of lognormal spheres over their width, and in the inset how far the fit is off.
Files figure_1(const FigureOptions& options) {
  constexpr int rods = 64000;
  const std::vector<double> sigmas = spread(0, 3, 120);
  const auto sizes = [&](std::size_t i) { return make_two_populations({.sigma_a = sigmas[i], .share = 0}); };
  const std::vector<Prediction> predictions =
      predict_all(sigmas.size(), sizes, rods, "figure 1", options.monitor);
  if (predictions.empty()) return {};

  std::string csv = "sigma,phi_rods,error_from_rods,phi_fit,fit_minus_rods\n";
  std::vector<double> phi, off;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    const double fit = fitted_packing_fraction(sigmas[i]);
    phi.push_back(predictions[i].phi);
    off.push_back(fit - phi.back());
    csv +=
        fmt::format("{},{:.7f},{:.2g},{:.7f},{:.7f}\n", sigmas[i], phi[i], predictions[i].error, fit, off[i]);
  }

  Plot plot({78, 84, 700, 440}, {0, 3, "width σ of ln(diameter)"}, {0.6, 1, "packing fraction φ"});
  plot.axes();
  plot.add("<rect class=\"page\" x=\"364\" y=\"232\" width=\"328\" height=\"200\"/>");
  plot.line(sigmas, phi, "line heavy");
  Plot inset({430, 278, 672, 385}, {0, 3, "σ"}, {-4e-4, 4e-4, "Farr's fit (eq. 27) − rods"});
  inset.axes();
  inset.line(sigmas, off, "line three");
  return {{"fig1.svg", svg_document(730, 500, "Random close packing of lognormal spheres, by 64,000 rods",
                                    std::move(plot).finish() + std::move(inset).finish())},
          {"fig1.csv", csv}};
}

}  // namespace bernal::figures
