#include "bernal/plan/mesh_price.hpp"

#include <cmath>

#include "bernal/plan/plan.hpp"

namespace bernal {

MeshPrice price_of_mesh(double spheres, double sphere_edge) {
  constexpr double at_contacts = 1150, in_pores = 51, tetrahedra_a_triangle = 2.7;
  constexpr double seconds_each = 24e-6, bytes_in_mesher = 900, bytes_beside = 110;
  // Of what is filled in sections, see TetrahedraOptions, parts are filled twice.
  constexpr double most_triangles = 1e6, filled_twice = 1.65, held_twice = 1.1;
  const double each = at_contacts + in_pores / std::pow(sphere_edge, 3);
  const double tetrahedra = spheres * each,
               sections = std::ceil(tetrahedra / tetrahedra_a_triangle / most_triangles);
  const bool is_cut = sections > 1;
  const double held = is_cut ? held_twice * tetrahedra / std::max(3.0, sections) : tetrahedra;
  return {.tetrahedra = tetrahedra,
          .seconds = seconds_each * tetrahedra * (is_cut ? filled_twice : 1),
          .bytes = bytes_in_mesher * held + bytes_beside * tetrahedra};
}

std::optional<MeshPrice> price_of_mesh(const Plan& plan) {
  if (plan.scene.dimension() != 3 || is_tilted(plan.domain) || is_repeated_mesh(plan.domain)) return {};
  return price_of_mesh(plan.expected_count);
}

}  // namespace bernal
