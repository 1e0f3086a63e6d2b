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

/// The local packing fraction of every sphere: its volume over that of its cell in the radical (power,
/// Laguerre) diagram. The cell of sphere i is the part of the domain that is nearest to it by power distance,
///   |p - ci|² - ri² <= |p - cj|² - rj²  for all j, images included;
/// for equal spheres it is the Voronoi cell. The plane between two cells separates neighbouring spheres that
/// do not overlap, and the cells fill the domain.
///
/// Volumes are in the spheres' unit to the power of the dimension. Arrays have one entry for each evaluated
/// sphere, in their order.
struct LocalPacking {
  std::vector<std::uint32_t> ids;  ///< indices of the evaluated spheres; empty if all were
  /// Volume of the sphere over that of its cell; 0 if the cell is empty, above 1 if overlaps leave the cell
  /// smaller than the sphere.
  std::vector<double> packing_fraction;
  std::vector<double> cell_volume;
  /// Faces shared with the cells of other spheres or of its own images. Faces below a millionth of the cell's
  /// surface do not count, so that a lattice has its known coordination.
  std::vector<std::uint32_t> neighbours;

  double volume = 0;        ///< of the domain, or of one period
  double volume_error = 0;  ///< |sum of the cells - volume| / volume; NaN unless all cells were made
  std::uint64_t empty = 0;  ///< cells without volume: of spheres hidden in others or outside the domain

  // Over the evaluated spheres whose cells are not empty; zero if there are none.
  double mean = 0;  ///< of the local packing fractions
  /// Standard error of the mean for spheres drawn at random; 0 if all were evaluated.
  double mean_error = 0;
  double deviation = 0;  ///< standard deviation of the local packing fractions
  double mean_neighbours = 0;

  /// The local packing fraction that this share of the spheres is below.
  struct Quantile {
    double share, packing_fraction;
  };
  std::vector<Quantile> quantiles;
};

struct LocalPackingOptions {
  /// The result is absent for more spheres than this.
  std::size_t most_spheres = std::numeric_limits<std::size_t>::max();
  /// For more than `all_of` spheres, only `looked_at` are evaluated, evenly spread over the domain.
  std::size_t all_of = std::numeric_limits<std::size_t>::max(), looked_at = 10'000;
};

/// Absent without spheres, in other than two or three dimensions, and for more than `most_spheres`. Spheres
/// may overlap, coincide and be collinear; along periodic axes centres may lie anywhere, and periods may be
/// as short as a sphere.
///
/// Each cell is cut from the domain's bounds by the planes between spheres, the nearest first. Cuts by round
/// walls are in closed form; walls of meshes and polygons cut cells exactly. The cells sum to the domain's
/// volume within 1e-9 (for a mesh, the volume that its triangles enclose). At round walls neighbours are
/// spheres whose cells meet inside the wall or just behind it. Parts of a container behind a thin wall still
/// belong to the sphere of least power distance.
///
/// Cost: about 10 µs a sphere in one thread, with and without round walls, also for size ratios of ten.
///
/// The result is the same for any number of threads. `made`: as `MeasureOptions::container`. Throws
/// Cancelled, see core/monitor.hpp, if an interrupt requests it, and Error{bad_argument} for a domain with an
/// inset. Source: Gellatly & Finney, J. Non-Cryst. Solids 50 (1982) 313.
std::optional<LocalPacking> local_packing(const Spheres<dynamic>&, const Domain&,
                                          const LocalPackingOptions& = {},
                                          const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
