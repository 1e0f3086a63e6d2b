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

/// A bed at the bottom of its container: how high it stands, how porous it is up to its surface, and whether
/// its spheres rest. Heights are those above the lowest point of the container, against gravity; lengths are
/// in the spheres' unit, d is the mean diameter. Of two dimensions volumes are areas, and the surface is a
/// line.
///
/// The surface: the cross-section is divided into square cells, d/2 wide, and over each of them it is as high
/// as the highest point of a sphere there,
///   z(cell) = max over spheres i of  h_i + sqrt(r_i² - a_i²),
/// h_i the height of the centre and a_i <= r_i its horizontal distance from the cell. Cells over which no
/// sphere stands have none. Means are weighted with the share of the cell that is in the container.
struct BedProfile {
  Vector<3> direction;  ///< of gravity, a unit vector
  double mean_diameter = 0;

  double height = 0;     ///< mean of the surface
  double highest = 0;    ///< highest point of a sphere
  double roughness = 0;  ///< root mean square of z - height
  double covered = 0;    ///< share of the cross-section over which spheres stand

  /// Of what is below the surface, floor and top included: 1 - (volume of the spheres) / (volume of the
  /// container below it). `porosity_error` is the standard error of the latter volume: it is exact below the
  /// level of the mean height, and what the surface has more or less is sampled.
  double porosity = 0, porosity_error = 0;

  /// Where at least `well_covered` is covered and the container is not full to its brim: the height that a
  /// twentieth of the surface is below. Up to it there is bed everywhere.
  std::optional<double> level;
  /// As coordinates; nothing where there is no level.
  std::optional<LowerPart> below_level() const;
  double lowest = 0;  ///< the coordinate, along -direction, of height 0

  /// Between `core_depth` mean diameters above the floor and as many below the level, or below a twentieth
  /// of the surface of a full container; absent where that is thinner than a mean diameter.
  struct Core {
    double from, to, porosity;
  };
  std::optional<Core> core;
  static constexpr double core_depth = 3, well_covered = 0.95;

  /// Equal layers from the floor to the highest point. Volumes of sphere slices and of the container's are
  /// exact to rounding, see domain/volume_below.hpp.
  struct Layer {
    double from, to, packing_fraction;
  };
  std::vector<Layer> layers;

  Rest rest;
};

struct BedOptions {
  std::optional<Vector<3>> direction = {};  ///< of gravity; if absent against the last axis
  /// It is known to be a bed. If not, spheres are one where they leave the top of the container empty, by a
  /// mean diameter and a fiftieth of its volume or more, and no more than half of them hang.
  bool is_bed = false;
  double friction = 0;  ///< as of `RestOptions`
  double gap = 0, wall_gap = 0;  ///< see `measure_rest`
  double layer = 0.1;            ///< thickness in mean diameters, about; at most `most_layers`
  std::size_t most_layers = 1000;
};

/// Absent without spheres, in other dimensions than two and three, where there are no walls or the domain
/// repeats itself along gravity, and where spheres are no bed.
///
/// The height depends on the width of the cells: for equal spheres half of it lowers it by 0.09 d where the
/// top is level and by 0.16 d where `compress` left it rough, twice of it raises it by 0.06 d and 0.18 d.
/// Cost: that of `measure_rest`, some 0.3 µs a sphere for the surface, O(triangles) a layer in a mesh, and
/// 32,768 questions to the walls. `made`: see `local_container`. Precondition: spheres of the domain's
/// dimension, inside it; direction not 0.
std::optional<BedProfile> bed_profile(const Spheres<dynamic>&, const Domain&, const BedOptions& = {},
                                      const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
