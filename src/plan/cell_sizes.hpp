#pragma once
#include <memory>
#include <vector>

#include "bernal/plan/plan.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// What a scene states of the cells of its packing, see `CellSizes`: their volumes, or the radii of balls of
/// the same volume. Precondition of all here: the scene has `cells`.
struct StatedCells {
  std::unique_ptr<SizeDistribution> sizes;
  bool are_volumes;

  double volume_of(double size) const;
  double size_of(double volume) const;
  double mean_volume() const;
  /// So many of them: the quantiles at (k + 1/2) / count, ascending.
  std::vector<double> volumes(std::size_t count) const;
};
StatedCells stated_cells_of(const Scene&);

/// About the radii of the spheres that are packed first, of up to 1,000 sizes.
std::unique_ptr<SizeDistribution> first_radii_of(const Scene&);

/// The radius of a sphere that fills this fraction of its cell.
double radius_in_cell(double volume, double packing_fraction);

/// The scene whose stages pack spheres of these radii, each once, where the other asks for cells. What is
/// asked of the packing fraction in a box of given size is a matter of the radii.
Scene scene_of_radii(const Scene&, std::vector<double> radii);

/// The plan of such a scene: what its spheres are at first, which fill their cells alike, as densely as the
/// stages are likely to reach; what finding the cells costs comes on top.
Plan plan_of_cells(const Scene& stated);

}  // namespace bernal
