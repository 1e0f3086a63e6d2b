#pragma once
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {

/// Throws Error{bad_argument} unless `value` is positive and finite.
inline void require_positive(std::string_view what, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw Error(ErrorCode::bad_argument, fmt::format("{} must be positive and finite, not {}", what, value));
}

}  // namespace bernal
