#include "work/places.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

constexpr double cells_wanted = 30000;

}  // namespace

Places::Places(const Container& container) {
  const Bounds<3> bounds = container.bounds();
  const double edge = std::cbrt(bounds.volume() / cells_wanted);
  std::array<int, 3> count;
  for (int k = 0; k < 3; ++k) {
    count[k] = static_cast<int>(std::clamp(std::ceil(bounds.size()[k] / edge), 1.0, cells_wanted));
    cell_size_[k] = bounds.size()[k] / count[k];
  }
  const double half_diagonal = 0.5 * cell_size_.norm();
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      for (int k = 0; k < count[2]; ++k) {
        const Vector<3> lower = bounds.lower + cell_size_.cwiseProduct(Vector<3>(i, j, k));
        if (container.clearance(lower + 0.5 * cell_size_) >= -1.001 * half_diagonal) cells_.push_back(lower);
      }
    }
  }
}

Vector<3> Places::draw(Random& random) const {
  const auto cell = static_cast<std::size_t>(random.uniform() * static_cast<double>(cells_.size()));
  const Vector<3>& lower = cells_[cell];
  return uniform_point(random, Bounds<3>{lower, lower + cell_size_});
}

}  // namespace bernal
