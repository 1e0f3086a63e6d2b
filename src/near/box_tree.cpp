#include "near/box_tree.hpp"

#include <algorithm>
#include <numeric>

#include "core/every_dimension.hpp"
#include "core/parallel.hpp"

namespace bernal {

template <int D>
BoxTree<D>::BoxTree(const std::vector<Bounds<D>>& boxes, std::uint32_t leaf) {
  std::vector<Vector<D>> lower, upper;
  for (const Bounds<D>& box : boxes) {
    lower.push_back(box.lower);
    upper.push_back(box.upper);
  }
  build(lower, upper, {}, leaf);
}

template <int D>
BoxTree<D>::BoxTree(const std::vector<Vector<D>>& points, std::span<const double> sizes, std::uint32_t leaf) {
  build(points, points, sizes, leaf);
}

template <int D>
void BoxTree<D>::build(std::span<const Vector<D>> lower, std::span<const Vector<D>> upper,
                       std::span<const double> sizes, std::uint32_t leaf) {
  const std::size_t items = lower.size();
  if (items == 0) return;
  order_.resize(items);
  std::iota(order_.begin(), order_.end(), Id{0});
  const auto node_of = [&](std::uint32_t first, std::uint32_t last) {
    Node made{.bounds = {lower[order_[first]], upper[order_[first]]}, .first = first, .last = last};
    for (std::uint32_t k = first; k < last; ++k) {
      const Id id = order_[k];
      made.bounds.lower = made.bounds.lower.cwiseMin(lower[id]);
      made.bounds.upper = made.bounds.upper.cwiseMax(upper[id]);
      if (!sizes.empty()) made.largest = std::max(made.largest, sizes[id]);
    }
    return made;
  };
  nodes_.push_back(node_of(0, static_cast<std::uint32_t>(items)));
  // Those of a depth at once, one after the other in the array.
  for (std::size_t first = 0, last = 1; first < last; first = last, last = nodes_.size()) {
    std::size_t count = last;
    for (std::size_t k = first; k < last; ++k)
      if (nodes_[k].size() > leaf) nodes_[k].children = static_cast<std::uint32_t>((count += 2) - 2);
    nodes_.resize(count);
    parallel_for(first, last, [&](std::size_t k) {
      const Node& parent = nodes_[k];
      if (parent.children == 0) return;
      int axis = 0;
      parent.bounds.size().maxCoeff(&axis);
      const std::uint32_t middle = parent.first + parent.size() / 2;
      const auto at = [&](Id id) { return std::pair(lower[id][axis] + upper[id][axis], id); };
      std::nth_element(order_.begin() + parent.first, order_.begin() + middle, order_.begin() + parent.last,
                       [&](Id a, Id b) { return at(a) < at(b); });
      nodes_[parent.children] = node_of(parent.first, middle);
      nodes_[parent.children + 1] = node_of(middle, parent.last);
    });
  }
}

#define BERNAL_INSTANTIATE(D) template class BoxTree<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
