#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/lower_part.hpp"
#include "bernal/measure/rest.hpp"

namespace bernal {

/// A bed at the bottom of its container: its height, its porosity up to its surface, and whether its spheres
/// rest. Heights are measured from the container's lowest point, against gravity. Lengths are in the spheres'
/// unit; d is the mean diameter. In two dimensions volumes are areas and the surface is a line.
///
/// The surface: the cross-section is divided into square cells of width d/2. The surface in a cell is the
/// highest point of any sphere over it,
///   z(cell) = max over spheres i of  h_i + sqrt(r_i² - a_i²),
/// with h_i the height of the centre and a_i <= r_i its horizontal distance from the cell. Cells without a
/// sphere have no surface. Means are weighted with the share of the cell inside the container.
struct BedProfile {
  Vector<3> direction;  ///< of gravity, a unit vector
  double mean_diameter = 0;

  double height = 0;     ///< mean of the surface
  double highest = 0;    ///< highest point of a sphere
  double roughness = 0;  ///< root mean square of z - height
  double covered = 0;    ///< share of the cross-section with spheres over it

  /// Porosity from the floor up to the surface: 1 - (volume of the spheres) / (volume of the container below
  /// the surface). `porosity_error` is the standard error of the latter volume, which is exact below the mean
  /// height and sampled between there and the surface.
  double porosity = 0, porosity_error = 0;

  /// The height that all but the lowest twentieth of the surface reaches. Absent unless at least
  /// `well_covered` of the cross-section is covered and the container is not full to its brim.
  std::optional<double> level;
  /// As coordinates; absent without a level.
  std::optional<LowerPart> below_level() const;
  double lowest = 0;  ///< the coordinate of height 0 along -direction

  /// The part from `core_depth` mean diameters above the floor to as many below the level (in a full
  /// container: below the lowest twentieth of the surface). Absent if thinner than a mean diameter.
  struct Core {
    double from, to, porosity;
  };
  std::optional<Core> core;
  static constexpr double core_depth = 3, well_covered = 0.95;

  /// Equal layers from the floor to the highest point. The volumes of sphere and container slices are exact
  /// to rounding.
  struct Layer {
    double from, to, packing_fraction;
  };
  std::vector<Layer> layers;

  Rest rest;
};

struct BedOptions {
  std::optional<Vector<3>> direction = {};  ///< of gravity; if absent, against the last axis
  /// The spheres are known to be a bed. Otherwise they count as one if they leave the top of the container
  /// empty, by at least a mean diameter and a fiftieth of its volume, and at most half of them hang.
  bool is_bed = false;
  double friction = 0;           ///< see `RestOptions`
  double gap = 0, wall_gap = 0;  ///< see `measure_rest`
  double layer = 0.1;            ///< approximate thickness in mean diameters; at most `most_layers` layers
  std::size_t most_layers = 1000;
};

/// Absent without spheres, in other than two or three dimensions, without walls, if the domain is periodic
/// along gravity, and if the spheres are no bed.
///
/// The height depends on the width of the cells: for equal spheres, halving it lowers the height by 0.09 d
/// for a level top and by 0.16 d for the rough one that `compress` leaves; doubling it raises the height by
/// 0.06 d and 0.18 d. Cost: that of `measure_rest`, about 0.3 µs a sphere for the surface, O(triangles) a
/// layer in a mesh, and 32,768 wall queries. `made`: as `MeasureOptions::container`. Precondition: spheres of
/// the domain's dimension, inside it; direction not 0.
std::optional<BedProfile> bed_profile(const Spheres<dynamic>&, const Domain&, const BedOptions& = {},
                                      const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
