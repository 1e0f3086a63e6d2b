#include "bernal/predict/predict.hpp"

#include <cmath>
#include <string>

#include "bernal/core/error.hpp"
#include "predict/rods.hpp"

namespace bernal {

Prediction predict_packing_fraction(const SizeDistribution& sizes, int rods) {
  if (rods < 2)
    throw Error(ErrorCode::bad_argument, "a prediction needs at least 2 rods, not " + std::to_string(rods));
  const auto phi = [&](int n) { return predict::covered_fraction(predict::rod_lengths(sizes, n)); };
  Prediction prediction{.phi = phi(rods), .rods = rods};
  prediction.error = std::abs(prediction.phi - phi(rods / 2));
  return prediction;
}

}  // namespace bernal
