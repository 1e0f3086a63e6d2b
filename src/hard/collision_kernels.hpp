#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hard/flying_sphere.hpp"

namespace bernal {

/// The question when a sphere meets which of its neighbours, and room for the answer.
template <int D>
struct CollisionScan {
  const FlyingSphere<D>* spheres;
  const FlyingSphere<D>* self;
  const std::uint32_t* neighbors;
  std::size_t count;
  double now;
  double size, growth;  ///< at time t all radii are r (size + growth t)
  double edges[D], inverse_edges[D];
  /// Room for 2 D + 2 columns of `stride` numbers, a multiple of `widest` and at least `count`.
  double* columns;
  std::size_t stride;
  /// Receives the time from `now` until the sphere touches each neighbour, infinite where it never does. Room
  /// for `stride` numbers.
  double* delays;
};

/// The first collision of a scan: `neighbor` counts within its list; the first of several at the same time.
struct FirstCollision {
  double delay;
  std::size_t neighbor;
};

/// Numbers that the widest instruction set works on at once.
inline constexpr std::size_t widest = 8;

/// The inner loop of event-driven dynamics, compiled for several instruction sets: the same correctly rounded
/// operations in the same order, so the same bits.
///
/// Two spheres touch when |d + w t| = s + s' t, d and w being their relative place and velocity, s the sum of
/// the radii and s' its growth. With b = d·w - s s', a = w² - s'², c = d² - s² that is a t² + 2 b t + c = 0;
/// of its roots the first one is taken in the form that does not cancel, c / (√(b² - a c) - b) for spheres
/// that come closer (b < 0), (b + √(b² - a c)) / -a for those that part more slowly than they grow (a < 0). A
/// pair that overlaps, by rounding, and still comes closer collides now. The minimum image is that of `now`:
/// exact while the pair stays within half an edge. Source: Kansal, Torquato & Stillinger, J. Chem. Phys. 117,
/// 8212 (2002); Bannerman, Strobl, Formella & Pöschel, Comp. Part. Mech. 1, 191 (2014) for overlaps.
template <int D>
struct CollisionKernel {
  std::string_view name;
  /// Fills `delays` and returns the smallest of them. Cost: about 3 ns a neighbour.
  FirstCollision (*scan)(const CollisionScan<D>&);
};

/// Those that this processor can run, the fastest first; the last is for every x86-64.
template <int D>
std::span<const CollisionKernel<D>> collision_kernels();

}  // namespace bernal
