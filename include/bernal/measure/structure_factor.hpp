#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The structure factor of the centres in a periodic box: how strongly a wave of wave vector k is scattered,
///   S(k) = |Σ exp(i k·cj)|² / N,
/// averaged over wave vectors of about the same length. A periodic box allows those whose components are
/// multiples of 2π / edge. S is 1 for an ideal gas, peaks of lattices are sharp, and what it falls to at
/// small k says how much the number of spheres in a large part of the packing varies. Lengths are in the
/// scene's unit, wave numbers in its inverse.
struct StructureFactor {
  double mean_diameter = 0;
  double bin_width = 0;
  // One entry a bin that holds allowed wave vectors; of k and -k one counts.
  std::vector<double> k;  ///< mean length of the vectors that were looked at
  std::vector<double> s;
  std::vector<double> error;           ///< standard error of s; see `structure_factor`
  std::vector<std::uint32_t> vectors;  ///< that were looked at
  std::uint64_t references = 0;        ///< wave vectors in all

  struct Peak {
    double k, s, error;
  };
  /// The highest value between 4 and 10 inverse mean diameters, if it is a maximum of eight wave vectors or
  /// more and higher than centres spread by chance have: 1 + 4.5 / √vectors. Near 7 for random packings of
  /// equal spheres, 6.6 for discs.
  std::optional<Peak> peak() const;
};

struct StructureOptions {
  double bin = 0.2;   ///< inverse mean diameters
  double reach = 30;  ///< inverse mean diameters
  double work = 1e8;  ///< about how many exp(i k·c) are computed; of eight wave vectors a bin at least
  std::size_t most_spheres = std::numeric_limits<std::size_t>::max();  ///< absent for more
};

/// Absent where there are walls, for fewer than two spheres, and for more than `most_spheres`; any dimension.
///
/// Where all wave vectors of a bin are too many, some are chosen, spread evenly over the directions. Of
/// vectors in random directions S scatters as much as it is high, so that the error is the scatter of the
/// bin, or S where fewer than eight vectors say too little of that, over the root of their number. The same
/// bits for any number of threads. Cost: min(options.work, N vectors) at about 2 ns; memory some MB.
/// Precondition: bin and reach positive.
std::optional<StructureFactor> structure_factor(const Spheres<dynamic>&, const Domain&,
                                                const StructureOptions& = {});

}  // namespace bernal
