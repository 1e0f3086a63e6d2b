#include <algorithm>
#include <limits>

#include "run/catalogue.hpp"

namespace bernal {
namespace {

using Sizes = std::unique_ptr<SizeDistribution>;

Basis basis_of(const Spec& spec) { return spec.text("basis") == "volume" ? Basis::volume : Basis::number; }

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& v : values) v *= factor;
  return values;
}

double min_of(const Spec& s, double half) { return s.has("min") ? half * s.number("min") : 0; }

double max_of(const Spec& s, double half) {
  return s.has("max") ? half * s.number("max") : std::numeric_limits<double>::infinity();
}

/// Points (radius, amount) by ascending radius.
struct Points {
  std::vector<double> radii, amounts;

  Points(const std::vector<double>& sizes, const std::vector<double>& of, double half) {
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i < sizes.size(); ++i) pairs.emplace_back(half * sizes[i], of.at(i));
    std::ranges::sort(pairs);
    for (const auto& [radius, amount] : pairs) {
      radii.push_back(radius);
      amounts.push_back(amount);
    }
  }
};

Sizes constant(const Spec& s, double half) { return make_constant(half * s.number("value")); }

Sizes classes(const Spec& s, double half) {
  return make_classes(scaled(s.numbers("values"), half), s.numbers("shares"), basis_of(s));
}

Sizes uniform(const Spec& s, double half) {
  return make_uniform(half * s.number("min"), half * s.number("max"), basis_of(s));
}

Sizes normal(const Spec& s, double half) {
  return make_normal(half * s.number("mean"), half * s.number("sd"), basis_of(s), min_of(s, half),
                     max_of(s, half));
}

Sizes lognormal(const Spec& s, double half) {
  const double min = min_of(s, half), max = max_of(s, half);
  if (!s.has("d43"))
    return make_lognormal(half * s.number("median"), s.number("sigma"), basis_of(s), min, max);
  return make_lognormal_of_means(0.5 * s.number("d43"), 0.5 * s.number("d32"), min, max);
}

Sizes table(const Spec& s, double half) {
  Points points(s.numbers("x"), s.numbers("density"), half);
  return make_table(std::move(points.radii), std::move(points.amounts), basis_of(s));
}

Sizes sieve(const Spec& s, double half) {
  Points points(s.numbers("sizes"), s.numbers("passing"), half);
  return make_sieve(std::move(points.radii), std::move(points.amounts));
}

Sizes rosin_rammler(const Spec& s, double half) {
  return make_rosin_rammler(0.5 * s.number("d63"), s.number("n"), min_of(s, half), max_of(s, half));
}

Sizes fuller(const Spec& s, double half) {
  return make_fuller(max_of(s, half), s.number("exponent"), min_of(s, half));
}

Sizes mixture(const Spec& s, double half) {
  std::vector<Sizes> parts;
  for (const Spec& part : s.parts) parts.push_back(find_entry(sizes_catalogue(), part).make(part, half));
  return make_mixture(std::move(parts), s.numbers("shares"), basis_of(s));
}

constexpr SizesEntry entries[] = {
    {"constant", constant},   {"classes", classes}, {"uniform", uniform}, {"normal", normal},
    {"lognormal", lognormal}, {"table", table},     {"sieve", sieve},     {"rosin_rammler", rosin_rammler},
    {"fuller", fuller},       {"mixture", mixture}};

}  // namespace

std::span<const SizesEntry> sizes_catalogue() { return entries; }

}  // namespace bernal
