#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Whether shares weigh a sphere by its volume: as they do by mass, where there is one density.
inline bool counts_volume(Basis basis) { return basis != Basis::number; }

// Each throws Error{bad_argument}.

/// Unless `value` is positive and finite.
inline void require_positive(std::string_view what, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw Error(ErrorCode::bad_argument, fmt::format("{} must be positive and finite, not {}", what, value));
}

/// Unless 0 < min < max < infinity.
inline void require_interval(double min, double max) {
  if (min > 0 && min < max && std::isfinite(max)) return;
  throw Error(ErrorCode::bad_argument,
              fmt::format("the radii are cut to [{}, {}], which is no interval above 0", min, max));
}

/// Unless `radii` are positive, finite and ascending.
inline void require_ascending(std::string_view what, std::span<const double> radii) {
  for (const double r : radii) require_positive(what, r);
  const auto falls = std::ranges::adjacent_find(radii, std::greater_equal<>());
  if (falls != radii.end())
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} must ascend, but {} stands before {}", what, falls[0], falls[1]));
}

}  // namespace bernal
