#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "bernal/verify/certificate.hpp"
#include "verify/bounded.hpp"
#include "verify/exact.hpp"

namespace bernal::verify {

inline bool worse(const Certificate::Overlap& a, const Certificate::Overlap& b) {
  return std::tuple(-a.ratio, a.pair) < std::tuple(-b.ratio, b.pair);
}
inline bool worse(const Certificate::Protrusion& a, const Certificate::Protrusion& b) {
  return std::tuple(a.gap, a.sphere) < std::tuple(b.gap, b.sphere);
}

/// The worst `limit` items added, independent of the order of adding. Cost: O(1) an item; memory twice the
/// limit.
template <class Item>
class WorstOf {
 public:
  explicit WorstOf(std::size_t limit) : limit_(limit) {}

  void add(const Item& item) {
    if (limit_ == 0) return;
    items_.push_back(item);
    if (items_.size() / 2 >= limit_) trim();
  }
  void add(const WorstOf& other) {
    for (const Item& item : other.items_) add(item);
  }
  std::vector<Item> sorted() && {
    trim();
    std::sort(items_.begin(), items_.end(), before);
    return std::move(items_);
  }

 private:
  static bool before(const Item& a, const Item& b) { return worse(a, b); }
  void trim() {
    if (items_.size() <= limit_) return;
    const auto end = items_.begin() + static_cast<std::ptrdiff_t>(limit_);
    std::nth_element(items_.begin(), end, items_.end(), before);
    items_.resize(limit_);
  }

  std::size_t limit_;
  std::vector<Item> items_;
};

/// The number of predicates decided by each arithmetic.
struct Decisions {
  std::uint64_t by_double = 0;
  std::uint64_t by_exact = 0;
};

/// The decisions so far. Merging is associative and commutative: sums of counts, and extremes with ties
/// broken by index. So the tally does not depend on the threads.
struct Tally {
  std::uint64_t pairs = 0;
  std::uint64_t walls = 0;
  std::uint64_t centers = 0;
  Decisions decisions;
  std::uint64_t overlapping = 0;
  std::uint64_t protruding = 0;

  /// None yet if the ratio is -infinity, or the gap +infinity.
  Certificate::Overlap worst_pair = {{0, 0}, -std::numeric_limits<double>::infinity()};
  Certificate::Protrusion worst_wall = {0, std::numeric_limits<double>::infinity()};
  WorstOf<Certificate::Overlap> overlaps;
  WorstOf<Certificate::Protrusion> protrusions;
  /// Between the surfaces of near balls, and of a ball and a near wall.
  double least_distance = std::numeric_limits<double>::infinity();
  double least_wall_distance = std::numeric_limits<double>::infinity();

  /// `list`: the most items of either list.
  explicit Tally(std::size_t list) : overlaps(list), protrusions(list) {}

  /// Adds a near pair; `clear`: it overlaps no more than allowed.
  void add_pair(const Certificate::Overlap& pair, bool clear);
  /// Adds a pair that is not near and may be the closest all the same. `gap_ratio` is not negative.
  void add_distant_pair(std::uint64_t first, std::uint64_t second, double gap_ratio);
  /// Adds a ball; its gap is infinite where no wall is near enough for the smallest.
  void add_ball(const Certificate::Protrusion& ball, bool inside);
  Tally& operator+=(const Tally& other);
};

/// Evaluates a predicate, `template <class Number> Truth` or `Sign`, first in Bounded (unless `arithmetic` is
/// exact), then in Exact if that is not certain, and counts which of the two decided.
template <class Predicate>
auto decide(Arithmetic arithmetic, Decisions& decisions, const Predicate& predicate) {
  if (arithmetic == Arithmetic::filtered) {
    const auto answer = predicate.template operator()<Bounded>();
    if (answer != decltype(answer)::unknown) {
      ++decisions.by_double;
      return answer;
    }
  }
  ++decisions.by_exact;
  return predicate.template operator()<Exact>();
}

/// A ratio computed in double, with the exactly decided sign: not negative if `holds`, else negative.
/// Rounding can be wrong about the sign only within a few roundoffs of zero.
double with_sign(double ratio, bool holds);

/// A distance computed in double, moved to the exactly decided side of a limit.
inline double on_side_of(double limit, double distance, bool holds) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return holds ? std::max(distance, limit) : std::min(distance, std::nextafter(limit, -infinity));
}

/// If a gap is requested, distances up to twice that are examined, so that the least is known; for walls, up
/// to the other gap as well.
inline double distances_known_up_to(double gap) { return 2 * gap; }
inline double wall_distances_known_up_to(const CertifyOptions& options) {
  return std::max(options.gap, 2 * options.wall_gap);
}

}  // namespace bernal::verify
