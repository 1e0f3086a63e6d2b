#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The structure factor of the centres in a periodic box,
///   S(k) = |Σ exp(i k·cj)|² / N,
/// averaged over wave vectors of about the same length. The allowed wave vectors have components that are
/// multiples of 2π / edge. S is 1 for an ideal gas and has sharp peaks for a lattice; its limit at small k
/// measures the fluctuation of the number of spheres in large volumes. Lengths are in the scene's unit, wave
/// numbers in its inverse.
struct StructureFactor {
  double mean_diameter = 0;
  double bin_width = 0;
  // One entry for each bin with allowed wave vectors; k and -k count once.
  std::vector<double> k;  ///< mean length of the evaluated vectors
  std::vector<double> s;
  std::vector<double> error;           ///< standard error of s; see `structure_factor`
  std::vector<std::uint32_t> vectors;  ///< evaluated wave vectors
  std::uint64_t references = 0;        ///< evaluated wave vectors in all bins

  struct Peak {
    double k, s, error;
  };
  /// The highest value between 4 and 10 inverse mean diameters, if it is a maximum of at least eight wave
  /// vectors and above what random centres have: 1 + 4.5 / √vectors. Near 7 for random packings of equal
  /// spheres, 6.6 for discs.
  std::optional<Peak> peak() const;
};

struct StructureOptions {
  double bin = 0.2;   ///< inverse mean diameters
  double reach = 30;  ///< inverse mean diameters
  /// Approximate number of exp(i k·c) computed, up to 400 wave vectors a bin; however many spheres there are,
  /// 24 a bin, and 200 between 4 and 10 inverse mean diameters, where the first peak is.
  double work = 1e8;
  std::size_t most_spheres = std::numeric_limits<std::size_t>::max();  ///< absent for more
};

/// Absent if there are walls, for fewer than two spheres, and for more than `most_spheres`; any dimension.
///
/// If a bin has too many wave vectors, some are chosen, spread evenly over the directions. Over random
/// directions S scatters by as much as its value, so the error is the scatter in the bin (or S, for fewer
/// than eight vectors) over the root of their number. The result is the same for any number of threads. Cost:
/// N vectors at about 2 ns, for a million spheres 20 s of processor time; memory some MB. Precondition: bin
/// and reach positive.
std::optional<StructureFactor> structure_factor(const Spheres<dynamic>&, const Domain&,
                                                const StructureOptions& = {});

}  // namespace bernal
