#include <algorithm>
#include <string>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/domain/domain.hpp"
#include "core/every_dimension.hpp"
#include "domain/without_walls.hpp"

// The periods of domains, and the tilt of boxes.

namespace bernal {

Box periodic_box(const Vector<dynamic>& edges, const std::vector<bool>& walls, const Tilt& tilt) {
  Box box{Vector<dynamic>::Zero(edges.size()), edges, walls, tilt};
  box.periodic.resize(static_cast<std::size_t>(edges.size()), false);
  box.periodic.flip();
  return box;
}

Tilt tilt_in_proportion(const Box& box, const Vector<dynamic>& edges) {
  if (!box.is_tilted() || edges == box.size) return box.tilt;
  const auto carried = [&](std::size_t which, int axis) {
    return box.tilt[which] == 0 ? 0 : box.tilt[which] / box.size[axis] * edges[axis];
  };
  return {carried(0, 0), carried(1, 0), carried(2, 1)};
}

double shortest_period(const Box& box) {
  if (!box.is_tilted()) return box.size.minCoeff();
  return box.dimension() == 2 ? tilted_boundary_of<2>(box).shortest_period()
                              : tilted_boundary_of<3>(box).shortest_period();
}

void require_upright(const Domain& domain, std::string_view what) {
  if (is_tilted(domain))
    throw Error(ErrorCode::bad_argument,
                std::string(what).append(" is known of upright periodic boxes only, and this one is tilted; "
                                         "pack in a box without \"tilt\" for that"));
}

void require_closed_walls(const Domain& domain, std::string_view what) {
  if (is_repeated_mesh(domain))
    throw Error(ErrorCode::bad_argument,
                std::string(what).append(" is not known of a mesh that repeats itself; take \"periodic\" out "
                                         "of the scene, which closes its ends, for that"));
}

/// The periods along the axes, whether the box is tilted or not.
template <int D>
static Boundary<D> periods_along_axes(const Domain& domain) {
  Boundary<D> metric;
  if (const auto* box = std::get_if<Box>(&domain)) {
    for (int k = 0; k < std::min(D, box->dimension()); ++k) {
      if (!box->repeats(k)) continue;
      metric.edges[k] = box->size[k];
      metric.origin[k] = box->corner[k];
    }
  }
  if constexpr (D == 3) {
    const auto* cylinder = std::get_if<Cylinder>(&domain);
    if (cylinder && cylinder->periodic) {
      const int k = cylinder->coordinate_axis();
      metric.edges[k] = cylinder->height;
      metric.origin[k] = bounds_of(domain).lower[k];
    }
    if (is_repeated_mesh(domain)) {
      const Bounds<3> bounds = bounds_of(domain);
      for (int k = 0; k < 3; ++k) {
        if (!std::get<Mesh>(domain).periodic[static_cast<std::size_t>(k)]) continue;
        metric.edges[k] = bounds.upper[k] - bounds.lower[k];
        metric.origin[k] = bounds.lower[k];
      }
    }
  }
  return metric;
}

template <int D>
Boundary<D> boundary_of(const Domain& domain) {
  require_upright(domain, "this");
  return periods_along_axes<D>(domain);
}
template <int D>
TiltedBoundary<D> tilted_boundary_of(const Domain& domain) {
  TiltedBoundary<D> metric = periods_along_axes<D>(domain);
  if (is_tilted(domain)) metric.tilt = std::get<Box>(domain).tilt;
  return metric;
}
#define BERNAL_INSTANTIATE(D)                      \
  template Boundary<D> boundary_of(const Domain&); \
  template TiltedBoundary<D> tilted_boundary_of(const Domain&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

Boundary<3> boundary_in_space(const Domain& domain) {
  if (dimension_of(domain) == 3) return boundary_of<3>(domain);
  const Boundary<2> own = boundary_of<2>(domain);
  Boundary<3> boundary;
  boundary.edges.head<2>() = own.edges;
  boundary.origin.head<2>() = own.origin;
  return boundary;
}

Box without_walls(const Domain& domain) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
  const int dimension = dimension_of(domain);
  Box box{bounds.lower - bounds.size(), 3 * bounds.size(),
          std::vector<bool>(static_cast<std::size_t>(dimension))};
  with_dimension(dimension, EveryDimension{}, [&](auto d) {
    const auto metric = tilted_boundary_of<decltype(d)::value>(domain);
    box.tilt = metric.tilt;
    for (int k = 0; k < dimension; ++k) {
      if (!metric.repeats(k)) continue;
      box.periodic[static_cast<std::size_t>(k)] = true;
      box.corner[k] = metric.origin[k];
      box.size[k] = metric.edges[k];
    }
  });
  return box;
}

void wrap(Spheres<dynamic>& spheres, const Domain& domain) {
  with_dimension(dimension_of(domain), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    const TiltedBoundary<D> boundary = tilted_boundary_of<D>(domain);
    for (std::size_t i = 0; i < spheres.size(); ++i)
      spheres.set_center(i, boundary.wrap(Vector<D>(spheres.center(i))));
  });
}

}  // namespace bernal
