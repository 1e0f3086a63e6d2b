#include "hard/collision_kernels.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace bernal {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// v rounded to the nearest whole number; |v| < 2^51.
[[gnu::always_inline]] inline double nearest(double v) {
  constexpr double shift = 0x1.8p52;
  return (v + shift) - shift;
}

template <int D>
[[gnu::always_inline]] inline void gather(const CollisionScan<D>& task, std::size_t padded) {
  const std::size_t stride = task.stride;
  double* __restrict columns = task.columns;
  for (std::size_t m = 0; m < padded; ++m) {
    const FlyingSphere<D>& other = task.spheres[task.neighbors[m < task.count ? m : task.count - 1]];
    for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(k) * stride + m] = other.x[k];
    for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(D + k) * stride + m] = other.v[k];
    columns[2 * D * stride + m] = other.time;
    columns[(2 * D + 1) * stride + m] = other.r;
  }
}

template <int D>
[[gnu::always_inline]] inline FirstCollision scan(const CollisionScan<D>& task) {
  if (task.count == 0) return {never, 0};
  const std::size_t padded = (task.count + widest - 1) / widest * widest;
  gather(task, padded);

  const std::size_t stride = task.stride;
  const double* __restrict columns = task.columns;
  double* __restrict delays = task.delays;
  const double size = task.size + task.growth * task.now, growth = task.growth, now = task.now;
  const FlyingSphere<D> self = *task.self;
  double edges[D], inverse_edges[D];
  for (int k = 0; k < D; ++k) edges[k] = task.edges[k], inverse_edges[k] = task.inverse_edges[k];
#pragma GCC ivdep
  for (std::size_t m = 0; m < padded; ++m) {
    const double flight = now - columns[2 * D * stride + m];
    const double radii = self.r + columns[(2 * D + 1) * stride + m];
    const double s = radii * size, s_growth = radii * growth;
    double dd = 0, dw = 0, ww = 0;
    for (int k = 0; k < D; ++k) {
      const double v = columns[static_cast<std::size_t>(D + k) * stride + m];
      double d = columns[static_cast<std::size_t>(k) * stride + m] + v * flight - self.x[k];
      d -= edges[k] * nearest(d * inverse_edges[k]);
      const double w = v - self.v[k];
      dd += d * d;
      dw += d * w;
      ww += w * w;
    }
    const double a = ww - s_growth * s_growth, b = dw - s * s_growth, c = dd - s * s;
    const double discriminant = b * b - a * c;
    const double root = std::sqrt(discriminant > 0 ? discriminant : 0);
    const bool closing = b<0, apart = c> 0;
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
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")]] FirstCollision scan_avx512(
    const CollisionScan<D>& task) {
  return scan<D>(task);
}
template <int D>
[[gnu::target("avx2")]] FirstCollision scan_avx2(const CollisionScan<D>& task) {
  return scan<D>(task);
}
template <int D>
FirstCollision scan_sse2(const CollisionScan<D>& task) {
  return scan<D>(task);
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

template std::span<const CollisionKernel<2>> collision_kernels<2>();
template std::span<const CollisionKernel<3>> collision_kernels<3>();
template std::span<const CollisionKernel<4>> collision_kernels<4>();
template std::span<const CollisionKernel<5>> collision_kernels<5>();
template std::span<const CollisionKernel<6>> collision_kernels<6>();

}  // namespace bernal
