#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/sweep/sweep.hpp"

namespace bernal::sweep {

/// Cells whose scenes have been read, and what their plans expect.
struct CheckedCells {
  std::vector<SweepRow> rows;  ///< without results
  double most_memory = 0;      ///< bytes of a cell, with all that it takes
  double most_seconds = 0;     ///< of one thread
};

/// Reads the cells from `first` to `last`. Refuses two that are the same, and builds some, see `run_sweep`;
/// with `built` false none. Throws Cancelled once the monitor says stop.
CheckedCells check_cells(const Sweep& sweep, std::size_t first, std::size_t last, bool built,
                         const Monitor& monitor);

}  // namespace bernal::sweep
