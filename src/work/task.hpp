#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/vector.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// What decides how a domain is best filled with spheres of given radii.
struct FillTask {
  int dimension = 3;
  double packing_fraction = 0;  ///< that is asked for
  double attainable = 1;        ///< random close packing of these sizes
  double size_ratio = 1;        ///< of the largest radius to the smallest, but for one in 10,000 of each
  /// Mean radius by volume over the mean by number: 1 for equal spheres, exp(3.5 sigma²) for lognormal ones.
  double width_of_sizes = 1;
  bool has_walls = false;
  bool is_tilted = false;    ///< the box is
  bool may_overlap = false;  ///< some overlap is allowed to stay
};

/// What is asked of the stages of a run. No stage changes it. Lengths are in the packer's unit, a power of
/// two of the scene's.
struct Task {
  Target target = {};
  /// Largest overlap ratio that the result may keep; 0 for none.
  double allowed_overlap = 0;
  /// The packing fraction that the stages are likely to reach.
  double attainable = 1;
  /// Random close packing of the sizes without walls, as predicted; 0 where no stage asks.
  double close_packing = 0;
  /// By the plan, for stages that choose their method.
  FillTask fill_task = {};
  Domain domain = {};
  Frame frame = {};  ///< of the packer's coordinates

  // ---- in a bed

  std::shared_ptr<const Container> container = {};  ///< null where no stage works in a bed
  /// A place within some roundings of this one at which a sphere of that radius lies inside the domain of the
  /// scene, touching allowed: for those that the walls leave no room. Set by the run.
  std::function<std::optional<Vector<3>>(const Vector<3>& place, double r)> exact_place = {};
  /// Places of few spheres, all that are asked for, with room for each: found before the run. None: empty.
  std::vector<Vector<3>> few_places = {};

  // ---- in a box

  /// Axes on which the box ends at walls, with whole spheres between them; empty: none.
  std::vector<bool> walls = {};
  /// The edges that the box is to end with, where the scene says so.
  std::optional<Vector<dynamic>> target_edges = {};

  /// Of a periodic box with these edges; all 0 where it is upright.
  Tilt tilt(const Vector<dynamic>& edges) const {
    const auto* box = std::get_if<Box>(&domain);
    return box ? tilt_in_proportion(*box, edges) : Tilt{};
  }
  bool has_wall(int axis) const { return !walls.empty() && walls[static_cast<std::size_t>(axis)]; }
};

}  // namespace bernal
