#include "run/exact_place.hpp"

#include <cmath>
#include <limits>

#include "bernal/cad/mesh_container.hpp"

namespace bernal {

std::optional<Vector<3>> ExactPlace::near(const Vector<3>& place, double r) {
  if (!of_scene_) {
    const Frame none{.resolution = frame_.resolution * frame_.scale};
    const bool plain =
        plan_.scene.walls == WallArithmetic::plain;  // of which a place that touches has no use
    of_scene_ =
        make_container(plan_.domain, plain ? WallArithmetic::filtered : plan_.scene.walls, none.resolution);
  }
  // Of corners that are no doubles, those of the container are off by less than two spacings an axis.
  const auto* mesh = std::get_if<Mesh>(&plan_.domain);
  const double off = mesh && mesh->exact ? 4 * frame_.resolution * frame_.scale : 0;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vector<3> middle = bounds_of(plan_.domain).center(), at = frame_.to_scene(place);
  const double in_the_middle_within = 1e-9 * frame_.scale + 4 * frame_.resolution * frame_.scale;
  for (const bool in_the_middle : {false, true}) {
    for (int n = 0; n < 27; ++n) {
      Vector<3> p = at;
      for (int k = 0, step = n; k < plan_.scene.dimension(); ++k, step /= 3) {
        if (in_the_middle && std::abs(p[k] - middle[k]) < in_the_middle_within) p[k] = middle[k];
        if (step % 3 > 0) p[k] = std::nextafter(p[k], step % 3 == 1 ? infinity : -infinity);
      }
      const Vector<3> local = frame_.to_local(p);
      if (frame_.to_scene(local) == p && of_scene_->contains(p, frame_.scale * r + off)) return local;
    }
  }
  return {};
}

}  // namespace bernal
