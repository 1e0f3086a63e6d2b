#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "bernal/sizes/percentiles.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal::testing {

/// A distribution, and the law that its user stated: the fraction of the basis at or below a radius.
struct SizeCase {
  std::string name;
  std::function<std::unique_ptr<SizeDistribution>()> make;
  Basis basis;
  std::function<double(double)> stated;

  friend void PrintTo(const SizeCase& tested, std::ostream* out) { *out << tested.name; }
};

using Law = std::function<double(double)>;

/// The share of law g that lies below r after a cut to [min, max].
inline Law cut(Law g, double min, double max) {
  return [=](double r) { return (g(std::clamp(r, min, max)) - g(min)) / (g(max) - g(min)); };
}

inline Law at(double r) {
  return [r](double x) { return x < r ? 0.0 : 1.0; };
}
inline Law between(double a, double b) {
  return cut([](double r) { return r; }, a, b);
}

inline double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
inline Law normal_law(double mean, double deviation) {
  return [=](double r) { return normal_below((r - mean) / deviation); };
}
inline Law lognormal_law(double median, double sigma) {
  return [=](double r) { return r > 0 ? normal_below(std::log(r / median) / sigma) : 0; };
}
inline Law weibull_law(double r63, double n) {
  return [=](double r) { return -std::expm1(-std::pow(r / r63, n)); };
}
inline Law power_law(double q) {
  return [=](double r) { return std::pow(r, q); };
}
inline Law shared(double share, Law a, Law b) {
  return [=](double r) { return share * a(r) + (1 - share) * b(r); };
}

/// The natural spline through (1, 1), (2, 0), (3, 0), (4, 1) is t³/5 - 6t/5 + 1 at 1 + t, that mirrored at
/// 4 - t, and below zero between 2 and 3.
inline double valley_law(double r) {
  const auto up_to = [](double t) { return t * (1 + t * (-0.6 + t * t * 0.05)) / 0.9; };
  const double t = std::clamp(r, 1.0, 4.0) - 1;
  return t < 1 ? up_to(t) : t < 2 ? 0.5 : 1 - up_to(3 - t);
}

/// The one through 0, 0, 1, 0, 0 at 1 … 5 has curvatures 18/7, -30/7, 18/7; it is below zero on the outer
/// intervals.
inline double hill_law(double r) {
  const auto up_to = [](double t) {
    constexpr double a = 18.0 / 7, b = -30.0 / 7;
    return a / 24 * (1 - std::pow(1 - t, 4)) + b / 24 * std::pow(t, 4) - a / 6 * (t - t * t / 2) +
           (1 - b / 6) * t * t / 2;
  };
  const double t = std::clamp(r, 2.0, 4.0) - 2;
  return t < 1 ? up_to(t) / (2 * up_to(1)) : 1 - up_to(2 - t) / (2 * up_to(1));
}

inline double sieve_law(double r) {
  const double octave = std::log2(std::clamp(r, 1.0, 8.0));
  return octave < 1 ? 0.3 * octave : octave < 2 ? 0.3 : 0.3 + 0.7 * (octave - 2);
}

/// Bins from 1 to 2 and from 3 to 5 with 1 : 3 of the whole, and an empty one between them.
inline double histogram_law(double r) {
  const double x = std::clamp(r, 1.0, 5.0);
  return x < 2 ? 0.25 * (x - 1) : x < 3 ? 0.25 : 0.25 + 0.375 * (x - 3);
}

/// Through 10 % at 1, 40 % at 2 and 90 % at 4: 0.3 an octave up to 2, and 0.5 from there on.
inline double through_law(double r) {
  const double octave = std::log2(r);
  return std::clamp(octave < 1 ? 0.1 + 0.3 * octave : 0.4 + 0.5 * (octave - 1), 0.0, 1.0);
}

/// The percentiles 10, 50 and 90 of a law that has the quantile q.
template <class Quantile>
std::vector<Percentile> percentiles_of(Quantile q) {
  return {{0.1, q(0.1)}, {0.5, q(0.5)}, {0.9, q(0.9)}};
}
/// Of the standard normal distribution, at these three.
inline double standard_quantile(double p) {
  constexpr double at_nine_tenths = 1.2815515655446004;
  return p < 0.5 ? -at_nine_tenths : p > 0.5 ? at_nine_tenths : 0;
}

inline std::unique_ptr<SizeDistribution> mixture_of(std::unique_ptr<SizeDistribution> a,
                                                    std::unique_ptr<SizeDistribution> b, double share_of_a,
                                                    Basis basis) {
  std::vector<std::unique_ptr<SizeDistribution>> parts;
  parts.push_back(std::move(a));
  parts.push_back(std::move(b));
  return make_mixture(std::move(parts), {share_of_a, 1 - share_of_a}, basis);
}

/// Every distribution, in its ordinary shapes and in its awkward ones.
inline std::vector<SizeCase> size_cases() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr Basis number = Basis::number, volume = Basis::volume;
  const Law thirds = [](double r) { return r < 1 ? 0 : r < 2 ? 0.2 : r < 4 ? 0.7 : 1; };
  using Radii = std::vector<double>;
  return {
      {"constant", [] { return make_constant(0.0309); }, number, at(0.0309)},
      {"classes_number",
       [] {
         return make_classes(Radii{4, 1, 2}, {3, 2, 5}, number);
       },
       number, thirds},
      {"classes_volume",
       [] {
         return make_classes(Radii{4, 1, 2}, {3, 2, 5}, volume);
       },
       volume, thirds},
      {"one_class", [] { return make_classes({7}, {0.1}, volume); }, volume, at(7)},

      {"uniform_number", [] { return make_uniform(1, 2, number); }, number, between(1, 2)},
      {"uniform_volume", [] { return make_uniform(1, 2, volume); }, volume, between(1, 2)},
      {"uniform_narrow", [] { return make_uniform(1, 1 + 1e-9, volume); }, volume, between(1, 1 + 1e-9)},
      {"uniform_wide", [] { return make_uniform(1, 20, volume); }, volume, between(1, 20)},
      {"uniform_equal", [] { return make_uniform(3, 3, volume); }, volume, at(3)},

      {"normal_number", [] { return make_normal(7, 1, number, 0, infinity); }, number, normal_law(7, 1)},
      {"normal_volume", [] { return make_normal(7, 1, volume, 0, infinity); }, volume, normal_law(7, 1)},
      {"normal_narrow", [] { return make_normal(3, 1e-4, volume, 1, 9); }, volume, normal_law(3, 1e-4)},
      {"normal_cut", [] { return make_normal(1, 0.5, number, 0.2, 1.7); }, number,
       cut(normal_law(1, 0.5), 0.2, 1.7)},
      {"normal_tail", [] { return make_normal(2, 1, volume, 6, 9); }, volume,
       cut([](double r) { return -normal_below(2 - r); }, 6, 9)},

      {"lognormal_number", [] { return make_lognormal(2, 0.3, number, 0, infinity); }, number,
       lognormal_law(2, 0.3)},
      {"lognormal_volume", [] { return make_lognormal(2, 0.3, volume, 0, infinity); }, volume,
       lognormal_law(2, 0.3)},
      {"lognormal_cut", [] { return make_lognormal(1, 0.5, number, 0.5, 1.5); }, number,
       cut(lognormal_law(1, 0.5), 0.5, 1.5)},
      {"lognormal_cut_volume", [] { return make_lognormal(1, 0.5, volume, 0.5, 1.5); }, volume,
       cut(lognormal_law(1, 0.5), 0.5, 1.5)},

      {"lognormal_of_mean", [] { return make_lognormal_of_mean(3, 0.8, number, 0, infinity); }, number,
       lognormal_law(3 / std::sqrt(1 + 0.64 / 9), std::sqrt(std::log(1 + 0.64 / 9)))},

      {"percentiles_lognormal",
       [] {
         return make_from_percentiles(
             percentiles_of([](double p) { return 2 * std::exp(0.3 * standard_quantile(p)); }),
             PercentileLaw::lognormal, volume, 0, infinity);
       },
       volume, lognormal_law(2, 0.3)},
      {"percentiles_normal",
       [] {
         return make_from_percentiles(percentiles_of([](double p) { return 7 + standard_quantile(p); }),
                                      PercentileLaw::normal, number, 0, infinity);
       },
       number, normal_law(7, 1)},
      {"percentiles_rosin_rammler",
       [] {
         return make_from_percentiles(
             percentiles_of([](double p) { return 2 * std::pow(-std::log(1 - p), 1.0 / 3); }),
             PercentileLaw::rosin_rammler, volume, 0.5, 4);
       },
       volume, cut(weibull_law(2, 3), 0.5, 4)},
      {"percentiles_rosin_rammler_by_number",
       [] {
         return make_from_percentiles(
             percentiles_of([](double p) { return 2 * std::pow(-std::log(1 - p), 1.0 / 3); }),
             PercentileLaw::rosin_rammler, number, 0.5, 4);
       },
       number, cut(weibull_law(2, 3), 0.5, 4)},
      {"percentiles_through",
       [] {
         return make_from_percentiles({{0.1, 1}, {0.4, 2}, {0.9, 4}}, PercentileLaw::through, volume, 0,
                                      infinity);
       },
       volume, through_law},
      {"percentiles_through_by_number",
       [] {
         return make_from_percentiles({{0.1, 1}, {0.4, 2}, {0.9, 4}}, PercentileLaw::through, number, 0,
                                      infinity);
       },
       number, through_law},

      {"histogram_counts",
       [] {
         return make_histogram({1, 2, 3, 5}, {2, 0, 6}, number);
       },
       number, histogram_law},
      {"histogram_masses",
       [] {
         return make_histogram({1, 2, 3, 5}, {2, 0, 6}, Basis::mass);
       },
       volume, histogram_law},

      {"table_line",
       [] {
         return make_table({1, 3}, {2, 6}, number);
       },
       number, cut(power_law(2), 1, 3)},
      {"table_line_volume",
       [] {
         return make_table({1, 3}, {2, 6}, volume);
       },
       volume, cut(power_law(2), 1, 3)},
      {"table_valley",
       [] {
         return make_table({1, 2, 3, 4}, {5, 0, 0, 5}, number);
       },
       number, valley_law},
      {"table_valley_volume",
       [] {
         return make_table({1, 2, 3, 4}, {5, 0, 0, 5}, volume);
       },
       volume, valley_law},
      {"table_hill",
       [] {
         return make_table({1, 2, 3, 4, 5}, {0, 0, 1, 0, 0}, number);
       },
       number, hill_law},

      {"sieve",
       [] {
         return make_sieve({1, 2, 4, 8}, {0, 30, 30, 100});
       },
       volume, sieve_law},

      {"rosin_rammler_flat", [] { return make_rosin_rammler(2, 0.8, 0.3, infinity); }, volume,
       cut(weibull_law(2, 0.8), 0.3, 2 * std::pow(std::log(1000), 1.25))},
      {"rosin_rammler", [] { return make_rosin_rammler(2, 3, 0.5, 4); }, volume,
       cut(weibull_law(2, 3), 0.5, 4)},
      {"rosin_rammler_steep", [] { return make_rosin_rammler(2, 60, 0.5, 4); }, volume,
       cut(weibull_law(2, 60), 0.5, 4)},

      {"fuller", [] { return make_fuller(8, 0.5, 0.5); }, volume, cut(power_law(0.5), 0.5, 8)},
      {"fuller_cubic", [] { return make_fuller(8, 3, 0.5); }, volume, cut(power_law(3), 0.5, 8)},
      {"fuller_like_uniform", [] { return make_fuller(2, 1, 1); }, volume, between(1, 2)},

      {"mixture_apart",
       [] { return mixture_of(make_uniform(5, 6, number), make_uniform(1, 2, number), 0.25, number); },
       number, shared(0.25, between(5, 6), between(1, 2))},
      {"mixture_overlapping",
       [] {
         return mixture_of(make_lognormal(1, 0.3, volume, 0, infinity), make_fuller(3, 0.5, 0.2), 0.6,
                           volume);
       },
       volume, shared(0.6, lognormal_law(1, 0.3), cut(power_law(0.5), 0.2, 3))},
      {"mixture_with_a_jump",
       [] { return mixture_of(make_constant(1.5), make_uniform(1, 2, number), 0.3, number); }, number,
       shared(0.3, at(1.5), between(1, 2))},
      {"mixture_of_constants_volume",
       [] { return mixture_of(make_constant(1), make_constant(3), 0.3, volume); }, volume,
       shared(0.3, at(1), at(3))},
      {"mixture_of_mixtures",
       [] {
         return mixture_of(mixture_of(make_constant(1), make_table({1, 3}, {2, 6}, number), 0.5, number),
                           make_uniform(2, 4, number), 0.4, number);
       },
       number, shared(0.4, shared(0.5, at(1), cut(power_law(2), 1, 3)), between(2, 4))},
  };
}

}  // namespace bernal::testing
