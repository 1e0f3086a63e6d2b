// The loops of SoftKernels in the instruction set that soft_kernels.cpp selects before it includes this file,
// once for each and in a namespace of its own (hence no include guard). `width` numbers are worked on at
// once; what depends on the instruction set stands in the first half, the loops in the second.

#if defined(BERNAL_SIXTEEN_LANES)
constexpr int width = 16;
#elif defined(BERNAL_EIGHT_LANES)
constexpr int width = 8;
#else
constexpr int width = 4;
#endif

using Floats = float __attribute__((vector_size(4 * width)));
using Ints = int __attribute__((vector_size(4 * width)));
using UnalignedFloats = float __attribute__((vector_size(4 * width), aligned(4), may_alias));
using UnalignedInts = int __attribute__((vector_size(4 * width), aligned(4), may_alias));

/// `width` spheres, one column a coordinate.
struct Columns {
  Ints x, y, z;
  Floats r;
};

#if defined(BERNAL_SIXTEEN_LANES)

/// Spheres *at(k), *at(k + 4), …, as many as there is room for.
template <class At>
BERNAL_INLINE Ints every_fourth(At at, int k) {
  __m512i v = _mm512_castsi128_si512(sphere(at(k)));
  v = _mm512_inserti32x4(v, sphere(at(k + 4)), 1);
  v = _mm512_inserti32x4(v, sphere(at(k + 8)), 2);
  return Ints(_mm512_inserti32x4(v, sphere(at(k + 12)), 3));
}
BERNAL_INLINE void store_every_fourth(SoftSphere* to, Ints four) {
  store(to, _mm512_castsi512_si128(__m512i(four)));
  store(to + 4, _mm512_extracti32x4_epi32(__m512i(four), 1));
  store(to + 8, _mm512_extracti32x4_epi32(__m512i(four), 2));
  store(to + 12, _mm512_extracti32x4_epi32(__m512i(four), 3));
}

BERNAL_INLINE Floats root(Floats v) { return Floats(_mm512_sqrt_ps(__m512(v))); }
BERNAL_INLINE Ints to_ints(Floats v) { return Ints(_mm512_cvtps_epi32(__m512(v))); }
BERNAL_INLINE unsigned mask_of(Ints v) { return _mm512_movepi32_mask(__m512i(v)); }

/// Writes those of `width` numbers whose bit of the mask is set, and scribbles behind them.
BERNAL_INLINE std::uint32_t* append(std::uint32_t* out, const std::uint32_t* from, unsigned mask) {
  _mm512_storeu_si512(out,
                      _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), _mm512_loadu_si512(from)));
  return out + __builtin_popcount(mask);
}

#elif defined(BERNAL_EIGHT_LANES)

template <class At>
BERNAL_INLINE Ints every_fourth(At at, int k) {
  return Ints(_mm256_inserti128_si256(_mm256_castsi128_si256(sphere(at(k))), sphere(at(k + 4)), 1));
}
BERNAL_INLINE void store_every_fourth(SoftSphere* to, Ints four) {
  store(to, _mm256_castsi256_si128(__m256i(four)));
  store(to + 4, _mm256_extracti128_si256(__m256i(four), 1));
}

BERNAL_INLINE Floats root(Floats v) { return Floats(_mm256_sqrt_ps(__m256(v))); }
BERNAL_INLINE Ints to_ints(Floats v) { return Ints(_mm256_cvtps_epi32(__m256(v))); }
BERNAL_INLINE unsigned mask_of(Ints v) { return static_cast<unsigned>(_mm256_movemask_ps(__m256(v))); }

BERNAL_INLINE std::uint32_t* append(std::uint32_t* out, const std::uint32_t* from, unsigned mask) {
  const __m256i order = _mm256_cvtepu8_epi32(
      _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&set_bits_of_byte.positions[mask])));
  const __m256i numbers = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(numbers, order));
  return out + __builtin_popcount(mask);
}

#else

template <class At>
BERNAL_INLINE Ints every_fourth(At at, int k) {
  return Ints(sphere(at(k)));
}
BERNAL_INLINE void store_every_fourth(SoftSphere* to, Ints four) { store(to, __m128i(four)); }

BERNAL_INLINE Floats root(Floats v) { return Floats(_mm_sqrt_ps(__m128(v))); }
BERNAL_INLINE Ints to_ints(Floats v) { return Ints(_mm_cvtps_epi32(__m128(v))); }
BERNAL_INLINE unsigned mask_of(Ints v) { return static_cast<unsigned>(_mm_movemask_ps(__m128(v))); }

BERNAL_INLINE std::uint32_t* append(std::uint32_t* out, const std::uint32_t* from, unsigned mask) {
  for (int l = 0; l < width; ++l) {
    *out = from[l];
    out += mask >> l & 1;
  }
  return out;
}

#endif

BERNAL_INLINE Floats to_floats(Ints v) { return __builtin_convertvector(v, Floats); }

/// Of every four numbers of a and b two each from the one at `first` on, by turns.
template <int first, int... k>
BERNAL_INLINE Ints by_turns(Ints a, Ints b, std::integer_sequence<int, k...>) {
  return __builtin_shufflevector(a, b, (k / 4 * 4 + first + k % 4 / 2 + k % 2 * width)...);
}

/// Four registers of spheres, transposed: x, y, z and r of all, or these back to spheres.
struct Four {
  Ints a, b, c, d;
};
BERNAL_INLINE Four transposed(const Four& v) {
  constexpr std::make_integer_sequence<int, width> all;
  const Ints ac_low = by_turns<0>(v.a, v.c, all), ac_high = by_turns<2>(v.a, v.c, all),
             bd_low = by_turns<0>(v.b, v.d, all), bd_high = by_turns<2>(v.b, v.d, all);
  return {by_turns<0>(ac_low, bd_low, all), by_turns<2>(ac_low, bd_low, all),
          by_turns<0>(ac_high, bd_high, all), by_turns<2>(ac_high, bd_high, all)};
}

/// Spheres *at(0), …, *at(width - 1).
template <class At>
BERNAL_INLINE Columns load(At at) {
  const Four v =
      transposed({every_fourth(at, 0), every_fourth(at, 1), every_fourth(at, 2), every_fourth(at, 3)});
  return {v.a, v.b, v.c, Floats(v.d)};
}
BERNAL_INLINE void store(SoftSphere* to, const Columns& s) {
  const Four v = transposed({s.x, s.y, s.z, Ints(s.r)});
  store_every_fourth(to, v.a);
  store_every_fourth(to + 1, v.b);
  store_every_fourth(to + 2, v.c);
  store_every_fourth(to + 3, v.d);
}

// Coordinates wrap round on purpose, which signed integers may not.
using Unsigned = unsigned __attribute__((vector_size(4 * width)));
BERNAL_INLINE Ints wrapped_sum(Ints a, Ints b) { return Ints(Unsigned(a) + Unsigned(b)); }
BERNAL_INLINE Ints wrapped_difference(Ints a, Ints b) { return Ints(Unsigned(a) - Unsigned(b)); }

BERNAL_INLINE Floats all(float value) { return Floats{} + value; }
/// The values where the condition (0 or -1) holds, 0 elsewhere.
BERNAL_INLINE Floats where(Ints condition, Floats values) { return Floats(Ints(values) & condition); }

// `width` numbers, wherever they begin.
BERNAL_INLINE Ints ints_at(const void* from) { return *static_cast<const UnalignedInts*>(from); }
BERNAL_INLINE Floats floats_at(const float* from) { return *reinterpret_cast<const UnalignedFloats*>(from); }
BERNAL_INLINE void store(void* to, Ints v) { *static_cast<UnalignedInts*>(to) = v; }
BERNAL_INLINE void store(float* to, Floats v) { *reinterpret_cast<UnalignedFloats*>(to) = v; }

/// Without contacts omega / contacts is infinite, and the sums are 0.
BERNAL_INLINE Floats step_of(const SweepTask& task, Floats contacts) {
  const Floats step = task.omega / contacts;
  return step < 1.0f ? step : all(1);
}

/// The distance along an axis to the image on the other side of the box, from that to the nearest.
BERNAL_INLINE Floats across(Floats d, Floats edge) {
  const Ints sign = Ints(d) & std::numeric_limits<int>::min();
  return d - Floats(Ints(edge) | sign);
}

/// A coordinate on an axis that ends at walls, after a step: it does not wrap round, and keeps this distance
/// from both ends; that of no sphere is NaN and counts as none.
BERNAL_INLINE Ints between_walls(Ints from, Floats step, Floats distance) {
  const Floats longest = all(0x1p30f), farthest = all(most_from_wall);
  const Floats capped = step < longest ? (step > -longest ? step : -longest) : longest;
  const Ints way = to_ints(capped);
  const Ints is_down = way < 0;
  const Unsigned x = Unsigned(from), length = Unsigned(is_down ? -way : way);
  const Unsigned room = is_down ? x : ~x;
  const Unsigned moved = length < room ? length : room;
  const Unsigned to = is_down ? x - moved : x + moved;
  const Floats kept = distance < farthest ? distance : where(distance >= farthest, farthest);
  const Unsigned lowest = Unsigned(to_ints(kept)) + 1;
  const Unsigned highest = -lowest;
  const Unsigned above = to < lowest ? lowest : to;
  return Ints(above > highest ? highest : above);
}

template <bool measure, bool narrow, class Index>
float sweep_groups(const SweepTask& task, const NeighborRows<Index>* groups, std::size_t begin,
                   std::size_t end) {
  const Floats scale_x = all(task.scale[0]), scale_y = all(task.scale[1]), scale_z = all(task.scale[2]);
  const Floats inverse_x = 1 / scale_x, inverse_y = 1 / scale_y, inverse_z = 1 / scale_z;
  const Floats edge_x = scale_x * 0x1p32f, edge_y = scale_y * 0x1p32f, edge_z = scale_z * 0x1p32f;
  float shortest = std::numeric_limits<float>::max();
  for (std::size_t k = 0; k < 3; ++k)
    if (task.narrow_axes >> k & 1) shortest = std::min(shortest, task.scale[k] * 0x1p32f);
  const Floats half = all(0.5f * shortest);
  const float from_wall = above_rounding * task.wall_share;
  Floats worst{};
  WallPush at_wall;
  for (std::size_t g = begin; g < end; ++g) {
    const bool near_wall = task.walls && task.walls->near(g);
    SoftSphere* const group = task.spheres + lanes * (g - task.first_group);
    if (near_wall) task.walls->push(g, group, at_wall);
    const Index* const rows = groups[g - task.first_group].first;
    const Index* const rows_end = rows + lanes * groups[g - task.first_group].rows;
    for (std::size_t first = 0; first < lanes; first += width) {
      SoftSphere* const mine = group + first;
      const Columns me = load([&](int k) BERNAL_INLINE_LAMBDA { return mine + k; });
      Floats sum_x{}, sum_y{}, sum_z{}, contacts{}, squares{}, force{};
      if (near_wall) {
        sum_x = floats_at(at_wall.x.data() + first);
        sum_y = floats_at(at_wall.y.data() + first);
        sum_z = floats_at(at_wall.z.data() + first);
        contacts = floats_at(at_wall.contacts.data() + first);
        if constexpr (measure) {
          squares = floats_at(at_wall.squares.data() + first);
          force = floats_at(at_wall.depth.data() + first);
          const Floats ratio = floats_at(at_wall.worst.data() + first);
          worst = ratio > worst ? ratio : worst;
        }
      }
      for (const Index* places = rows + first; places < rows_end; places += lanes) {
        const Columns it = load([&](int k) BERNAL_INLINE_LAMBDA { return task.spheres + places[k]; });
        const Floats reach = me.r + it.r;
        const auto meet = [&](Floats dx, Floats dy, Floats dz) BERNAL_INLINE_LAMBDA {
          const Floats d = root((dx * dx + dy * dy) + dz * dz);
          const Ints overlap = (d < reach) & (d > 0.0f);
          const Floats depth = reach - d;
          const Floats shared = (it.r + it.r) / (reach * d);
          const Floats weight = where(overlap, shared * d);
          const Floats push = where(overlap, shared * depth);
          sum_x += push * dx;
          sum_y += push * dy;
          sum_z += push * dz;
          contacts += weight;
          if constexpr (measure) {
            const Floats ratio = where(overlap, depth / reach);
            worst = ratio > worst ? ratio : worst;
            squares += ratio * ratio;
            force += where(overlap, weight * depth);
          }
          return overlap;
        };
        const Floats dx = to_floats(wrapped_difference(me.x, it.x)) * scale_x;
        const Floats dy = to_floats(wrapped_difference(me.y, it.y)) * scale_y;
        const Floats dz = to_floats(wrapped_difference(me.z, it.z)) * scale_z;
        const Ints overlap = meet(dx, dy, dz);
        if constexpr (narrow) {
          if (mask_of(overlap & (reach > half)) == 0) continue;
          for (unsigned sides = 1; sides < 8; ++sides)
            if ((sides & ~task.narrow_axes) == 0)
              meet(sides & 1 ? across(dx, edge_x) : dx, sides & 2 ? across(dy, edge_y) : dy,
                   sides & 4 ? across(dz, edge_z) : dz);
        }
      }
      const Floats step = step_of(task, contacts);
      const auto moved = [&](Ints x, Floats sum, Floats inverse, unsigned axis) BERNAL_INLINE_LAMBDA {
        const Floats way = sum * step * inverse;
        if (task.walled_axes >> axis & 1) return between_walls(x, way, me.r * from_wall * inverse);
        return wrapped_sum(x, to_ints(way));
      };
      store(mine, {moved(me.x, sum_x, inverse_x, 0), moved(me.y, sum_y, inverse_y, 1),
                   moved(me.z, sum_z, inverse_z, 2), me.r});
      if constexpr (measure) {
        if (task.squeeze) {
          store(task.squeeze + lanes * g + first, squares);
          store(task.force + lanes * g + first, force * me.r);
        }
      }
    }
    if (near_wall) task.walls->guard(g, at_wall, group);
  }
  float largest = 0;
  for (int l = 0; l < width; ++l) largest = worst[l] > largest ? worst[l] : largest;
  return largest;
}

/// Spheres of one size in a cube without walls, in units of the coordinates.
template <class Index>
void sweep_alike(const SweepTask& task, const NeighborRows<Index>* groups, std::size_t begin,
                 std::size_t end) {
  const Floats diameter = all(task.diameter);
  for (std::size_t g = begin; g < end; ++g) {
    SoftSphere* const group = task.spheres + lanes * (g - task.first_group);
    const Index* const rows = groups[g - task.first_group].first;
    const Index* const rows_end = rows + lanes * groups[g - task.first_group].rows;
    for (std::size_t first = 0; first < lanes; first += width) {
      SoftSphere* const mine = group + first;
      const Columns me = load([&](int k) BERNAL_INLINE_LAMBDA { return mine + k; });
      Floats sum_x{}, sum_y{}, sum_z{}, contacts{};
      for (const Index* places = rows + first; places < rows_end; places += lanes) {
        const Columns it = load([&](int k) BERNAL_INLINE_LAMBDA { return task.spheres + places[k]; });
        const Floats dx = to_floats(wrapped_difference(me.x, it.x));
        const Floats dy = to_floats(wrapped_difference(me.y, it.y));
        const Floats dz = to_floats(wrapped_difference(me.z, it.z));
        const Floats d = root((dx * dx + dy * dy) + dz * dz);
        const Ints overlap = (d < diameter) & (d > 0.0f);
        const Floats push = where(overlap, (diameter - d) / d);
        sum_x += push * dx;
        sum_y += push * dy;
        sum_z += push * dz;
        contacts += where(overlap, all(1));
      }
      const Floats step = step_of(task, contacts);
      store(mine, {wrapped_sum(me.x, to_ints(sum_x * step)), wrapped_sum(me.y, to_ints(sum_y * step)),
                   wrapped_sum(me.z, to_ints(sum_z * step)), me.r});
    }
  }
}

template <class Index>
float sweep(const SweepTask& task, const NeighborRows<Index>* groups, std::size_t begin, std::size_t end) {
  if (task.narrow_axes != 0) return sweep_groups<true, true>(task, groups, begin, end);
  if (task.measure) return sweep_groups<true, false>(task, groups, begin, end);
  if (task.diameter == 0) return sweep_groups<false, false>(task, groups, begin, end);
  sweep_alike(task, groups, begin, end);
  return 0;
}

/// The cells of a level, on one axis, that what lies between `low` and `high` may reach: `count` of them from
/// `first` on, going round where the region does.
struct Cells {
  int first, count;
};

inline Cells cells_near(double low, double high, double reach, int cells, bool wraps) {
  const double first = std::floor(low - reach), last = std::floor(high + reach);
  if (!wraps) {
    const int lowest = first > 0 ? static_cast<int>(first) : 0;
    return {lowest, (last < cells ? static_cast<int>(last) + 1 : cells) - lowest};
  }
  if (last - first + 1 >= cells) return {0, cells};
  return {static_cast<int>(first) + (first < 0 ? cells : 0), static_cast<int>(last - first) + 1};
}

inline std::size_t gather(const SearchTask& of, const SearchPart& part, const Candidates& out) {
  // What is written may be any of these, for all that the compiler knows.
  const SearchTask task = of;
  const Candidates to = out;
  const Floats scale_x = all(task.scale[0]), scale_y = all(task.scale[1]), scale_z = all(task.scale[2]);
  const Ints x = Ints{} + part.origin.x[0], y = Ints{} + part.origin.x[1], z = Ints{} + part.origin.x[2];
  std::size_t count = 0;
  const auto take_run = [&](std::size_t first_cell, std::size_t end_cell) BERNAL_INLINE_LAMBDA {
    const std::uint32_t begin = task.start[first_cell], end = task.start[end_cell];
    for (std::uint32_t p = begin; p < end; p += lanes) {
      for (std::uint32_t q = p; q < p + lanes; q += width) {  // a fixed number: no branch to mispredict
        const std::size_t c = count + (q - begin);
        store(to.x + c, to_floats(wrapped_difference(ints_at(task.x + q), x)) * scale_x);
        store(to.y + c, to_floats(wrapped_difference(ints_at(task.y + q), y)) * scale_y);
        store(to.z + c, to_floats(wrapped_difference(ints_at(task.z + q), z)) * scale_z);
        store(to.r + c, floats_at(task.r + q));
        store(to.places + c, ints_at(task.places + q));
      }
    }
    count += end - begin;
  };

  for (const SoftLevel& level : task.levels) {
    if (level.spheres == 0) continue;
    Cells near[3];
    for (std::size_t k = 0; k < 3; ++k)
      near[k] = cells_near(part.low[k] * level.cells_a_unit[k], part.high[k] * level.cells_a_unit[k],
                           (part.reach + level.largest) * level.cells_a_length[k], level.cells[k],
                           task.region.wraps(k));
    for (int a = 0; a < near[2].count; ++a) {
      const int z_cell = near[2].first + a - (near[2].first + a < level.cells[2] ? 0 : level.cells[2]);
      for (int b = 0; b < near[1].count; ++b) {
        const int y_cell = near[1].first + b - (near[1].first + b < level.cells[1] ? 0 : level.cells[1]);
        const std::size_t row =
            level.first_cell + (static_cast<std::size_t>(z_cell) * level.cells[1] + y_cell) * level.cells[0];
        const int beyond = near[0].first + near[0].count - level.cells[0];  // goes round the box
        take_run(row + near[0].first, row + near[0].first + near[0].count - std::max(0, beyond));
        if (beyond > 0) take_run(row, row + beyond);
      }
    }
  }
  for (std::size_t q = count; q < count + lanes; q += width)
    store(to.r + q, all(std::numeric_limits<float>::quiet_NaN()));
  return count;
}

inline std::uint32_t* search(const SearchTask& task, const SearchPart& part, const Candidates& among,
                             std::size_t count, const SoftSphere& me, std::uint32_t self,
                             std::uint32_t* out) {
  const auto from_origin = [&](std::size_t k) BERNAL_INLINE_LAMBDA {
    return all(static_cast<float>(steps_between(part.origin, me, k)) * task.scale[k]);
  };
  const Floats x = from_origin(0), y = from_origin(1), z = from_origin(2);
  const Floats my_reach = all(me.r + 2 * task.skin);
  const Ints myself = Ints{} + static_cast<int>(self);
  // What is written may be any of these, for all that the compiler knows.
  const Candidates from = among;
  for (std::size_t c = 0; c < count; c += lanes) {
    for (std::size_t q = c; q < c + lanes; q += width) {
      const Floats dx = floats_at(from.x + q) - x;
      const Floats dy = floats_at(from.y + q) - y;
      const Floats dz = floats_at(from.z + q) - z;
      const Floats reach = floats_at(from.r + q) + my_reach;
      const Ints near =
          ((dx * dx + dy * dy) + dz * dz < reach * reach) & (ints_at(from.places + q) != myself);
      out = append(out, from.places + q, mask_of(near));
    }
  }
  return out;
}
