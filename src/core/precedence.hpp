#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace bernal {

/// Pieces of work of which some wait for others. Made once, for many rounds.
class Precedence {
 public:
  Precedence() = default;
  /// Of `pieces`, for pairs (earlier, later). Precondition: no circle. Cost: O(pieces + pairs).
  Precedence(std::size_t pieces, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs);

  std::size_t size() const { return waits_for_.size(); }
  /// How many others this one waits for, and those that wait for it.
  std::uint32_t waits_for(std::size_t piece) const { return waits_for_[piece]; }
  std::span<const std::uint32_t> waiting(std::size_t piece) const {
    return std::span(waiting_).subspan(first_[piece], first_[piece + 1] - first_[piece]);
  }

 private:
  std::vector<std::uint32_t> waits_for_, waiting_;
  std::vector<std::size_t> first_;
};

/// Calls body(k) for every piece, once all that it waits for have returned.
void parallel_by_precedence(const Precedence&, const std::function<void(std::size_t piece)>& body);

}  // namespace bernal
