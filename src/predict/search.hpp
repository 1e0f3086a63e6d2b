#pragma once
#include <functional>
#include <span>
#include <vector>

namespace bernal::predict {

using Objective = std::function<double(std::span<const double>)>;

/// Limits of a search.
struct SearchLimits {
  double step;  ///< first step in every variable
  double gain;  ///< ends when the gain is below this
  int most_evaluations;
};

/// A point and the objective there.
struct Place {
  std::vector<double> x;
  double value;
};

/// Starts that end this close to the best found the same packing fraction.
constexpr double same_end = 1e-5;
/// The number of best ends refined with all rods.
constexpr int ends_to_refine = 3;

/// A local maximum of `objective` in the unit cube, from `start`, without derivatives (Nelder & Mead). Ends
/// with the best so far once `stopped` is true. Exceptions of the objective pass through.
Place climb(const Objective& objective, std::vector<double> start, const SearchLimits& limits,
            const std::function<bool()>& stopped);

}  // namespace bernal::predict
