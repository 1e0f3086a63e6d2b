#include "soft/soft_kernels.hpp"

#include <immintrin.h>

#include <vector>

#include "core/instruction_sets.hpp"
#include "soft/soft_walls.hpp"

#define BERNAL_INLINE inline __attribute__((always_inline))
#define BERNAL_INLINE_LAMBDA __attribute__((always_inline))

// The types of the wider instruction sets never cross a call that is not inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
// GCC 12 takes the "undefined" operands in its own avx512 headers for uninitialised variables.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif

namespace bernal {
namespace {

/// For each byte the positions of its set bits, one a byte, the lowest first.
struct SetBitsOfByte {
  std::uint64_t positions[256] = {};
  constexpr SetBitsOfByte() {
    for (unsigned byte = 0; byte < 256; ++byte) {
      int n = 0;
      for (unsigned bit = 0; bit < 8; ++bit)
        if (byte >> bit & 1) positions[byte] |= std::uint64_t{bit} << (8 * n++);
    }
  }
};
constexpr SetBitsOfByte set_bits_of_byte;

BERNAL_INLINE __m128i sphere(const SoftSphere* at) {
  return _mm_load_si128(reinterpret_cast<const __m128i*>(at));
}
BERNAL_INLINE void store(SoftSphere* to, __m128i sphere) {
  _mm_store_si128(reinterpret_cast<__m128i*>(to), sphere);
}

namespace sse2 {
#include "soft/soft_kernels_body.hpp"
}

BERNAL_BEGIN_TARGET("avx2,popcnt")
#define BERNAL_EIGHT_LANES
namespace avx2 {
#include "soft/soft_kernels_body.hpp"
}
#undef BERNAL_EIGHT_LANES
BERNAL_END_TARGET

BERNAL_BEGIN_TARGET("avx2,popcnt," BERNAL_AVX512)
#define BERNAL_SIXTEEN_LANES
namespace avx512 {
#include "soft/soft_kernels_body.hpp"
}
#undef BERNAL_SIXTEEN_LANES
BERNAL_END_TARGET

std::vector<SoftKernels> runnable_kernels() {
  std::vector<SoftKernels> kernels;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
    kernels.push_back({"AVX-512", avx512::sweep, avx512::sweep, avx512::gather, avx512::search});
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt"))
    kernels.push_back({"AVX2", avx2::sweep, avx2::sweep, avx2::gather, avx2::search});
  kernels.push_back({"SSE2", sse2::sweep, sse2::sweep, sse2::gather, sse2::search});
  return kernels;
}

}  // namespace

std::span<const SoftKernels> soft_kernels() {
  static const std::vector<SoftKernels> kernels = runnable_kernels();
  return kernels;
}

}  // namespace bernal
