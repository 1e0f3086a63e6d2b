#pragma once

namespace bernal {

/// What decides how a box of given edges is best filled with spheres of given radii.
struct FillTask {
  int dimension = 3;
  double packing_fraction = 0;  ///< that is asked for
  double attainable = 1;        ///< random close packing of these sizes
  double size_ratio = 1;        ///< of the largest radius to the smallest, but for one in 10,000 of each
  bool has_walls = false;
};

}  // namespace bernal
