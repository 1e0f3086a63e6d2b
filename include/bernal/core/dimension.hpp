#pragma once
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include "bernal/core/error.hpp"
#include "bernal/core/vector.hpp"

namespace bernal {

/// Volume of the ball of radius r in `dimension` dimensions: π^(D/2) r^D / Γ(D/2 + 1). Error: a few
/// roundoffs.
inline double ball_volume(int dimension, double r) {
  if (dimension == 3) return 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const double half = 0.5 * dimension;
  return std::pow(std::numbers::pi, half) / std::tgamma(half + 1) * std::pow(r, dimension);
}

/// The one place where a dimension that is known at run time becomes a template argument: calls
/// f(std::integral_constant<int, D>) for D == dimension, which must be among those given.
/// Throws Error{bad_argument} if it is not.
template <int... D, class F>
decltype(auto) with_dimension(int dimension, std::integer_sequence<int, D...>, F&& f) {
  using Result = std::common_type_t<decltype(f(std::integral_constant<int, D>{}))...>;
  if constexpr (std::is_void_v<Result>) {
    if (!((dimension == D && (f(std::integral_constant<int, D>{}), true)) || ...))
      throw Error(ErrorCode::bad_argument, "no such dimension: " + std::to_string(dimension));
  } else {
    Result result{};
    if (!((dimension == D && (result = f(std::integral_constant<int, D>{}), true)) || ...))
      throw Error(ErrorCode::bad_argument, "no such dimension: " + std::to_string(dimension));
    return result;
  }
}

using EveryDimension = std::integer_sequence<int, 1, 2, 3, 4, 5, 6, 7, 8>;

}  // namespace bernal
