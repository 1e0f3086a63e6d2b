#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "bernal/figures/check_prediction.hpp"
#include "bernal/figures/figures.hpp"
#include "bernal/predict/mixtures.hpp"

namespace bernal::figures {

/// A row of table 2 of Farr, Powder Technology 245, 28 (2013): event-driven packings by the algorithm of
/// Kansal, Torquato and Stillinger (KTS), three of each, and the rod model as printed there.
struct PublishedMixture {
  int spheres;
  TwoPopulations mix;
  double kts, kts_error, rods;

  bool is_one_population() const { return mix.share == 0; }
  bool is_equal() const { return is_one_population() && mix.sigma_a == 0; }
};

/// "equal", "σ 0.3", "σ 0.3 | 0": the widths of its populations.
std::string described(const PublishedMixture&);

inline constexpr PublishedMixture published_mixtures[] = {
    {1024, {0, 0, 1, 0}, 0.6426, 0.0005, 0.643},     {2048, {0.3, 0, 1, 0}, 0.6671, 0.0006, 0.671},
    {2048, {0, 0, 2, 0.5}, 0.6736, 0.0007, 0.676},   {2048, {0.3, 0, 2, 0.5}, 0.6939, 0.0011, 0.702},
    {2048, {0, 0.3, 2, 0.5}, 0.6724, 0.0005, 0.674}, {2048, {0.3, 0.3, 2, 0.5}, 0.6931, 0.0002, 0.699}};

/// Packs; nothing where the monitor stops it. `done` of the figure is behind it. Throws Error{bad_argument}
/// where the packing is loose or not certified.
std::optional<PredictionCheck> packed_for_a_figure(const Scene& scene, std::string_view figure, double done,
                                                   const FigureOptions& options);
/// The same of 10,000 spheres of these sizes.
std::optional<PredictionCheck> packed_for_a_figure(const TwoPopulations& sizes, std::string_view figure,
                                                   double done, const FigureOptions& options);

}  // namespace bernal::figures
