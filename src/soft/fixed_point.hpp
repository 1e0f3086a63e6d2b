#pragma once
#include <immintrin.h>

#include <cmath>
#include <cstdint>

namespace bernal {

/// Registers of 4 or 8 numbers.
template <int width>
struct Registers;
template <>
struct Registers<4> {
  using Floats = float __attribute__((vector_size(16)));
  using Ints = std::int32_t __attribute__((vector_size(16)));
  using Whole = std::uint32_t __attribute__((vector_size(16)));
};
template <>
struct Registers<8> {
  using Floats = float __attribute__((vector_size(32)));
  using Ints = std::int32_t __attribute__((vector_size(32)));
  using Whole = std::uint32_t __attribute__((vector_size(32)));
};

/// Those that hold one number for each of D axes; what is beyond D is always 0.
template <int D>
using RegistersFor = Registers<D <= 4 ? 4 : 8>;

/// A place in a periodic box: coordinates in whole numbers of edge / 2^32, so that differences wrap round to
/// the shortest image by themselves.
template <int D>
struct FixedPlace {
  typename RegistersFor<D>::Whole x;
};

/// What is left between spheres for the rounding of their places, in radii: so many resolutions at least, and
/// never more than the last.
constexpr double least_margin = 1e-4, resolutions_a_margin = 100, largest_margin = 0.01;

inline std::uint32_t to_fixed(double x, double edge) {
  const double share = x / edge;
  return static_cast<std::uint32_t>(
      static_cast<std::int64_t>(std::llround((share - std::floor(share)) * 0x1p32)));
}

/// Four components, of which those four apart are added.
template <class Floats>
inline __m128 to_four(const Floats& v) {
  struct Halves {
    __m128 low, high;
  };
  if constexpr (sizeof(Floats) == sizeof(__m128)) {
    return __builtin_bit_cast(__m128, v);
  } else {
    const Halves halves = __builtin_bit_cast(Halves, v);
    return _mm_add_ps(halves.low, halves.high);
  }
}

/// The sums of the components of four vectors.
inline __m128 sums(__m128 a, __m128 b, __m128 c, __m128 d) {
  const __m128 ab = _mm_add_ps(_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
  const __m128 cd = _mm_add_ps(_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
  return _mm_add_ps(_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab));
}

}  // namespace bernal
