#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/sizes/percentiles.hpp"
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

struct Normal {
  double mean = 0, sd = 0;
  Basis basis = Basis::number;
  std::optional<double> min = {}, max = {};
};

/// A concentric layer of spheres: the innermost is a ball, the others are shells, in order from the centre
/// out. Of `thickness`, `radius` and `share` at most one is given; of the layers of a sphere at most one has
/// none of them, and takes what the others leave.
struct Layer {
  std::string name = {};                        ///< "kernel", "buffer", "core", "interphase"
  std::string material = {};                    ///< by name; if empty the layer's own
  std::optional<double> material_density = {};  ///< in kg/m³
  /// A length, for which `sd` is 0, or a distribution by number that each sphere draws from, keyed by the
  /// seed and its number.
  std::optional<Normal> thickness = {};
  std::optional<double> radius = {};  ///< where the layer ends, measured from the centre
  std::optional<double> share = {};   ///< of the sphere's volume
  Locations locations = {};
};

/// Materials may differ from class to class: shares by mass are then divided by their densities, in kg/m³.
struct Classes {
  std::vector<double> values = {}, shares = {};
  Basis basis = Basis::number;
  std::vector<double> material_densities = {};  ///< one a class, or none where it does not matter
  std::vector<std::string> names = {};          ///< one a class, or none
  std::vector<std::vector<Layer>> layers = {};  ///< one list a class, which may be empty, or none
};

struct Uniform {
  double min = 0, max = 0;
  Basis basis = Basis::number;
};

/// By `median` and `sigma`, by `mean` and standard deviation `sd` of the size, or by the means d43 and d32.
struct Lognormal {
  std::optional<double> median = {}, sigma = {};
  Basis basis = Basis::number;
  std::optional<double> d43 = {}, d32 = {}, min = {}, max = {}, mean = {}, sd = {};
};

/// A density through points.
struct Tabulated {
  std::vector<double> x = {}, density = {};
  Basis basis = Basis::number;
};

/// What passes each sieve, or what each retains. A size of 0 is the pan, and so is one more retained amount
/// than there are sizes, which then fall; spheres in the pan are at least as large as `pan`.
struct Sieve {
  std::vector<double> sizes = {}, passing = {}, retained = {};
  std::optional<double> pan = {};
};

/// What is in each bin, by number or by mass.
struct Histogram {
  std::vector<double> edges = {}, counts = {}, masses = {};
};

/// Two or more of the usual percentiles: D10 is the diameter that 10 % of the basis lie below.
struct Percentiles {
  std::optional<double> d3 = {}, d5 = {}, d10 = {}, d16 = {}, d20 = {}, d25 = {}, d30 = {}, d50 = {},
                        d60 = {}, d70 = {}, d75 = {}, d80 = {}, d84 = {}, d90 = {}, d95 = {}, d97 = {},
                        d99 = {};
  PercentileLaw law = PercentileLaw::lognormal;
  Basis basis = Basis::volume;
  std::optional<double> min = {}, max = {};
};

/// Sizes one by one: `each` is packed exactly once, in an order that follows from the seed, so that there are
/// as many spheres as values; or they are drawn from, each as often as it is there.
struct ListedSizes {
  enum class Draw { each, resample };

  std::vector<double> values = {};
  Draw draw = Draw::each;
  /// Where it is set a writer names this file in place of the values; what reads a scene leaves it empty.
  std::filesystem::path beside = {};
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
                                 RosinRammler, Fuller, Mixture, Percentiles, Histogram, ListedSizes> {
  using variant::variant;
  Locations locations;
};

/// Sizes that the Laguerre cells of the packing are to have, in place of sizes of the spheres: exactly one of
/// the two distributions. The volumes are their quantiles, one a sphere, scaled so that their sum is the
/// volume of the box.
struct CellSizes {
  std::optional<SceneSizes> volume = {};    ///< by number; in the scene's unit to the power of three
  std::optional<SceneSizes> diameter = {};  ///< of the ball of the same volume
  /// How often at most the spheres are packed again, with sizes that brought their own cells nearer to that.
  int rounds = 3;
  Locations locations = {};

  const SceneSizes& sizes() const { return volume ? *volume : *diameter; }
};

/// The list of which every sphere is packed exactly once; null where the sizes are drawn.
inline const ListedSizes* each_once(const SceneSizes& sizes) {
  const auto* list = std::get_if<ListedSizes>(&sizes);
  return list && list->draw == ListedSizes::Draw::each ? list : nullptr;
}

}  // namespace bernal
