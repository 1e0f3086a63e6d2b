#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Where a part of a scene stands in the user's file, whole and key by key; empty for what was made in C++.
struct Locations {
  Location whole;
  std::map<std::string, Location, std::less<>> keys;

  /// Of the key if it is written there, else of the whole.
  const Location& of(std::string_view key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? whole : found->second;
  }
};

// The kinds of size distributions as a scene states them: plain data. Lengths are radii or, where
// `Scene::sizes_are_diameters` says so, diameters; those called d… are diameters always. sizes/ says what
// the distributions are.

struct Constant {
  double value = 0;
};

struct Classes {
  std::vector<double> values = {}, shares = {};
  Basis basis = Basis::number;
};

struct Uniform {
  double min = 0, max = 0;
  Basis basis = Basis::number;
};

struct Normal {
  double mean = 0, sd = 0;
  Basis basis = Basis::number;
  std::optional<double> min = {}, max = {};
};

/// By `median` and `sigma`, or by the means d43 and d32.
struct Lognormal {
  std::optional<double> median = {}, sigma = {};
  Basis basis = Basis::number;
  std::optional<double> d43 = {}, d32 = {}, min = {}, max = {};
};

/// A density through points.
struct Tabulated {
  std::vector<double> x = {}, density = {};
  Basis basis = Basis::number;
};

struct Sieve {
  std::vector<double> sizes = {}, passing = {};
};

struct RosinRammler {
  double d63 = 0, n = 0, min = 0;
  std::optional<double> max = {};
};

struct Fuller {
  double max = 0, exponent = 0.5, min = 0;
};

struct SceneSizes;

struct Mixture {
  std::vector<SceneSizes> of;  // without = {}, for which Clang 14 would need the whole type
  std::vector<double> shares = {};
  Basis basis = Basis::number;
};

/// Any of them: `scene.sizes = Lognormal{.median = 1, .sigma = 0.3}`.
struct SceneSizes : std::variant<Constant, Classes, Uniform, Normal, Lognormal, Tabulated, Sieve,
                                 RosinRammler, Fuller, Mixture> {
  using variant::variant;
  Locations locations;
};

}  // namespace bernal
