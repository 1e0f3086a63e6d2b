#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// How densely every single sphere is packed: its volume over that of its cell in the radical (power,
/// Laguerre) diagram. The cell of sphere i is all of the domain that is nearer to it than to any other sphere
/// by the power distance,
///   |p - ci|² - ri² <= |p - cj|² - rj²  for all j, images among them,
/// which for equal spheres is the Voronoi cell. Neighbouring spheres that do not overlap are parted by the
/// plane between their cells, and the cells fill the domain.
///
/// Volumes are in the spheres' unit to the power of the dimension; arrays have one entry a sphere, in order.
struct LocalPacking {
  /// Volume of the sphere over that of its cell; 0 where the cell is empty, above 1 where overlaps leave less
  /// room than the sphere has.
  std::vector<double> packing_fraction;
  std::vector<double> cell_volume;
  /// Faces that a cell shares with those of other spheres, its own images among them. Faces of less than a
  /// millionth of the cell's surface do not count, so that a lattice has those that it is known by.
  std::vector<std::uint32_t> neighbours;

  double volume = 0;        ///< of the domain, or of one period
  double volume_error = 0;  ///< |sum of the cells - volume| / volume
  std::uint64_t empty = 0;  ///< cells without volume: of spheres that are hidden in others, or outside

  // Over the spheres whose cells are not empty; zero without any.
  double mean = 0;       ///< of the local packing fractions
  double deviation = 0;  ///< their standard deviation
  double mean_neighbours = 0;

  /// Local packing fractions below which this share of the spheres is.
  struct Quantile {
    double share, packing_fraction;
  };
  std::vector<Quantile> quantiles;
};

struct LocalPackingOptions {
  /// Absent for more spheres than so many.
  std::size_t most_spheres = std::numeric_limits<std::size_t>::max();
};

/// Absent without spheres, in other dimensions than two and three, and where there are more than
/// `most_spheres`. Spheres may overlap, coincide and lie in a line; along axes with a period centres may lie
/// anywhere, and periods may be as short as a sphere.
///
/// Neighbours come from CGAL's regular triangulation, exactly, block by block; each cell is then cut out of
/// the domain's bounds and is right where no sphere has a lesser power at any of its corners, which is
/// checked at every corner that others could reach. In periodic boxes and between flat walls along the axes
/// the cells sum to the volume within 1e-9. Cells that round walls or those of a mesh may cut are divided
/// into simplices until clearance, being 1-Lipschitz, decides or is linear enough: they sum to the
/// container's volume within 1e-3. What of a container lies behind a thin wall belongs to the sphere of the
/// least power all the same.
///
/// Cost in one thread: about 20 µs a sphere from 10^4 to 10^6 of them in periodic boxes, 60 µs at 10^4 and 50
/// at 10^5 between round walls, 30 and 20 in a mesh of 1,000 triangles; memory 240 MB for 10^6 spheres.
///
/// The same bits for any number of threads. `made`: see `local_container`. Throws Cancelled, see
/// core/monitor.hpp, where an interrupt asks for that.
/// Source: Gellatly & Finney, J. Non-Cryst. Solids 50 (1982) 313.
std::optional<LocalPacking> local_packing(const Spheres<dynamic>&, const Domain&,
                                          const LocalPackingOptions& = {},
                                          const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
