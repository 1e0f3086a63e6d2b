#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// Position of a sphere relative to the wall, by the gap g between its surface and the wall (not by the
/// centre's clearance, so that large and small spheres that touch the wall count alike). d is the mean
/// diameter.
enum class Region : std::uint8_t {
  near_wall,  ///< g < d: spheres that touch, and the layer behind them
  between,
  core,  ///< the centre lies in the core of the wall profile
};

/// The packing as a function of the distance z from the nearest wall: floor, lid or side. A periodic
/// container stands for one period. Lengths are in the spheres' unit.
///
/// The container is divided into layers of equal z with
///   porosity = 1 - (volume of the spheres in the layer) / (volume of the layer).
/// Each sphere's volume is spread over the layers that it meets, and the layers' volumes add up to the
/// container's; so the mean porosity, weighted with `share`, is that of the packing, to rounding.
struct WallProfile {
  /// The mean of r³ of some spheres over that of all: below 1 if small spheres gather there. The error is the
  /// standard error for spheres placed at random.
  struct Segregation {
    std::uint64_t spheres;
    double volume_ratio, error;
  };

  struct Layer {
    /// z. The last layer holds all that is deeper, at least a hundredth of the container; in a mesh deeper
    /// than the search it ends at infinity.
    double from, to;
    double share;  ///< of the container's volume; all add up to 1
    double porosity;
    double error;  ///< sampling error for independent points; the points used do better
    /// Of the spheres whose surface (not centre) is this far from the wall, so that all that touch it are in
    /// the first layer; absent if there are none.
    std::optional<Segregation> segregation = {};
  };
  std::vector<Layer> layers;
  double mean_diameter = 0;

  double mean_porosity = 0;
  double near_wall_packing_fraction = 0;  ///< of z < mean_diameter; of the whole if everything is nearer
  double core_packing_fraction = 0;       ///< of z > core_from
  double core_packing_error = 0;
  double core_from = 0;   ///< `core_depth` mean diameters, or half the greatest depth
  bool has_core = false;  ///< false: the container is too narrow for a core; the deeper half stands for it
  /// Depth at which a core begins, in mean diameters; it is at least one mean diameter thick.
  static constexpr double core_depth = 3;

  /// The least porosity within a mean diameter of the wall, from a parabola through three layers; for equal
  /// spheres half a diameter from the wall, in the middle of the first layer.
  struct Minimum {
    double z, porosity;
  };
  std::optional<Minimum> first_minimum;

  std::optional<Segregation> segregation;  ///< of the spheres near the wall; absent if there are none

  std::vector<Region> regions;  ///< of each sphere
};

struct WallOptions {
  double layer = 0.1;  ///< thickness in mean diameters
  double reach = 5;    ///< mean diameters, at least 4; all that is deeper is one layer
  /// Approximate number of distances from a mesh computed; four times as many from other walls, which are
  /// faster.
  double work = 1e6;
  /// Only container and spheres below this level, or between two, count, also in the means; `regions` and
  /// sizes are those of all spheres. The levels are no walls.
  std::optional<LowerPart> below = {};
};

/// Absent without walls, in other than three dimensions, and without spheres.
///
/// In boxes, cylinders and spheres the volumes of the layers are in closed form; in a mesh they come from
/// points that fill it evenly. Spheres nearer than `reach` are spread over the layers by 8 to 512 points
/// each, a quarter of that beyond two mean diameters; deeper spheres count whole. What protrudes from the
/// container counts in the first layer. The result is the same for any number of threads. Cost for 30,000
/// spheres: 0.4 s in a cylinder, 2 s in a mesh of 10,000 triangles. Precondition: options positive.
std::optional<WallProfile> wall_profile(const Spheres<dynamic>&, const Domain&, const WallOptions& = {},
                                        const std::shared_ptr<const Container>& made = {});

/// Of layers of equal thickness from a wall on: the least porosity within `diameter`, by a parabola through
/// three layers. Absent where it is in the first layer or still falls behind it.
std::optional<WallProfile::Minimum> first_minimum(std::span<const double> porosities, double thickness,
                                                  double diameter);

}  // namespace bernal
