#pragma once
#include <optional>
#include <variant>
#include <vector>

#include "bernal/scene/locations.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

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
  std::vector<SceneSizes> of = {};
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
