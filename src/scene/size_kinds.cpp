#include "scene/size_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bernal {

std::vector<Percentile> given_percentiles(const Percentiles& of, double factor) {
  std::vector<Percentile> given;
  for (const NamedPercentile& each : named_percentiles)
    if (const auto& size = of.*each.member) given.push_back({each.share, factor * *size});
  return given;
}

SieveCurve curve_of(const Sieve& sieve) {
  std::vector<std::pair<double, double>> points;
  const std::vector<double>& amounts = sieve.passing.empty() ? sieve.retained : sieve.passing;
  for (std::size_t i = 0; i < amounts.size(); ++i)  // one retained amount more than sizes is in the pan
    points.emplace_back(i < sieve.sizes.size() ? sieve.sizes[i] : 0.0, amounts[i]);
  std::ranges::sort(points);
  if (sieve.passing.empty()) {  // what a sieve retains lies between it and the next
    double below = 0;
    for (auto& [size, amount] : points) below += std::exchange(amount, below);
  }
  SieveCurve curve;
  for (const auto& [size, below] : points) {
    curve.openings.push_back(size);
    curve.passing.push_back(below);
  }
  if (curve.openings.front() > 0 || points.size() < 2) return curve;
  constexpr double half_of_finest = 0.5;
  curve.in_pan = (curve.passing[1] - curve.passing[0]) / curve.passing.back();
  curve.pan = sieve.pan.value_or(half_of_finest * curve.openings[1]);
  curve.openings.front() = curve.pan;
  return curve;
}

std::optional<std::size_t> class_of(const Classes& of, double size) {
  constexpr double same = 1e-12;
  for (std::size_t k = 0; k < of.values.size(); ++k)
    if (std::abs(of.values[k] / size - 1) <= same) return k;
  return {};
}

std::vector<double> shares_of_one_density(const Classes& of) {
  std::vector<double> shares = of.shares;
  if (of.basis == Basis::mass)
    for (std::size_t i = 0; i < std::min(shares.size(), of.material_densities.size()); ++i)
      shares[i] /= of.material_densities[i];
  return shares;
}

std::optional<double> mean_density(const Classes& of) {
  const std::vector<double> shares = shares_of_one_density(of);
  const std::size_t n = of.material_densities.size();
  if (n == 0 || of.values.size() != n || shares.size() != n) return {};
  double volume = 0, mass = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double cube = of.basis == Basis::number ? std::pow(of.values[i] / of.values[0], 3) : 1;
    volume += shares[i] * cube;
    mass += shares[i] * cube * of.material_densities[i];
  }
  return volume > 0 && mass > 0 ? std::optional(mass / volume) : std::nullopt;
}

}  // namespace bernal
