#pragma once
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "bernal/scene/scene.hpp"

namespace bernal::cost {

/// Sizes that methods are compared with.
struct SizeClass {
  std::string_view name;   ///< of files: "equal"
  std::string_view title;  ///< "equal spheres"
  SceneSizes sizes;
  bool wide = false;       ///< so wide that the small fit between the large
  std::int64_t count = 0;  ///< of spheres, where nobody says it
  std::int64_t least = 0;  ///< with fewer, the box between floor and lid is too narrow for the largest

  std::int64_t count_for(std::int64_t asked) const { return asked > 0 ? std::max(asked, least) : count; }
};
SizeClass equal_sizes();
SizeClass lognormal_sizes();  ///< sigma 0.3, by number, cut at three medians
SizeClass one_to_five();      ///< diameters 1 and 5, a fifth of the volume small

/// How much of a box is walls.
enum class Sides {
  none,  ///< it repeats itself along every axis
  lids,  ///< a floor and a lid
  all,   ///< a box like any other
};

/// What fits between floor and lid, in shares of what is predicted without them; a box is that large.
inline constexpr double share_between_lids = 0.94;
/// More than fits there: what grows to that jams before, and the tail is taken out.
inline constexpr double share_that_jams = 0.98;

/// A cube for so many spheres of these sizes, without stages: as large as the packing needs where it has no
/// sides, else as large as they need at that packing fraction.
Scene room_for(const SizeClass& sizes, std::int64_t count, Sides sides, double packing_fraction);

/// What the rod model predicts for those sizes.
double predicted_for(const SizeClass& sizes);

}  // namespace bernal::cost
