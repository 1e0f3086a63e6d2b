#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// Where a sphere is in a container, by the gap g between its surface and the wall; d is the mean diameter.
/// The gap and not the centre's clearance, so that large and small spheres that touch the wall count alike.
enum class Region : std::uint8_t {
  near_wall,  ///< g < d: those that touch, and the layer behind them
  between,
  core,  ///< the centre in the core of the wall profile
};

/// How a packing changes with the distance z from the wall, wherever that is nearest: floor, lid and sides,
/// as far as there are such. Where the container repeats itself it is that of one period. Lengths are in the
/// spheres' unit.
///
/// The container is cut into layers of equal z; its porosity there is what no sphere fills,
///   porosity = 1 - (volume of the spheres in the layer) / (volume of the layer).
/// Every sphere's volume is spread over the layers that it meets, and the volumes of the layers add up to the
/// container's; so the mean of the porosities, weighted with `share`, is that of the packing, to rounding.
struct WallProfile {
  /// The mean of r³ of some spheres over that of all: below 1 where small ones gather there. The error is the
  /// standard error for spheres that were put there by chance.
  struct Segregation {
    std::uint64_t spheres;
    double volume_ratio, error;
  };

  struct Layer {
    /// z; the last layer holds all that is deeper, a hundredth of the container or more; in a mesh that is
    /// deeper than was looked at it ends at infinity.
    double from, to;
    double share;  ///< of the container's volume; all add up to 1
    double porosity;
    double error;  ///< its standard error from sampling, as if points were independent; they do better
    /// Of the spheres whose surface, not whose centre, is so far from the wall; absent where there are none.
    /// So those that touch the wall are all in the first layer.
    std::optional<Segregation> segregation = {};
  };
  std::vector<Layer> layers;
  double mean_diameter = 0;

  double mean_porosity = 0;
  double near_wall_packing_fraction = 0;  ///< of z < mean_diameter, and of the whole where all is nearer
  double core_packing_fraction = 0;       ///< of z > core_from
  double core_packing_error = 0;
  double core_from = 0;   ///< `core_depth` mean diameters, or half the greatest depth
  bool has_core = false;  ///< false: the container is too narrow for that, and the deeper half stands for it
  /// A core begins so deep, and is at least one mean diameter thick.
  static constexpr double core_depth = 3;

  /// The least porosity within a mean diameter of the wall, from a parabola through three layers: for
  /// equal spheres half a diameter from it, where the first layer is cut in the middle.
  struct Minimum {
    double z, porosity;
  };
  std::optional<Minimum> first_minimum;

  std::optional<Segregation> segregation;  ///< of the spheres near the wall; absent where there are none

  std::vector<Region> regions;  ///< of each sphere
};

struct WallOptions {
  double layer = 0.1;  ///< thickness in mean diameters
  double reach = 5;    ///< mean diameters, at least 4: what is deeper is one layer
  /// About how many distances from a mesh are computed; from other walls, which answer more quickly, four
  /// times as many.
  double work = 1e6;
  /// Only what is below a level counts, of container and spheres, also in the means; the regions and sizes
  /// are those of all spheres. The level is no wall.
  std::optional<LowerPart> below = {};
};

/// Absent without walls, in other dimensions than three, and without spheres.
///
/// Layers of boxes, cylinders and spheres have their volumes in closed form; those of a mesh come from points
/// that fill it evenly. Spheres nearer than `reach` are spread over the layers by 8 to 512 points each, a
/// quarter where they are deeper than two mean diameters; spheres beyond go whole. What sticks out of the
/// container counts to the first layer. The same bits for any number of threads. Cost of 30,000 spheres: 0.4
/// s in a cylinder, 2 s in a mesh of 10,000 triangles. Precondition: options positive.
std::optional<WallProfile> wall_profile(const Spheres<dynamic>&, const Domain&, const WallOptions& = {},
                                        const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
