#pragma once

namespace bernal {

/// Why a stage came to its end.
enum class StageEnd {
  converged,  ///< it did what it is for
  full,       ///< no place was left for the next sphere
  hit_limit,  ///< its limit on iterations or rounds came first
  cancelled,
};

}  // namespace bernal
