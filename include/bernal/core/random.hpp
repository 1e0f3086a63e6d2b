#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A counter-based random engine: Philox4x32-10 (Salmon, Moraes, Dror & Shaw, SC11, 2011).
///
/// The sequence is a pure function of `(seed, stream)`; streams are independent of each other, so that what
/// is drawn is keyed by what it is for and not by which thread draws it. Satisfies
/// UniformRandomBitGenerator with 64-bit results. Portable: the same bits on every machine. Cost: about 6 ns
/// a number.
class Random {
 public:
  using ArchivedAsBytes = void;
  using result_type = std::uint64_t;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  Random(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  result_type operator()() {
    if (next_ == 2) refill();
    return block_[next_++];
  }

  /// Uniform in [0, 1), 53 random bits.
  double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }
  /// Uniform in [a, b); precondition a <= b.
  double uniform(double a, double b) { return a + (b - a) * uniform(); }

 private:
  void refill();

  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  std::array<std::uint64_t, 2> block_{};
  int next_ = 2;
};

/// The streams of one run. `stream(purpose, index)` keys the numbers of one purpose by a 56-bit index.
enum class Stream : std::uint64_t {
  radii = 1,
  insert = 2,
  compress = 3,
  shake = 4,
  refill = 5,
  room = 6,
  relax = 7,
  measure = 8,
  grow = 9,
  fly = 10,
  layers = 11,
  inside = 12,
  test = 255
};
constexpr std::uint64_t stream(Stream purpose, std::uint64_t index = 0) {
  return (static_cast<std::uint64_t>(purpose) << 56) | (index & ((std::uint64_t{1} << 56) - 1));
}

/// A point uniform in the bounds.
template <int D>
Vector<D> uniform_point(Random& random, const Bounds<D>& bounds) {
  Vector<D> p;
  for (int k = 0; k < D; ++k) p[k] = random.uniform(bounds.lower[k], bounds.upper[k]);
  return p;
}

/// A direction uniform on the unit sphere, by rejection from the cube. Expected draws grow as 2^D / (volume
/// of the unit ball): fine up to D = 8.
template <int D>
Vector<D> uniform_direction(Random& random) {
  for (;;) {
    Vector<D> v;
    for (int k = 0; k < D; ++k) v[k] = random.uniform(-1.0, 1.0);
    const double squared = v.squaredNorm();
    if (squared > 1e-6 && squared <= 1.0) return v / std::sqrt(squared);
  }
}

}  // namespace bernal
