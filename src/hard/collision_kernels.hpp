#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hard/flying_sphere.hpp"

namespace bernal {

/// Input of a scan for the collision times of a sphere with its neighbours, and space for the results.
template <int D>
struct CollisionScan {
  const FlyingSphere<D>* spheres;
  const FlyingSphere<D>* self;
  const std::uint32_t* neighbors;
  std::size_t count;
  double now;
  double size, growth;  ///< at time t all radii are r (size + growth t)
  double edges[D], inverse_edges[D];
  /// Scratch space for 2 D + 2 columns of `stride` numbers; `stride` is a multiple of `widest` and at least
  /// `count`.
  double* columns;
  std::size_t stride;
  /// Receives the time from `now` until the sphere touches each neighbour, infinite if never; `stride`
  /// numbers.
  double* delays;
};

/// The first collision of a scan: `neighbor` is an index in its list; ties go to the first.
struct FirstCollision {
  double delay;
  std::size_t neighbor;
};

/// Numbers in the widest instruction set's registers.
inline constexpr std::size_t widest = 8;

/// The inner loop of event-driven dynamics, compiled for several instruction sets with the same correctly
/// rounded operations in the same order, so with the same bits.
///
/// Two spheres touch when |d + w t| = s + s' t, with their relative position d and velocity w, the sum of
/// radii s and its growth s'. With b = d·w - s s', a = w² - s'², c = d² - s² this is a t² + 2 b t + c = 0;
/// the first root is computed without cancellation, c / (√(b² - a c) - b) for approaching spheres (b < 0), (b
/// + √(b² - a c)) / -a for those that separate more slowly than they grow (a < 0). A pair that overlaps, by
/// rounding, and still approaches collides immediately. The minimum image is that at `now`: exact while the
/// pair stays within half an edge. Source: Kansal, Torquato & Stillinger, J. Chem. Phys. 117, 8212 (2002);
/// Bannerman, Strobl, Formella & Pöschel, Comp. Part. Mech. 1, 191 (2014) for overlaps.
template <int D>
struct CollisionKernel {
  std::string_view name;
  /// Fills `delays` and returns the smallest of them. Cost: about 3 ns a neighbour.
  FirstCollision (*scan)(const CollisionScan<D>&);
};

/// The kernels that this processor can run, the fastest first; the last runs on every x86-64.
template <int D>
std::span<const CollisionKernel<D>> collision_kernels();

}  // namespace bernal
