#include "verify/space.hpp"

#include <cmath>
#include <variant>

#include "bernal/core/error.hpp"
#include "verify/repeated_wall.hpp"

namespace bernal::verify {
Vector<dynamic> periods_of(const Domain& domain) {
  const int dimension = dimension_of(domain);
  Vector<dynamic> periods = Vector<dynamic>::Constant(dimension, Box<1>::infinity);
  const auto repeat = [&](int axis, double period) {
    require(std::isfinite(period) && period > 0, "what repeats itself needs a positive finite period");
    periods[axis] = period;
  };
  if (const auto* box = std::get_if<bernal::Box>(&domain)) {
    require(!box->is_tilted(), "a tilted box has no periods along its axes");
    require(box->corner.size() == dimension, "a box needs a corner and a size of one dimension");
    require(box->periodic.empty() || box->periodic.size() == static_cast<std::size_t>(dimension),
            "a box repeats itself or ends on each of its axes");
    for (int k = 0; k < dimension; ++k)
      if (box->repeats(k)) repeat(k, box->size[k]);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&domain); cylinder && cylinder->periodic) {
    const int axis = cylinder->coordinate_axis();
    require(axis >= 0, "a cylinder that repeats itself needs an axis along x, y or z");
    repeat(axis, cylinder->height);
  }
  if (const auto* mesh = std::get_if<Mesh>(&domain); mesh && mesh->repeats())
    for (int k = 0; k < 3; ++k)
      if (mesh->periodic[static_cast<std::size_t>(k)]) repeat(k, period_of(*mesh, k));
  return periods;
}

}  // namespace bernal::verify
