#include "bernal/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "predict/chord_table.hpp"
#include "predict/rods.hpp"

namespace bernal {

void predict::require_enough(int rods) {
  if (rods < 2)
    throw Error(ErrorCode::bad_argument, "a prediction needs at least 2 rods, not " + std::to_string(rods));
}

Prediction predict::predict_from_chords(const ChordTable& chords, double mean_chord, int rods,
                                        double gap_factor) {
  throw_if_interrupted();
  const std::vector<double> lengths = chords.rod_lengths(rods);
  Prediction prediction{.phi = predict::covered_fraction(lengths, gap_factor), .rods = rods};
  const double fewer = predict::covered_fraction(chords.rod_lengths(std::max(1, rods / 4)), gap_factor);
  // The deficit of the rods' mean length from the mean chord is volume of spheres so large, and so few, that
  // no rod represents them.
  const double mean = std::accumulate(lengths.begin(), lengths.end(), 0.0) / rods;
  const double missed = std::abs(1 - mean / mean_chord);
  prediction.error = std::max(std::abs(prediction.phi - fewer), missed * (1 - prediction.phi));
  return prediction;
}

Prediction predict_packing_fraction(const SizeDistribution& sizes, int rods, double gap_factor) {
  predict::require_enough(rods);
  if (!(gap_factor >= 0 && std::isfinite(gap_factor)))
    throw Error(ErrorCode::bad_argument,
                "gaps between rods are 0 or more of the shorter rod, not " + std::to_string(gap_factor));
  return predict::predict_from_chords(predict::ChordTable(sizes, rods),
                                      sizes.moment(3) / (1.5 * sizes.moment(2)), rods, gap_factor);
}

double fitted_packing_fraction(double sigma) {
  if (!(sigma >= 0 && sigma <= 3))
    throw Error(ErrorCode::bad_argument,
                "the fit is for lognormal sizes of sigma from 0 to 3, not " + std::to_string(sigma));
  const double wave = 1 - std::exp(-0.75 * std::pow(sigma, 0.7) - 0.025 * std::pow(sigma, 4));
  return 1 - 0.57 * std::exp(-sigma) + 0.2135 * std::exp(-0.57 * sigma / 0.2135) +
         0.0019 * (std::cos(2 * std::numbers::pi * wave) - 1);
}

double relative_viscosity(double solids, double packing_fraction, double intrinsic) {
  if (!(solids >= 0 && solids < packing_fraction && packing_fraction <= 1))
    throw Error(ErrorCode::bad_argument, "the volume fraction of solids must lie from 0 to below " +
                                             std::to_string(packing_fraction) +
                                             ", where the suspension jams, not " + std::to_string(solids));
  if (!(intrinsic > 0 && std::isfinite(intrinsic)))
    throw Error(ErrorCode::bad_argument,
                "the intrinsic viscosity must be positive, not " + std::to_string(intrinsic));
  return std::pow(1 - solids / packing_fraction, -intrinsic * packing_fraction);
}

}  // namespace bernal
