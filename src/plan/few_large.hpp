#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// Where a periodic box holds too few of its largest spheres for these to be packed at random: fewer than
/// thirty of those that carry the volume, or less than three of their diameters across. They meet their own
/// images then, and jam as a lattice does, before the others fill what they leave: 1,000 spheres 1 : 5, a
/// fifth of the volume small, of which 31 are large in a box 3.0 across, still pack as 10,000 do; 3,000 of
/// 1 : 10, a quarter small, 9 of them large and 2.1 across, end 0.09 below 10,000, of which 30 are large.
struct FewLarge {
  double carriers;  ///< that hold half of the volume, and all of their size: on average, maybe less than 1
  double across;    ///< shortest edge, in diameters of the largest, see `VolumeCarriers::radius`
  double factor;    ///< so many times as many spheres, in a box so much larger, would not be too few
};
/// Of `count` spheres in a box of these edges; nothing where there are enough, where all are of one size and
/// more than a box is narrow for, and in other than two and three dimensions.
std::optional<FewLarge> few_large(const SizeDistribution& radii, double count, const Vector<dynamic>& edges);

/// "half of the volume is in 8 spheres and the box is 2.1 of the largest diameters across"
std::string in_words(const FewLarge&);
/// "11,000 spheres would be enough", or how wide a box of given size that has `edges` would have to be.
std::string remedy_of(const FewLarge&, double count, const Scene& scene, const Vector<dynamic>& edges);

/// Whether as many spheres are to be placed as are expected or fit, and walls are so near everywhere that how
/// many that are is a guess.
bool is_guess(const Plan& plan);
/// Whether the stages end with a search for an arrangement of few spheres, see `place_few`: relaxation in a
/// container last, and in the plane what settles last, but no bed, whose spheres are to rest.
bool packs_few(const Scene& scene);
/// Whether one more is tried after the other then, as they are few.
bool is_tried(const Plan& plan);
/// Whether such a search finds the largest spheres of a count: not where sizes have no end, or gaps around
/// them that do not grow with them.
bool is_searched_once(const Plan& plan);
/// What a search is expected to take: where more are asked for than are likely to fit, and where one
/// more is tried. Nothing where there are too many.
std::optional<PlanItem> search_for_few(const Plan& plan);
/// Of a guess, where as many as are expected are wanted: how many these may be too few or too many, at least
/// one.
std::optional<std::uint64_t> give_or_take(const Plan& plan);

}  // namespace bernal
