#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "bernal/figures/figures.hpp"
#include "bernal/run/packing.hpp"

namespace bernal::figures {

/// A packing that a figure needs.
struct PackingTask {
  Scene scene;
  double cost = 1;  ///< seconds that are expected, in any unit: what the progress is told by
  /// Its engine works in several threads where it may: packed after those that do not, in one thread, so that
  /// its seconds are of one thread too.
  bool alone = false;
};

/// How many contacts a sphere has, counted up to these gap ratios.
inline constexpr double counted_gaps[] = {1e-4, 2e-4, 3e-4, 5e-4, 7e-4, 1e-3, 2e-3, 5e-3, 1e-2};
inline constexpr std::size_t usual_gap = 6;  ///< 0.002

struct DonePacking {
  Packing packing;
  double phi = 0;
  double seconds = 0;                ///< of the processor, in the thread that packed it
  std::vector<double> coordination;  ///< at each of counted_gaps
};

/// Packs all, as many side by side as there are threads, the dearest first; every packing is certified. In
/// the order of the tasks; nothing where the monitor stops it. Throws Error{bad_argument} where one is not
/// certified.
std::optional<std::vector<DonePacking>> pack_all(const std::vector<PackingTask>& tasks,
                                                 std::string_view figure, const FigureOptions& options);

}  // namespace bernal::figures
