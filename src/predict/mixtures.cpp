#include "bernal/predict/mixtures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "bernal/core/error.hpp"
#include "predict/chord_table.hpp"

namespace bernal {
namespace {

/// With a given volume-weighted mean, which is e^(sigma²/2) times the median by volume.
std::unique_ptr<SizeDistribution> make_population(double mean, double sigma) {
  if (sigma < 1e-9) return make_constant(mean);
  return make_lognormal(mean * std::exp(-0.5 * sigma * sigma), sigma, Basis::volume, 0,
                        std::numeric_limits<double>::infinity());
}

void require_in_range(const TwoPopulations& p) {
  const auto refuse = [](const char* what, double value) {
    throw Error(ErrorCode::bad_argument, what + (", not " + std::to_string(value)));
  };
  if (!(p.sigma_a >= 0 && std::isfinite(p.sigma_a))) refuse("a width must be at least 0", p.sigma_a);
  if (!(p.sigma_b >= 0 && std::isfinite(p.sigma_b))) refuse("a width must be at least 0", p.sigma_b);
  if (!(p.ratio > 0 && std::isfinite(p.ratio))) refuse("a ratio of sizes must be positive", p.ratio);
  if (!(p.share >= 0 && p.share <= 1)) refuse("a share of the volume must lie from 0 to 1", p.share);
}

}  // namespace

std::unique_ptr<SizeDistribution> make_two_populations(const TwoPopulations& p) {
  require_in_range(p);
  if (p.share == 0) return make_population(1, p.sigma_a);
  if (p.share == 1 || (p.ratio == 1 && p.sigma_a == p.sigma_b)) return make_population(p.ratio, p.sigma_b);
  std::vector<std::unique_ptr<SizeDistribution>> of;
  of.push_back(make_population(1, p.sigma_a));
  of.push_back(make_population(p.ratio, p.sigma_b));
  return make_mixture(std::move(of), {1 - p.share, p.share}, Basis::volume);
}

std::vector<Prediction> predict_shares(const TwoPopulations& populations, std::span<const double> shares,
                                       int rods) {
  predict::require_enough(rods);
  TwoPopulations p = populations;
  p.share = 0.5;
  const std::unique_ptr<SizeDistribution> both = make_two_populations(p);
  p.share = 0;
  const std::unique_ptr<SizeDistribution> a = make_two_populations(p);
  p.share = 1;
  const std::unique_ptr<SizeDistribution> b = make_two_populations(p);

  // If one population has nearly all the volume, the other's chords are fewer by about the ratio of sizes.
  const double finer = 64 * std::max(p.ratio, 1 / p.ratio);
  const int most = static_cast<int>(std::min(1e9, finer * rods));
  const predict::ChordTable pieces(*both, most);
  const predict::ChordTable of_a(*a, pieces), of_b(*b, pieces);
  std::vector<Prediction> predictions;
  for (const double share : shares) {
    p.share = share;
    require_in_range(p);
    const double number_a = (1 - share) / a->moment(3), number_b = share / b->moment(3);
    const double second = number_a * a->moment(2) + number_b * b->moment(2);
    predictions.push_back(predict::predict_from_chords(
        predict::ChordTable::mixture(of_a, number_a, of_b, number_b), 1 / (1.5 * second), rods));
  }
  return predictions;
}

}  // namespace bernal
