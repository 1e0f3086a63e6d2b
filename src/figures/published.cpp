#include "figures/published.hpp"

#include "bernal/core/error.hpp"

namespace bernal::figures {

std::optional<PredictionCheck> packed_for_a_figure(const Scene& scene, std::string_view figure, double done,
                                                   const FigureOptions& options) {
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

std::optional<PredictionCheck> packed_for_a_figure(const TwoPopulations& sizes, std::string_view figure,
                                                   double done, const FigureOptions& options) {
  CheckOptions check;
  check.spheres = 10'000;
  check.seed = options.seed;
  return packed_for_a_figure(scene_to_check(sizes_of(sizes), true, check), figure, done, options);
}

}  // namespace bernal::figures
