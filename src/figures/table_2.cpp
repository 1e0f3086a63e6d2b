#include <iterator>
#include <optional>

#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/published.hpp"

namespace bernal::figures {
std::string described(const PublishedMixture& row) {
  if (row.is_equal()) return "equal";
  if (row.is_one_population()) return fmt::format("σ {}", row.mix.sigma_a);
  return fmt::format("σ {} | {}", row.mix.sigma_a, row.mix.sigma_b);
}

/// Farr's table 2 and, of the same data, figure 4.
Files table_2(const FigureOptions& options) {
  std::string csv = "ratio,sigma_a,sigma_b,share_b,phi_rods,phi_rods_published,phi_kts,error_kts,spheres_kts";
  csv += options.pack ? ",phi_relax,spheres_relax,coordination_relax\n" : "\n";
  constexpr double rows = std::size(published_mixtures);
  Plot plot({78, 104, 700, 440}, {-0.5, rows - 0.5, ""}, {0.63, 0.71, "packing fraction φ"});
  std::string axes = "<path class=\"axis\" d=\"M78 440H700\"/>";
  for (const double v : spread(0.63, 0.71, 8)) {
    axes += fmt::format(
        "<path class=\"grid\" d=\"M78 {0:.1f}H700\"/><text x=\"70\" y=\"{1:.1f}\" "
        "text-anchor=\"end\">{2:.2f}</text>",
        plot.y(v), plot.y(v) + 4, v);
  }
  legend_line(plot, 100, 64, "line heavy", "rod model, 16,000 rods");
  legend_marker(plot, Marker::triangle, 320, 64, "KTS (Farr, table 2)");
  if (options.pack) legend_marker(plot, Marker::disc, 520, 64, "relax, 10,000 spheres");
  add_text(plot, 20, 90, "start", "packing fraction φ");
  double row = 0;
  for (const PublishedMixture& p : published_mixtures) {
    if (options.monitor.stop()) return {};
    const double phi = predict_packing_fraction(*make_two_populations(p.mix), 16000).phi;
    csv += p.is_one_population()
               ? fmt::format(",{},,,{:.6f},{},{},{},{}", p.mix.sigma_a, phi, p.rods, p.kts, p.kts_error,
                             p.spheres)
               : fmt::format("{},{},{},{},{:.6f},{},{},{},{}", p.mix.ratio, p.mix.sigma_a, p.mix.sigma_b,
                             p.mix.share, phi, p.rods, p.kts, p.kts_error, p.spheres);
    plot.add("<path class=\"line heavy\" d=\"M{:.1f} {:.1f}h40\"/>", plot.x(row) - 20, plot.y(phi));
    add_error_bar(plot, row, p.kts, p.kts_error);
    add_marker(plot, Marker::triangle, row, p.kts);
    plot.add(
        "<text class=\"label\" x=\"{0:.1f}\" y=\"462\" text-anchor=\"middle\">{1}</text><text x=\"{0:.1f}\" "
        "y=\"480\" text-anchor=\"middle\">{2}</text>",
        plot.x(row), described(p), p.is_one_population() ? "" : "1 : 2");
    if (options.pack) {
      const std::optional<PredictionCheck> packed =
          packed_for_a_figure(p.mix, "table 2", row / rows, options);
      if (!packed) return {};
      csv += fmt::format(",{:.6f},{},{:.3f}", packed->phi, packed->spheres, packed->coordination);
      add_marker(plot, Marker::disc, row, packed->phi);
    }
    csv += "\n";
    ++row;
  }
  return {{"table2.svg", svg_document(730, 500, "Mixtures of two lognormal populations, equal volumes",
                                      axes + std::move(plot).finish())},
          {"table2.csv", csv}};
}

}  // namespace bernal::figures
