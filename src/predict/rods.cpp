#include "predict/rods.hpp"

#include <algorithm>
#include <vector>

namespace bernal::predict {

double covered_fraction(std::span<const double> lengths, double f) {
  // A rod leaves a gap f L, never larger than earlier ones, so these wait in a queue that needs no sorting.
  // Only the rest of a gap that held a rod without growing goes to a heap.
  std::vector<double> queue(2 * lengths.size());
  std::vector<double> heap;
  std::size_t front = 0, back = 0;
  double total_length = lengths.front();
  double total_gap = queue[back++] = f * lengths.front();
  for (const double length : lengths.subspan(1)) {
    const bool from_heap = !heap.empty() && (front == back || heap.front() > queue[front]);
    const double left = f * length;
    double gap;
    if (from_heap) {
      gap = heap.front();
      std::ranges::pop_heap(heap);
      heap.pop_back();
    } else {
      gap = queue[front++];
    }
    double right = gap - (1 + f) * length;
    queue[back++] = left;
    if (right > left) {
      heap.push_back(right);
      std::ranges::push_heap(heap);
    } else {
      queue[back++] = right = left;
    }
    total_gap += left + right - gap;
    total_length += length;
  }
  return total_length / (total_length + total_gap);
}

}  // namespace bernal::predict
