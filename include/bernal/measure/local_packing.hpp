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
/// Volumes are in the spheres' unit to the power of the dimension; arrays have one entry a sphere that was
/// looked at, in their order.
struct LocalPacking {
  std::vector<std::uint32_t> ids;  ///< of the spheres that were looked at; empty: all, as they are
  /// Volume of the sphere over that of its cell; 0 where the cell is empty, above 1 where overlaps leave less
  /// room than the sphere has.
  std::vector<double> packing_fraction;
  std::vector<double> cell_volume;
  /// Faces that a cell shares with those of other spheres, its own images among them. Faces of less than a
  /// millionth of the cell's surface do not count, so that a lattice has those that it is known by.
  std::vector<std::uint32_t> neighbours;

  double volume = 0;        ///< of the domain, or of one period
  double volume_error = 0;  ///< |sum of the cells - volume| / volume; no number where not all were made
  std::uint64_t empty = 0;  ///< cells without volume: of spheres that are hidden in others, or outside

  // Over the spheres looked at whose cells are not empty; zero without any.
  double mean = 0;  ///< of the local packing fractions
  /// Standard error of the mean, as of spheres drawn at random; 0 where all were looked at.
  double mean_error = 0;
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
  /// Of more spheres than `all_of`, so many are looked at, evenly spread over the domain.
  std::size_t all_of = std::numeric_limits<std::size_t>::max(), looked_at = 10'000;
};

/// Absent without spheres, in other dimensions than two and three, and where there are more than
/// `most_spheres`. Spheres may overlap, coincide and lie in a line; along axes with a period centres may lie
/// anywhere, and periods may be as short as a sphere.
///
/// Each cell is cut out of the domain's bounds by the planes between spheres, the nearest first. Where round
/// walls cut it what is left comes in closed form, and it is cut along those of a mesh or a polygon: the
/// cells sum to the volume within 1e-9, those of a mesh to what its triangles enclose. Between round walls
/// neighbours are those whose cells meet before the wall, or little behind it. What of a container lies
/// behind a thin wall belongs to the sphere of the least power all the same.
///
/// Cost in one thread: about 10 µs a sphere, also where sizes differ by ten, whether there are round walls or
/// none.
///
/// The same bits for any number of threads. `made`: see `local_container`. Throws Cancelled, see
/// core/monitor.hpp, where an interrupt asks for that, and Error{bad_argument} for a domain with an inset.
/// Source: Gellatly & Finney, J. Non-Cryst. Solids 50 (1982) 313.
std::optional<LocalPacking> local_packing(const Spheres<dynamic>&, const Domain&,
                                          const LocalPackingOptions& = {},
                                          const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
