#pragma once
#include <optional>

#include "bernal/cost/cost.hpp"
#include "cost/rounds.hpp"

namespace bernal::cost {

/// Packing fractions that differ by less are as good as equal to whoever asks for advice; and by so much at
/// most where seeds cannot tell them apart.
constexpr double good_enough = 0.001, most_tolerated = 0.005;

/// Medians over the seeds of a setting. Precondition: there are trials.
CostRow row_of(const Series& series, double wall_deviation, double mean_radius);

/// By how much a setting is denser than another one with the same seed.
struct Difference {
  double mean = 0;                   ///< over the seeds
  std::optional<double> error = {};  ///< of the mean, its standard error; of one seed nothing is known
  double least = 0, most = 0;        ///< of the seeds
};
Difference difference_of(const CostRow& row, const CostRow& to);

/// Whether it is as dense: by all but `good_enough`, or else by all but `most_tolerated` where that is no
/// more than its standard error.
bool is_no_loss(const CostRow& row, const CostRow& to);

bool are_same_spheres(const CostRow& a, const CostRow& b);

}  // namespace bernal::cost
