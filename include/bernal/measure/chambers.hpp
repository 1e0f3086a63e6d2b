#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The parts of a container that spheres of radius r cannot leave, and what no such sphere can cover.
///
/// A *place* is a point whose clearance is at least r: there a sphere may have its centre. A *chamber* is a
/// connected component of the places, with all that spheres at its places can cover. Two rooms joined by a
/// neck that is narrower than a sphere are two chambers; wedges, tips and thin parts belong to none. Lengths
/// are in the scene's unit.
struct Chambers {
  struct Chamber {
    Vector<3> position;  ///< a place well inside
    double clearance;    ///< there
    /// Of the container's volume: what spheres of radius `radius` can cover in this chamber. The error is the
    /// standard error from sampling, as if points were independent; they do better.
    double share, share_error;
    std::uint64_t spheres;
    double packing_fraction;  ///< volume of its spheres over that share of the container; 0 where that is 0
  };
  std::vector<Chamber> chambers;  ///< largest share first
  double radius = 0;              ///< r, in a packing the smallest
  double resolution = 0;  ///< edge of the cells of the search; 0 where the answer needs none: without a mesh

  /// The share of the container that no sphere of a radius can cover.
  struct Uncovered {
    double radius, share, error;
  };
  Uncovered by_smallest{}, by_mean{};  ///< of radius `radius`, and of the mean one

  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> of_sphere;  ///< the chamber of each, or `none`
  std::uint64_t misplaced = 0;           ///< spheres that stick out of the container and so have no chamber
};

struct ChamberOptions {
  int cells = 128;              ///< along the longest edge at most; four to a radius are enough
  std::uint32_t points = 8000;  ///< in the container, for the shares
};

/// Absent without walls, in other dimensions than three, and without spheres. A container that repeats itself
/// stands for one period.
///
/// Boxes, cylinders, spheres and convex meshes have convex places: one chamber or none. In another mesh the
/// cells of an octree that clearance, being 1-Lipschitz, does not decide are searched for a place down to the
/// finest; two places belong together where a line of places joins them, see src/measure/free_space.hpp.
/// Pockets of places much thinner than a cell can be missed, and a neck much thinner than a cell taken for
/// closed, unless spheres stand in it; a neck counts as open from 0.9999 r on, a short and sharp one from
/// 0.99 r. The same bits for any number of threads. Cost: 0.3 to 0.6 s of one core in a mesh of 10,000
/// triangles, 1 s in one of 100,000, a few µs a sphere; seconds where spheres are nearly as large as a round
/// part of many triangles, from whose middle they are all equally near. Precondition: options positive.
std::optional<Chambers> chambers(const Spheres<dynamic>&, const Domain&, const ChamberOptions& = {},
                                 const std::shared_ptr<const Container>& made = {});

/// The same for a radius, without spheres. Precondition: radius > 0.
Chambers chambers_for(const Domain&, double radius, const ChamberOptions& = {});

}  // namespace bernal
