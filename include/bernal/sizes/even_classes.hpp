#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The sizes of a distribution that has only classes, in an order in which each comes as often as its share
/// says: among the first n draws share·n times, off by at most 1 - c, c = 1 / (2k - 2) for k classes, for
/// every n. So of n shares that are whole each is exactly met.
///
/// The j-th draw of a class may be the ⌈(j - 1 + c) / share⌉-th of all or a later one, and is at last the
/// (⌊(j - c) / share⌋ + 1)-th; of those that may come the one that is due first comes, by lot where several
/// are. Source: R. Tijdeman, The chairman assignment problem, Discrete Mathematics 32 (1980) 323, which
/// proves that nothing is ever overdue. Cost: O(log k) a draw.
class EvenClasses {
 public:
  /// Of a distribution with other sizes, or with one alone, there are none.
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
    std::uint64_t key, lot;  ///< from when on it may come; once it may, by when it has to
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
