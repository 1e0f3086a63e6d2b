#include "bernal/predict/mixtures.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"

namespace bernal::figures {
namespace {

constexpr int rods_a_curve = 16000;
constexpr double widths[] = {0, 0.3, 0.6};
constexpr double ratios[] = {1, 2, 4, 8};
constexpr const char* strokes[] = {"line one heavy", "line two dashed", "line three dotdash",
                                   "line four thin"};

}  // namespace

/// Farr's figure 5: mixtures of two lognormal populations over the share of b; a panel a pair of widths,
/// sigma_a from left to right and sigma_b from top to bottom.
Files figure_5(const FigureOptions& options) {
  const std::vector<double> shares = spread(0, 1, 100);
  std::string csv = "sigma_a,sigma_b,ratio,share_b,phi,error\n", panels;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (options.monitor.stop()) return {};
      options.monitor.report({"figure 5", (3 * row + column) / 9.0, "of the panels"});
      const double sigma_a = widths[column], sigma_b = widths[row];
      const double left = 78 + 262 * column, top = 112 + 232 * row;
      Plot plot({left, top, left + 222, top + 170}, {0, 1, row == 2 ? "share w of b in the volume" : ""},
                {0.6, 0.9, column == 0 && row == 0 ? "packing fraction φ" : ""});
      plot.axes();
      add_text(plot, left + 111, top - 8, "middle", fmt::format("σa = {}, σb = {}", sigma_a, sigma_b));
      for (int k = 0; k < 4; ++k) {
        const auto predictions = predict_shares({sigma_a, sigma_b, ratios[k]}, shares, rods_a_curve);
        std::vector<double> phi;
        for (std::size_t i = 0; i < shares.size(); ++i) {
          phi.push_back(predictions[i].phi);
          csv += fmt::format("{},{},{},{},{:.7f},{:.2g}\n", sigma_a, sigma_b, ratios[k], shares[i], phi[i],
                             predictions[i].error);
        }
        plot.line(shares, phi, strokes[k]);
        if (row == 0 && column == 0)
          legend_line(plot, 78 + 196 * k, 54, strokes[k], fmt::format("R = {}", ratios[k]));
      }
      panels += std::move(plot).finish();
    }
  }
  return {{"fig5.svg",
           svg_document(850, 822, "Two lognormal populations; R: mean diameter of b over that of a", panels)},
          {"fig5.csv", csv}};
}

}  // namespace bernal::figures
