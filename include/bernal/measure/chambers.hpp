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

/// The parts of a container that spheres of radius r cannot leave, and the volume that no such sphere can
/// cover.
///
/// A *place* is a point with clearance at least r, so that a sphere can have its centre there. A *chamber* is
/// a connected component of the places, with all that spheres at them can cover. Two cavities joined by a
/// neck narrower than a sphere are two chambers; wedges, tips and thin parts belong to none. Lengths are in
/// the scene's unit.
struct Chambers {
  struct Chamber {
    Vector<3> position;  ///< a place well inside
    double clearance;    ///< there
    /// Share of the container's volume that spheres of radius `radius` can cover in this chamber.
    /// `share_error` is the sampling error for independent points; the points used do better.
    double share, share_error;
    std::uint64_t spheres;
    double packing_fraction;  ///< volume of its spheres over that share of the container; 0 if the share is 0
  };
  std::vector<Chamber> chambers;  ///< largest share first
  double radius = 0;              ///< r; for a packing, the smallest radius
  double resolution = 0;          ///< edge of the search cells; 0 if none are needed: without a mesh

  /// The share of the container that no sphere of this radius can cover.
  struct Uncovered {
    double radius, share, error;
  };
  Uncovered by_smallest{}, by_mean{};  ///< for `radius` and for the mean radius

  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> of_sphere;  ///< each sphere's chamber, or `none`
  std::uint64_t misplaced = 0;           ///< spheres that protrude from the container and so have no chamber
};

struct ChamberOptions {
  int cells = 128;              ///< at most, along the longest edge; four to a radius are enough
  std::uint32_t points = 8000;  ///< in the container, for the shares
};

/// Absent without walls, in other than three dimensions, and without spheres. A periodic container stands for
/// one period.
///
/// In boxes, cylinders, spheres and convex meshes the places are convex: one chamber or none. In other meshes
/// an octree is refined where the clearance, being 1-Lipschitz, does not decide a cell, and its finest cells
/// are searched for a place; two places are connected if a chain of places joins them.
/// Pockets much thinner than a cell can be missed, and a neck much thinner than a
/// cell can count as closed unless spheres are in it. A neck counts as open from 0.9999 r on, a short and
/// sharp one from 0.99 r. The result is the same for any number of threads. Cost: 0.3 to 0.6 s of one core in
/// a mesh of 10,000 triangles, 1 s in one of 100,000, plus a few µs a sphere; seconds if spheres are nearly
/// as large as a round part of many triangles, which are all equally far from its middle. Precondition:
/// options positive.
std::optional<Chambers> chambers(const Spheres<dynamic>&, const Domain&, const ChamberOptions& = {},
                                 const std::shared_ptr<const Container>& made = {});

/// The same for a given radius, without spheres. Precondition: radius > 0.
Chambers chambers_for(const Domain&, double radius, const ChamberOptions& = {});

}  // namespace bernal
