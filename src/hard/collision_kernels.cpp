#include "hard/collision_kernels.hpp"

#include <immintrin.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/instruction_sets.hpp"

// GCC 12 takes the "undefined" operands in its own avx512 headers for uninitialised variables.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
// The types of the wider instruction sets never cross a call that is not inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace bernal {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// v rounded to the nearest whole number; |v| < 2^51.
[[gnu::always_inline]] inline double nearest(double v) {
  constexpr double shift = 0x1.8p52;
  return (v + shift) - shift;
}

/// Fills the columns: all first components of the neighbours, all second ones, and so on. What is beyond
/// `count` repeats the last one.
struct OneByOne {
  template <int D>
  [[gnu::always_inline]] static void gather(const CollisionScan<D>& task, std::size_t padded) {
    const std::size_t stride = task.stride;
    double* __restrict columns = task.columns;
    for (std::size_t m = 0; m < padded; ++m) {
      const FlyingSphere<D>& other = task.spheres[task.neighbors[m < task.count ? m : task.count - 1]];
      for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(k) * stride + m] = other.x0[k];
      for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(D + k) * stride + m] = other.v[k];
      columns[2 * D * stride + m] = other.r;
    }
  }
};

/// The same in three dimensions, where a sphere is eight numbers, of which nobody reads the last here: eight
/// spheres are transposed in registers.
BERNAL_BEGIN_TARGET(BERNAL_AVX512)
struct EightByEight {
  [[gnu::always_inline]] static inline void gather(const CollisionScan<3>& task, std::size_t padded) {
    static_assert(sizeof(FlyingSphere<3>) == 8 * sizeof(double));
    const std::size_t stride = task.stride;
    for (std::size_t m = 0; m < padded; m += 8) {
      const auto row = [&](std::size_t k) __attribute__((always_inline)) {
        const std::size_t at = m + k < task.count ? m + k : task.count - 1;
        return _mm512_load_pd(task.spheres[task.neighbors[at]].x0);
      };
      const __m512d r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3), r4 = row(4), r5 = row(5), r6 = row(6),
                    r7 = row(7);
      const auto store = [&](std::size_t first, __m512d a, __m512d b, __m512d c, __m512d d)
          __attribute__((always_inline)) {
        const __m512d ab_even = _mm512_shuffle_f64x2(a, b, 0x88), ab_odd = _mm512_shuffle_f64x2(a, b, 0xdd),
                      cd_even = _mm512_shuffle_f64x2(c, d, 0x88), cd_odd = _mm512_shuffle_f64x2(c, d, 0xdd);
        double* const column = task.columns + first * stride + m;
        _mm512_storeu_pd(column, _mm512_shuffle_f64x2(ab_even, cd_even, 0x88));
        _mm512_storeu_pd(column + 2 * stride, _mm512_shuffle_f64x2(ab_odd, cd_odd, 0x88));
        _mm512_storeu_pd(column + 4 * stride, _mm512_shuffle_f64x2(ab_even, cd_even, 0xdd));
        _mm512_storeu_pd(column + 6 * stride, _mm512_shuffle_f64x2(ab_odd, cd_odd, 0xdd));
      };
      store(0, _mm512_unpacklo_pd(r0, r1), _mm512_unpacklo_pd(r2, r3), _mm512_unpacklo_pd(r4, r5),
            _mm512_unpacklo_pd(r6, r7));
      store(1, _mm512_unpackhi_pd(r0, r1), _mm512_unpackhi_pd(r2, r3), _mm512_unpackhi_pd(r4, r5),
            _mm512_unpackhi_pd(r6, r7));
    }
  }
};
BERNAL_END_TARGET

/// Of the gathered columns.
template <int D>
[[gnu::always_inline]] inline FirstCollision first_collision(const CollisionScan<D>& task,
                                                             std::size_t padded) {
  const std::size_t stride = task.stride;
  const double* __restrict columns = task.columns;
  double* __restrict delays = task.delays;
  const double size = task.size + task.growth * task.now, growth = task.growth, now = task.now;
  const FlyingSphere<D> self = *task.self;
  double edges[D], inverse_edges[D], place[D];
  for (int k = 0; k < D; ++k) {
    edges[k] = task.edges[k], inverse_edges[k] = task.inverse_edges[k];
    place[k] = self.x0[k] + self.v[k] * now;
  }
  BERNAL_INDEPENDENT_ROUNDS
  for (std::size_t m = 0; m < padded; ++m) {
    const double radii = self.r + columns[2 * D * stride + m];
    const double s = radii * size, s_growth = radii * growth;
    double dd = 0, dw = 0, ww = 0;
    for (int k = 0; k < D; ++k) {
      const double v = columns[static_cast<std::size_t>(D + k) * stride + m];
      double d = columns[static_cast<std::size_t>(k) * stride + m] + v * now - place[k];
      d -= edges[k] * nearest(d * inverse_edges[k]);
      const double w = v - self.v[k];
      dd += d * d;
      dw += d * w;
      ww += w * w;
    }
    const double a = ww - s_growth * s_growth, b = dw - s * s_growth, c = dd - s * s;
    const double discriminant = b * b - a * c;
    const double root = std::sqrt(discriminant > 0 ? discriminant : 0);
    const bool closing = b < 0;
    const bool apart = c > 0;
    const double numerator = closing ? (apart ? c : 0) : b + root;
    const double denominator = closing ? root - b : -a;
    const bool meets = closing ? (discriminant >= 0) | !apart : a < 0;
    const double delay = numerator / denominator;
    delays[m] = meets ? delay : never;
  }
  for (std::size_t m = task.count; m < padded; ++m) delays[m] = never;

  double least[widest], at[widest];
  for (std::size_t l = 0; l < widest; ++l) least[l] = delays[l], at[l] = static_cast<double>(l);
  for (std::size_t m = widest; m < padded; m += widest) {
    for (std::size_t l = 0; l < widest; ++l) {
      const bool sooner = delays[m + l] < least[l];
      at[l] = sooner ? static_cast<double>(m + l) : at[l];
      least[l] = sooner ? delays[m + l] : least[l];
    }
  }
  FirstCollision first{least[0], static_cast<std::size_t>(at[0])};
  for (std::size_t l = 1; l < widest; ++l) {
    const auto neighbor = static_cast<std::size_t>(at[l]);
    if (least[l] < first.delay || (least[l] == first.delay && neighbor < first.neighbor))
      first = {least[l], neighbor};
  }
  return first;
}

template <int D>
std::size_t padded_count(const CollisionScan<D>& task) {
  return (task.count + widest - 1) / widest * widest;
}

template <int D>
[[gnu::target(BERNAL_AVX512)]] FirstCollision scan_avx512(
    const CollisionScan<D>& task) {
  if (task.count == 0) return {never, 0};
  if constexpr (D == 3) {
    EightByEight::gather(task, padded_count(task));
  } else {
    OneByOne::gather(task, padded_count(task));
  }
  return first_collision(task, padded_count(task));
}
template <int D>
[[gnu::target("avx2")]] FirstCollision scan_avx2(const CollisionScan<D>& task) {
  if (task.count == 0) return {never, 0};
  OneByOne::gather(task, padded_count(task));
  return first_collision(task, padded_count(task));
}
template <int D>
FirstCollision scan_sse2(const CollisionScan<D>& task) {
  if (task.count == 0) return {never, 0};
  OneByOne::gather(task, padded_count(task));
  return first_collision(task, padded_count(task));
}

template <int D>
std::vector<CollisionKernel<D>> runnable() {
  std::vector<CollisionKernel<D>> kernels;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
    kernels.push_back({"AVX-512", scan_avx512<D>});
  if (__builtin_cpu_supports("avx2")) kernels.push_back({"AVX2", scan_avx2<D>});
  kernels.push_back({"SSE2", scan_sse2<D>});
  return kernels;
}

}  // namespace

template <int D>
std::span<const CollisionKernel<D>> collision_kernels() {
  static const std::vector<CollisionKernel<D>> kernels = runnable<D>();
  return kernels;
}

#define BERNAL_INSTANTIATE(D) template std::span<const CollisionKernel<D>> collision_kernels<D>();
BERNAL_IN_FLYING_DIMENSIONS(BERNAL_INSTANTIATE)

}  // namespace bernal
