#pragma once
#include <cmath>
#include <cstdint>

#include "soft/soft_kernels.hpp"

// The loops of `ColouredSpheres`, for a processor with very many threads, with one or some threads for a cell
// or a sphere. Compiled anywhere, they do the same correctly rounded operations on the same numbers in the
// same order, so that the results are the same bits.
#if defined(__CUDACC__)
#define BERNAL_EVERYWHERE __host__ __device__
#else
#define BERNAL_EVERYWHERE
#endif

namespace bernal {

/// The cells of a periodic box, an even number along each axis, the first axis the fastest. A cell is at
/// least as wide as neighbours may be apart, so that spheres in different cells of one colour, every second
/// one along each axis, are not neighbours. Plain numbers and arithmetic, for use on GPUs.
struct ColouredCells {
  std::uint32_t across[3];

  static constexpr std::uint32_t colours = 8;

  BERNAL_EVERYWHERE std::uint32_t size() const { return across[0] * across[1] * across[2]; }
  BERNAL_EVERYWHERE std::uint32_t along(const SoftSphere& s, int k) const {
    return static_cast<std::uint32_t>(std::uint64_t{static_cast<std::uint32_t>(s.x[k])} * across[k] >> 32);
  }
  BERNAL_EVERYWHERE std::uint32_t at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (z * across[1] + y) * across[0] + x;
  }
  /// The cell that a sphere is in.
  BERNAL_EVERYWHERE std::uint32_t of(const SoftSphere& s) const {
    return at(along(s, 0), along(s, 1), along(s, 2));
  }
  BERNAL_EVERYWHERE std::uint32_t of_a_colour_in_two_layers() const {
    return across[0] / 2 * (across[1] / 2);
  }
  /// Cell number n of a colour, counted from a pair of layers on.
  BERNAL_EVERYWHERE std::uint32_t of_colour(std::uint32_t colour, std::uint32_t first_pair,
                                            std::uint32_t n) const {
    const std::uint32_t row = across[0] / 2, x = n % row, y = n / row % (across[1] / 2);
    const std::uint32_t z = first_pair + n / of_a_colour_in_two_layers();
    return at(2 * x + (colour & 1), 2 * y + (colour >> 1 & 1), 2 * z + (colour >> 2));
  }
};

/// The way from one sphere to the nearest image of another along an axis, rounded as in `SoftKernels`.
BERNAL_EVERYWHERE inline float way(const SoftSphere& from, const SoftSphere& to, int k, const float* scale) {
  const std::uint32_t steps = static_cast<std::uint32_t>(to.x[k]) - static_cast<std::uint32_t>(from.x[k]);
  return static_cast<float>(static_cast<std::int32_t>(steps)) * scale[k];
}
BERNAL_EVERYWHERE inline float squared_distance(const SoftSphere& a, const SoftSphere& b,
                                                const float* scale) {
  const float dx = way(a, b, 0, scale), dy = way(a, b, 1, scale), dz = way(a, b, 2, scale);
  return (dx * dx + dy * dy) + dz * dz;
}

/// Raises *most to `value` if that is larger. Both are at least 0. Many threads may call it.
BERNAL_EVERYWHERE inline void raise_to(float* most, float value) {
#if defined(__CUDA_ARCH__)
  // The bits of numbers that are not negative are in the order of the numbers.
  if (value > *static_cast<volatile float*>(most))
    atomicMax(reinterpret_cast<int*>(most), __float_as_int(value));
#else
  *most = value > *most ? value : *most;
#endif
}

/// Writes the cell of each sphere and its number.
struct FindCells {
  const SoftSphere* spheres;
  ColouredCells cells;
  std::uint32_t *cell_of, *number_of;
  BERNAL_EVERYWHERE void operator()(std::uint32_t i) const {
    cell_of[i] = cells.of(spheres[i]);
    number_of[i] = i;
  }
};

/// Puts spheres into the order of their cells, and writes where each cell begins. `start` has one entry more
/// than there are cells.
struct TakeOrder {
  const SoftSphere* by_number;
  const std::uint32_t *cell_of, *number_of;  // in that order
  std::uint32_t count, cells;
  SoftSphere *spheres, *built_at;
  std::uint32_t* start;
  BERNAL_EVERYWHERE void operator()(std::uint32_t p) const {
    spheres[p] = built_at[p] = by_number[number_of[p]];
    const std::uint32_t first = p == 0 ? 0 : cell_of[p - 1] + 1;
    for (std::uint32_t c = first; c <= cell_of[p]; ++c) start[c] = p;
    if (p + 1 == count)
      for (std::uint32_t c = cell_of[p] + 1; c <= cells; ++c) start[c] = count;
  }
};

/// Puts spheres back into the order of their numbers.
struct GiveBack {
  const SoftSphere* in_order;
  const std::uint32_t* number_of;
  SoftSphere* by_number;
  BERNAL_EVERYWHERE void operator()(std::uint32_t p) const { by_number[number_of[p]] = in_order[p]; }
};

/// Puts spheres into the order of the cells again.
struct TakeAgain {
  const SoftSphere* by_number;
  const std::uint32_t* number_of;
  SoftSphere* spheres;
  BERNAL_EVERYWHERE void operator()(std::uint32_t p) const { spheres[p] = by_number[number_of[p]]; }
};

/// The number of neighbours that are read together, a unit of a list.
inline constexpr std::uint32_t neighbors_a_unit = 4;

struct alignas(4 * neighbors_a_unit) NeighborUnit {
  std::uint32_t places[neighbors_a_unit];
};

/// Finds the neighbours of sphere p in the cells around its own. If `units` is null it only counts the units
/// that they take. Else it writes them from unit `first_unit[p]` on, and fills the last unit up with the
/// place behind the last sphere, where no sphere is.
struct FindNeighbors {
  const SoftSphere* spheres;
  ColouredCells cells;
  const std::uint32_t* start;
  float scale[3];
  float twice_the_skin;
  std::uint32_t count;
  std::uint32_t* first_unit;  // of p; while they are counted, the number of units of p
  NeighborUnit* units;

  BERNAL_EVERYWHERE void operator()(std::uint32_t p) const {
    const SoftSphere me = spheres[p];
    std::uint32_t found = 0;
    NeighborUnit unit;
    NeighborUnit* out = units ? units + first_unit[p] : nullptr;
    const auto look = [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t q = begin; q < end; ++q) {
        const SoftSphere it = spheres[q];
        const float reach = me.r + it.r + twice_the_skin;
        if (!(squared_distance(it, me, scale) < reach * reach) || q == p) continue;
        if (units) unit.places[found % neighbors_a_unit] = q;
        if (++found % neighbors_a_unit == 0 && units) *out++ = unit;
      }
    };
    const std::uint32_t x = cells.along(me, 0), y = cells.along(me, 1), z = cells.along(me, 2);
    const std::uint32_t nx = cells.across[0], ny = cells.across[1], nz = cells.across[2];
    for (std::uint32_t k = nz - 1; k <= nz + 1; ++k)
      for (std::uint32_t j = ny - 1; j <= ny + 1; ++j) {
        const std::uint32_t row = cells.at(0, (y + j) % ny, (z + k) % nz);
        const std::uint32_t low = row + (x == 0 ? 0 : x - 1), high = row + (x + 1 == nx ? x : x + 1);
        look(start[low], start[high + 1]);
        if (x == 0) look(start[row + nx - 1], start[row + nx]);
        if (x + 1 == nx) look(start[row], start[row + 1]);
      }
    if (!units) {
      first_unit[p] = (found + neighbors_a_unit - 1) / neighbors_a_unit;
      return;
    }
    if (found % neighbors_a_unit == 0) return;
    for (; found % neighbors_a_unit != 0; ++found) unit.places[found % neighbors_a_unit] = count;
    *out = unit;
  }
};

/// The sums over the neighbours of a sphere.
struct Pushes {
  float x = 0, y = 0, z = 0, contacts = 0;
  float largest = 0;  ///< overlap ratio

  BERNAL_EVERYWHERE friend Pushes operator+(const Pushes& a, const Pushes& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.contacts + b.contacts,
            a.largest > b.largest ? a.largest : b.largest};
  }
};

/// Moves the spheres of a cell one after the other, as `SoftKernels::Sweep` does. Thread n works for cell
/// n / threads: `threads` threads share the neighbours of a sphere, and their sums are added in pairs.
template <bool measure>
struct SweepColour {
  static constexpr std::uint32_t threads = 4;

  SoftSphere* spheres;  // the one behind the last is `no_sphere`
  ColouredCells cells;
  std::uint32_t colour = 0, first_pair = 0;  // of layers
  const std::uint32_t *start, *first_unit;
  const NeighborUnit* units;
  float scale[3] = {}, inverse[3] = {};
  float omega;
  float* worst;

  BERNAL_EVERYWHERE void operator()(std::uint32_t n) const {
#if defined(__CUDA_ARCH__)
    const std::uint32_t cell = cells.of_colour(colour, first_pair, n / threads), thread = n % threads;
    const unsigned together = ((1u << threads) - 1) << (threadIdx.x % warpSize / threads * threads);
    float largest = 0;
    for (std::uint32_t p = start[cell], end = start[cell + 1]; p < end; ++p) {
      const SoftSphere me = spheres[p];
      Pushes pushes = of_thread(p, me, thread);
      for (unsigned apart = 1; apart < threads; apart *= 2) {
        const auto other = [&](float value) { return __shfl_xor_sync(together, value, apart); };
        pushes = pushes + Pushes{other(pushes.x), other(pushes.y), other(pushes.z), other(pushes.contacts),
                                 measure ? other(pushes.largest) : 0};
      }
      if (thread == 0) move(p, me, pushes, largest);
      __syncwarp(together);
    }
    if (measure && thread == 0) raise_to(worst, largest);
#else
    if (n % threads != 0) return;  // the first does it for all
    const std::uint32_t cell = cells.of_colour(colour, first_pair, n / threads);
    float largest = 0;
    for (std::uint32_t p = start[cell], end = start[cell + 1]; p < end; ++p) {
      const SoftSphere me = spheres[p];
      Pushes pushes[threads];
      for (std::uint32_t thread = 0; thread < threads; ++thread) pushes[thread] = of_thread(p, me, thread);
      for (unsigned apart = 1; apart < threads; apart *= 2)
        for (std::uint32_t thread = 0; thread < threads; thread += 2 * apart)
          pushes[thread] = pushes[thread] + pushes[thread + apart];
      move(p, me, pushes[0], largest);
    }
    if (measure) raise_to(worst, largest);
#endif
  }

  BERNAL_EVERYWHERE Pushes of_thread(std::uint32_t p, const SoftSphere& me, std::uint32_t thread) const {
    Pushes pushes;
    for (std::uint32_t u = first_unit[p] + thread, last = first_unit[p + 1]; u < last; u += threads) {
      const NeighborUnit unit = units[u];
      SoftSphere its[neighbors_a_unit];
      for (std::uint32_t k = 0; k < neighbors_a_unit; ++k) its[k] = spheres[unit.places[k]];
      for (const SoftSphere& it : its) {
        const float dx = way(it, me, 0, scale), dy = way(it, me, 1, scale), dz = way(it, me, 2, scale);
        const float reach = me.r + it.r;
        const float d = sqrtf((dx * dx + dy * dy) + dz * dz);
        if (!(d < reach) || !(d > 0.0f)) continue;
        const float depth = reach - d;
        const float shared = (it.r + it.r) / (reach * d);
        const float push = shared * depth;
        pushes.x += push * dx;
        pushes.y += push * dy;
        pushes.z += push * dz;
        pushes.contacts += shared * d;
        if constexpr (measure) {
          const float ratio = depth / reach;
          pushes.largest = ratio > pushes.largest ? ratio : pushes.largest;
        }
      }
    }
    return pushes;
  }

  BERNAL_EVERYWHERE void move(std::uint32_t p, const SoftSphere& me, const Pushes& pushes,
                              float& largest) const {
    largest = pushes.largest > largest ? pushes.largest : largest;
    if (!(pushes.contacts > 0.0f)) return;
    float step = omega / pushes.contacts;
    step = step < 1.0f ? step : 1.0f;
    const float sum[3] = {pushes.x, pushes.y, pushes.z};
    SoftSphere moved = me;
    for (int k = 0; k < 3; ++k) {
      const auto by = static_cast<std::int32_t>(rintf(sum[k] * step * inverse[k]));
      moved.x[k] =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(me.x[k]) + static_cast<std::uint32_t>(by));
    }
    spheres[p] = moved;
  }
};

/// Finds the largest squared move in each part of the spheres.
struct FindMoves {
  const SoftSphere *spheres, *built_at;
  float scale[3];
  std::uint32_t part;
  float* squares;
  BERNAL_EVERYWHERE void operator()(std::uint32_t p) const {
    raise_to(squares + p / part, squared_distance(built_at[p], spheres[p], scale));
  }
};

}  // namespace bernal
