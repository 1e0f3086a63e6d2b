#include "near/sphere_tree.hpp"

#include <algorithm>
#include <array>

#include "core/every_dimension.hpp"

namespace bernal {
namespace {

constexpr std::uint32_t spheres_a_leaf = 8;

template <int D>
std::vector<Vector<D>> shifts_of(const Boundary<D>& boundary) {
  std::vector<Vector<D>> shifts = {Vector<D>::Zero()};
  std::array<int, D> at;
  for (int k = 0; k < D; ++k) at[k] = boundary.repeats(k) ? -1 : 0;
  const std::array<int, D> lowest = at;
  for (int k = 0; k < D;) {
    Vector<D> shift;
    for (int axis = 0; axis < D; ++axis) shift[axis] = at[axis] * boundary.edges[axis];
    if (!shift.isZero(0)) shifts.push_back(shift);
    for (k = 0; k < D && (!boundary.repeats(k) || ++at[k] > 1); ++k) at[k] = lowest[k];
  }
  return shifts;
}

}  // namespace

template <int D>
SphereTree<D>::SphereTree(const Spheres<D>& spheres, const Boundary<D>& boundary)
    : boundary_(boundary), shifts_(shifts_of(boundary)) {
  std::vector<Vector<D>> wrapped;
  wrapped.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) wrapped.push_back(boundary.wrap(spheres.center(i)));
  tree_ = BoxTree<D>(wrapped, spheres.r, spheres_a_leaf);
  for (const std::uint32_t id : tree_.order()) {
    centers_.push_back(wrapped[id]);
    radii_.push_back(spheres.r[id]);
  }
}

template <int D>
typename SphereTree<D>::Found SphereTree<D>::nearest(const Vector<D>& p) const {
  Found found;
  const Vector<D> in_period = boundary_.wrap(p);
  for (const Vector<D>& shift : shifts_) {
    const Vector<D> moved = in_period - shift;
    tree_.for_each_leaf_below(
        found.gap,
        [&](const Node& node) { return std::sqrt(squared_distance(node.bounds, moved)) - node.largest; },
        [&](const Node& node) {
          for (std::uint32_t k = node.first; k < node.last; ++k) {
            const double gap = std::sqrt((moved - centers_[k]).squaredNorm()) - radii_[k];
            if (gap < found.gap) found = {k, centers_[k] + shift, gap};
          }
        });
  }
  found.center += p - in_period;
  return found;
}

template <int D>
double SphereTree<D>::entry(const Node& node, const Vector<D>& p, double r, const Vector<D>& u,
                            double limit) {
  const double reach = r + node.largest;
  double first = 0, last = limit;
  for (int k = 0; k < D; ++k) {
    const double to_lower = node.bounds.lower[k] - reach - p[k],
                 to_upper = node.bounds.upper[k] + reach - p[k];
    if (u[k] == 0) {
      if (to_lower > 0 || to_upper < 0) return infinity;
      continue;
    }
    const auto [near, far] = std::minmax({to_lower / u[k], to_upper / u[k]});
    first = std::max(first, near);
    last = std::min(last, far);
  }
  return first <= last ? first : infinity;
}

#define BERNAL_INSTANTIATE(D) template class SphereTree<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
