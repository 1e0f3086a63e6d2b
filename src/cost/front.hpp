#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace bernal::cost {

/// What something costs and is worth.
struct Offer {
  double cost = 0, worth = 0;
};

/// The offers that are worth more by more than `step` than every one on the front that costs less or as much,
/// in the order of their cost; of those that cost the same the most worth. With a step of 0 it is the Pareto
/// front. Cost: O(n log n).
std::vector<std::size_t> front_of(std::span<const Offer> offers, double step = 0);

/// The most that is offered for that cost or less; minus infinity where nothing is.
double worth_for(std::span<const Offer> offers, double cost);

}  // namespace bernal::cost
