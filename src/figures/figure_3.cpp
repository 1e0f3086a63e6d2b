#include "bernal/core/error.hpp"
#include "bernal/hard/grow.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/packings.hpp"
#include "figures/published.hpp"
#include "io/write_svg.hpp"

namespace bernal::figures {

/// Farr's figure 3: packings of the six mixtures of table 2, in its order, grown as there.
Files figure_3(const FigureOptions& options) {
  std::vector<PackingTask> tasks;
  for (const PublishedMixture& row : published_mixtures) {
    CheckOptions check;
    check.spheres = row.spheres;
    check.seed = options.seed;
    check.stage = Grow{.delta = 0.1, .phi_init = row.is_equal() ? 0.2 : 0.15};
    tasks.push_back({.scene = scene_to_check(sizes_of(row.mix), true, check)});
  }
  const std::optional<std::vector<DonePacking>> done = pack_all(tasks, "figure 3", options);
  if (!done) return {};

  std::string csv = "row,ratio,sigma_a,sigma_b,share_b,spheres,phi,coordination,seconds,phi_kts,error_kts\n",
              body;
  for (std::size_t k = 0; k < done->size(); ++k) {
    const PublishedMixture& row = published_mixtures[k];
    const DonePacking& each = (*done)[k];
    if (!is_packed(each.packing.outcome))
      throw Error(ErrorCode::bad_argument, "a packing for figure 3 did not jam");
    csv += fmt::format("{},{},{},{},{},{},{:.6f},{:.3f},{:.2f},{},{}\n", k + 1, row.mix.ratio,
                       row.mix.sigma_a, row.mix.sigma_b, row.mix.share, each.packing.spheres.size(), each.phi,
                       each.coordination[usual_gap], each.seconds, row.kts, row.kts_error);
    const double left = 14 + 326.0 * static_cast<double>(k % 3),
                 top = 76 + 376.0 * static_cast<double>(k / 3);
    body += fmt::format(
                "<text class=\"label\" x=\"{0:.0f}\" y=\"{1:.0f}\" text-anchor=\"middle\">{2}: φ {3:.4f}, "
                "printed {4:.4f}</text>\n",
                left + 155, top - 14, described(row), each.phi, row.kts) +
            nested_svg(svg_of(each.packing.spheres, each.packing.domain, ""), left, top, 310, 326);
  }
  return {{"fig3.svg",
           svg_document(994, 830, "Packings by growth, delta = 0.1: the mixtures of Farr's table 2", body)},
          {"fig3.csv", csv}};
}

}  // namespace bernal::figures
