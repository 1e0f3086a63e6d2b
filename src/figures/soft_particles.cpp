#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/text.hpp"
#include "bernal/figures/check_prediction.hpp"
#include "bernal/scene/read_scene.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"
#include "figures/packings.hpp"
#include "figures/page.hpp"
#include "figures/published.hpp"

namespace bernal::figures {
namespace {

constexpr int soft_spheres = 6000;  // as in Farr's figure
constexpr int soft_seeds = 3;
constexpr double widest_soft = 0.7;
constexpr int soft_widths = 7;

struct SoftMean {
  double phi = 0, deviation = 0, rods = 0;
  std::size_t spheres = 0;
};

/// Of one width, whose packings stand in a row.
SoftMean soft_mean_of(const DonePacking* first) {
  SoftMean mean;
  double squares = 0;
  for (int k = 0; k < soft_seeds; ++k) {
    mean.phi += first[k].phi / soft_seeds;
    mean.rods += predicted_for(first[k].packing.spheres.r) / soft_seeds;
    mean.spheres = first[k].packing.spheres.size();
  }
  for (int k = 0; k < soft_seeds; ++k) squares += std::pow(first[k].phi - mean.phi, 2);
  mean.deviation = std::sqrt(squares / (soft_seeds - 1));
  return mean;
}

/// Packings of one width, and what is predicted for it.
struct Width {
  double sigma, rods;
  SoftMean soft, alone;
};

std::string soft_page(const std::vector<Width>& widths, int asked, double seconds) {
  std::vector<std::vector<std::string>> rows;
  std::vector<double> from_rods, from_alone;
  double scatter = 0;
  for (const Width& w : widths) {
    const auto printed = std::ranges::find_if(published_mixtures, [&](const PublishedMixture& row) {
      return row.is_one_population() && std::abs(row.mix.sigma_a - w.sigma) < 1e-9;
    });
    from_rods.push_back(w.soft.phi - w.soft.rods);
    from_alone.push_back(w.alone.phi - w.soft.phi);
    scatter = std::max(scatter, w.soft.deviation);
    rows.push_back(
        {fmt::format("{:.1f}", w.sigma), fmt::format("{:.4f}", w.rods), fmt::format("{:.4f}", w.soft.rods),
         fmt::format("{:.4f} ± {:.4f}", w.soft.phi, w.soft.deviation),
         fmt::format("{:+.4f}", from_rods.back()),
         fmt::format("{:.4f} ± {:.4f}", w.alone.phi, w.alone.deviation),
         printed == std::end(published_mixtures) ? ""
                                                 : fmt::format("{} ± {}", printed->kts, printed->kts_error)});
  }
  const auto [least, most] = std::ranges::minmax(from_rods);
  const auto [least_denser, most_denser] = std::ranges::minmax(from_alone);
  return fmt::format(
      R"(# Farr's figure 2 with soft particles of today

R. S. Farr: *Random close packing fractions of lognormal distributions of hard spheres*. Powder Technology
245 (2013) 28–34. Written by `bernal reproduce fig2soft{}` in {:.0f} s on: {}.

![figure 2 with soft particles](fig2soft.svg)

{} lognormal spheres in a periodic box, {} seeds, ± the deviation of one packing: LAMMPS pushes soft
particles apart while their box grows, and `relax` takes the rest of their overlap from them (`[engine]`);
beside them `relax` alone, from the same sizes. All are certified. The first column of rods is the
curve, from 16,000 rods; the second is the model's answer to the very diameters that were packed.

{}
The soft particles of the paper are drawn and not printed, so theirs and these cannot be put side by side
in numbers. What the text says of them is this: they agree with the rod model excellently, and lie slightly
above the KTS packings. What agrees is how much denser wider sizes pack. What does not is where the curve
lies: from the rod model of their sizes these are {:+.4f} to {:+.4f} away, and a packing scatters by up to
{:.4f}. How dense soft particles come to rest is a matter of how slowly they do: here in a thousand steps,
and more are denser. `relax` alone ends {:+.4f} to {:+.4f} from them.
)",
      asked == 0 ? "" : fmt::format(" --spheres {}", asked), seconds, processor_name(),
      grouped(widths.front().soft.spheres), soft_seeds,
      markdown_table({"sigma", "rods", "rods of these", "LAMMPS, then relax", "from rods", "relax alone",
                      "KTS, printed"},
                     rows),
      least, most, scatter, least_denser, most_denser);
}

}  // namespace

/// Farr's figure 2 once more, with a soft particle method of today: LAMMPS pushes the spheres apart while
/// their box grows, see src/engine/engine_task.hpp, and relax takes the rest of their overlap from them.
Files soft_particles(const FigureOptions& options) {
  constexpr int rods = 16000;
  const Stopwatch watch;
  const std::vector<double> sigmas = spread(0, widest_soft, 70), packed = spread(0, widest_soft, soft_widths);
  const auto sizes = [&](std::size_t i) { return make_two_populations({.sigma_a = sigmas[i], .share = 0}); };
  const std::vector<Prediction> predictions =
      predict_all(sigmas.size(), sizes, rods, "fig2soft", options.monitor);
  if (predictions.empty()) return {};
  const int spheres = options.spheres == 0 ? soft_spheres : options.spheres;
  std::vector<PackingTask> tasks;
  for (const bool by_engine : {true, false})
    for (const double sigma : packed)
      for (int seed = 0; seed < soft_seeds; ++seed) {
        CheckOptions check;
        check.spheres = spheres;
        check.seed = options.seed + static_cast<std::uint64_t>(seed);
        PackingTask task{.scene = scene_to_check(sizes_of({.sigma_a = sigma, .share = 0}), true, check),
                         .cost = (by_engine ? 4.0 : 1.0) * (1 + sigma)};
        if (by_engine) {
          task.scene.engine = Lammps{};
          task.scene.stages = {Relax{}};  // begins where the engine ends
          complete(task.scene);
        }
        tasks.push_back(std::move(task));
      }
  const std::optional<std::vector<DonePacking>> done = pack_all(tasks, "fig2soft", options);
  if (!done) return {};
  for (const DonePacking& each : *done)
    if (!is_packed(each.packing.outcome))
      throw Error(ErrorCode::bad_argument, "a packing for fig2soft did not jam");

  std::string csv = "source,sigma,phi,deviation,spheres,phi_rods_of_them\n";
  Plot plot({78, 136, 700, 440}, {0, widest_soft, "width σ of ln(diameter)"},
            {0.62, 0.76, "packing fraction φ"});
  plot.axes();
  std::vector<double> phi;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    phi.push_back(predictions[i].phi);
    csv += fmt::format("rods,{:.2f},{:.7f},,,\n", sigmas[i], phi[i]);
  }
  plot.line(sigmas, phi, "line heavy");
  legend_line(plot, 100, 58, "line heavy", "rod model, 16,000 rods");
  legend_marker(plot, Marker::triangle, 340, 58, "KTS, 1,024 and 2,048 spheres (Farr, table 2)");
  legend_marker(plot, Marker::disc, 340, 80,
                fmt::format("soft particles by LAMMPS, then relax: {} spheres",
                            grouped(static_cast<std::uint64_t>(spheres))));
  legend_marker(plot, Marker::ring, 340, 102, "relax alone, the same spheres");
  for (const PublishedMixture& row : published_mixtures) {
    if (!row.is_one_population()) continue;
    csv += fmt::format("KTS,{:.2f},{},{},{},\n", row.mix.sigma_a, row.kts, row.kts_error, row.spheres);
    add_error_bar(plot, row.mix.sigma_a, row.kts, row.kts_error);
    add_marker(plot, Marker::triangle, row.mix.sigma_a, row.kts);
  }
  std::vector<Width> widths;
  for (std::size_t k = 0; k < packed.size(); ++k)
    widths.push_back({.sigma = packed[k],
                      .rods = predictions[k * (sigmas.size() - 1) / (packed.size() - 1)].phi,
                      .soft = soft_mean_of(done->data() + k * soft_seeds),
                      .alone = soft_mean_of(done->data() + (packed.size() + k) * soft_seeds)});
  const auto add = [&](std::string_view source, Marker marker, double sigma, const SoftMean& mean) {
    csv += fmt::format("{},{:.2f},{:.6f},{:.6f},{},{:.6f}\n", source, sigma, mean.phi, mean.deviation,
                       mean.spheres, mean.rods);
    add_error_bar(plot, sigma, mean.phi, mean.deviation);
    add_marker(plot, marker, sigma, mean.phi);
  };
  for (const Width& width : widths) add("soft", Marker::disc, width.sigma, width.soft);
  for (const Width& width : widths) add("relax", Marker::ring, width.sigma, width.alone);
  return {{"fig2soft.md", soft_page(widths, options.spheres, watch.seconds())},
          {"fig2soft.svg", svg_document(730, 500, "Lognormal spheres, as soft particles and by the rod model",
                                        std::move(plot).finish())},
          {"fig2soft.csv", csv}};
}

}  // namespace bernal::figures
