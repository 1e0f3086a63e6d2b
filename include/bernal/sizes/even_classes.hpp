#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Deals the sizes of a discrete distribution as evenly as possible: among the first n draws a class comes
/// share·n times, off by at most 1 - c, c = 1 / (2k - 2) for k classes, for every n. So if all share·n are
/// whole, each is met exactly.
///
/// The j-th draw of a class is at the earliest the ⌈(j - 1 + c) / share⌉-th of all, and at the latest the
/// (⌊(j - c) / share⌋ + 1)-th; among the eligible classes the one with the earliest deadline comes first,
/// ties by lot. Source: R. Tijdeman, The chairman assignment problem, Discrete Mathematics 32 (1980) 323,
/// which proves that all deadlines are met. Cost: O(log k) a draw.
class EvenClasses {
 public:
  /// Empty if the distribution is not discrete or has a single size.
  explicit EvenClasses(const SizeDistribution& sizes);

  bool empty() const { return classes_.empty(); }
  /// Precondition: not empty.
  double next(Random& lots);

 private:
  struct Class {
    double radius, share;
    std::uint64_t drawn = 0;
  };
  struct Turn {
    std::uint64_t key, lot;  ///< while waiting, the draw at which it becomes eligible; then its deadline
    std::size_t of;
    bool operator>(const Turn& other) const { return key != other.key ? key > other.key : lot > other.lot; }
  };

  void wait(std::size_t of, Random& lots);

  std::vector<Class> classes_;
  double c_ = 0;
  std::uint64_t draws_ = 0;
  std::vector<Turn> waiting_, ready_;  // heaps, the least first
};

}  // namespace bernal
