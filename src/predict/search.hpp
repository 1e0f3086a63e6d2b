#pragma once
#include <functional>
#include <span>
#include <vector>

namespace bernal::predict {

using Objective = std::function<double(std::span<const double>)>;

/// How far a search goes.
struct Reach {
  double step;  ///< first step in every variable
  double gain;  ///< ends where it gains less than this
  int most_evaluations;
};

/// A place and what the objective is there.
struct Place {
  std::vector<double> x;
  double value;
};

/// Starts that end this near to the best found the same packing fraction.
constexpr double same_end = 1e-5;
/// So many of the best ends are refined with all rods.
constexpr int ends_to_refine = 3;

/// A local maximum of `objective` in the unit cube, from `start`, without derivatives (Nelder & Mead). Ends
/// with the best so far once `stopped` is true. What the objective throws passes through.
Place climb(const Objective& objective, std::vector<double> start, const Reach& reach,
            const std::function<bool()>& stopped);

}  // namespace bernal::predict
