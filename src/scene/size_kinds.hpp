#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "bernal/scene/sizes.hpp"

namespace bernal {

/// The percentiles that a scene may give, by their names.
struct NamedPercentile {
  std::string_view name;
  double share;  ///< of the basis that lies below
  std::optional<double> Percentiles::*member;
};
inline constexpr std::array<NamedPercentile, 17> named_percentiles = {{
    {"d3", 0.03, &Percentiles::d3},
    {"d5", 0.05, &Percentiles::d5},
    {"d10", 0.10, &Percentiles::d10},
    {"d16", 0.16, &Percentiles::d16},
    {"d20", 0.20, &Percentiles::d20},
    {"d25", 0.25, &Percentiles::d25},
    {"d30", 0.30, &Percentiles::d30},
    {"d50", 0.50, &Percentiles::d50},
    {"d60", 0.60, &Percentiles::d60},
    {"d70", 0.70, &Percentiles::d70},
    {"d75", 0.75, &Percentiles::d75},
    {"d80", 0.80, &Percentiles::d80},
    {"d84", 0.84, &Percentiles::d84},
    {"d90", 0.90, &Percentiles::d90},
    {"d95", 0.95, &Percentiles::d95},
    {"d97", 0.97, &Percentiles::d97},
    {"d99", 0.99, &Percentiles::d99},
}};

/// Those that are given, ascending with their shares, times `factor`.
std::vector<Percentile> given_percentiles(const Percentiles&, double factor = 1);

/// A sieve analysis as what passes each opening, in the scale of the scene, by ascending opening.
/// Precondition: what the rule of its keys demands.
struct SieveCurve {
  std::vector<double> openings, passing;
  /// The share of the whole that is in the pan, and the opening that was put in place of its 0: `Sieve::pan`,
  /// or half of the finest sieve's.
  double in_pan = 0, pan = 0;
};
SieveCurve curve_of(const Sieve&);

/// Which of the classes has this size, if one has.
std::optional<std::size_t> class_of(const Classes&, double size);

/// Shares by volume, or by number: those by mass are divided by the densities of the materials.
std::vector<double> shares_of_one_density(const Classes&);

/// Of classes with a density each: of all of them together, in kg/m³; none where they have none.
std::optional<double> mean_density(const Classes&);

}  // namespace bernal
