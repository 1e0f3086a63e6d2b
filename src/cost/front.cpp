#include "cost/front.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace bernal::cost {

std::vector<std::size_t> front_of(std::span<const Offer> offers, double step) {
  std::vector<std::size_t> order(offers.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return offers[a].cost < offers[b].cost ||
           (offers[a].cost == offers[b].cost && offers[a].worth > offers[b].worth);
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order)
    if (front.empty() || offers[k].worth > offers[front.back()].worth + step) front.push_back(k);
  return front;
}

double worth_for(std::span<const Offer> offers, double cost) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Offer& offer : offers)
    if (offer.cost <= cost) most = std::max(most, offer.worth);
  return most;
}

}  // namespace bernal::cost
