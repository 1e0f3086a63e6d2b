#pragma once
#include <cstdint>
#include <limits>

#include "bernal/verify/certificate.hpp"
#include "verify/bounded.hpp"
#include "verify/exact.hpp"

namespace bernal::verify {

/// What has been decided so far. Merging is associative and commutative: sums of counts, and extremes with
/// ties broken by index. So any order of any number of threads gives the same tally.
struct Tally {
  std::uint64_t pairs = 0;
  std::uint64_t walls = 0;
  std::uint64_t centers = 0;
  std::uint64_t decided_double = 0;
  std::uint64_t decided_exact = 0;
  std::uint64_t overlapping = 0;
  std::uint64_t protruding = 0;

  /// first <= second; none yet while the ratio is -infinity.
  std::uint64_t worst_pair[2] = {0, 0};
  double max_overlap = -std::numeric_limits<double>::infinity();
  /// None yet while the ratio is +infinity.
  std::uint64_t worst_wall = 0;
  double min_wall_gap = std::numeric_limits<double>::infinity();

  void add_pair_ratio(std::uint64_t first, std::uint64_t second, double overlap);
  void add_wall_ratio(std::uint64_t sphere, double gap);
  Tally& operator+=(const Tally& other);
};

/// Evaluates a predicate, `template <class Number> Truth` or `Sign`, first in Bounded (unless `arithmetic` is
/// exact), then in Exact where that is not certain, and counts which of the two decided.
template <class Predicate>
auto decide(Arithmetic arithmetic, Tally& tally, const Predicate& predicate) {
  if (arithmetic == Arithmetic::filtered) {
    const auto answer = predicate.template operator()<Bounded>();
    if (answer != decltype(answer)::unknown) {
      ++tally.decided_double;
      return answer;
    }
  }
  ++tally.decided_exact;
  return predicate.template operator()<Exact>();
}

/// A ratio that was computed in double, with the sign that was decided exactly: not negative if `holds`,
/// negative otherwise. Rounding can be wrong about the sign only within a few roundoffs of zero.
double with_sign(double ratio, bool holds);

}  // namespace bernal::verify
