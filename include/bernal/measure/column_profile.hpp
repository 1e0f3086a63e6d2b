#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/wall_profile.hpp"

namespace bernal {

/// The porosity along the axis of a container and, of a column, from its side alone: floor, lid and side are
/// told apart, which `WallProfile` takes together. Lengths are in the spheres' unit; d is the mean diameter.
///
/// The axis is that of a cylinder or a solid of revolution; the coordinate axis of a box that is nearest to
/// the vertical; else the vertical. Of a slab it is the direction across it. Heights along it are measured
/// from the container's lowest point.
struct ColumnProfile {
  Vector<3> axis;  ///< of unit length, upwards
  double mean_diameter = 0;
  double bottom = 0;     ///< 0, or where a slab begins
  double top = 0;        ///< height of the lid, of a bed's level, or where a slab ends
  bool has_lid = false;  ///< false: the spheres are a bed that ends at `top`, or go on above the slab

  /// Slices from the bottom to the top, d/10 thick; that at a lid is thinner, that at a level reaches above
  /// it. Those of a slab are equal, of d/10 or a little less. The volumes of spheres and container in a slice
  /// are exact to rounding.
  struct Layer {
    double from, to, porosity;
  };
  std::vector<Layer> along;

  /// Of flat ends that are not outside a slab, in boxes and cylinders: z is the distance from the floor, or
  /// from the lid.
  std::optional<WallProfile::Minimum> floor_minimum, lid_minimum;

  /// What lies between two heights, as a function of the distance from the side walls: the slab, or all but
  /// the ends, `end_depth` d at each, or a quarter of the height if that is less.
  struct Side {
    double from, to;
    WallProfile profile;
  };
  std::optional<Side> side;  ///< of boxes with walls along the axis, and of cylinders
  static constexpr double end_depth = 3;
};

struct ColumnOptions {
  std::optional<Vector<3>> down = {};  ///< the direction of gravity; if absent, against the last axis
  std::optional<double> level = {};    ///< of a bed, as a height above the container's lowest point
  std::optional<LowerPart> slab = {};  ///< the part of the column that counts, whatever its level
  double layer = 0.1;                  ///< thickness of slices in mean diameters, if that makes at most
  std::size_t most_layers = 10'000;    ///< so many
  WallOptions side = {};               ///< its `below` is ignored
};

/// Absent without walls, in other than three dimensions, without spheres, in containers that repeat
/// themselves along their axis, and where a slab has nothing of the container. Cost: O(N), O(triangles) a
/// slice in a mesh, and that of `wall_profile` for the side. Precondition: options positive; down not 0.
std::optional<ColumnProfile> column_profile(const Spheres<dynamic>&, const Domain&,
                                            const ColumnOptions& = {});

}  // namespace bernal
