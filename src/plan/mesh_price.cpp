#include "bernal/plan/mesh_price.hpp"

#include <cmath>

#include "bernal/plan/plan.hpp"

namespace bernal {

MeshPrice price_of_mesh(double spheres, double sphere_edge) {
  constexpr double at_contacts = 1150, in_pores = 51;
  constexpr double seconds_each = 22e-6, bytes_each = 900;
  const double each = at_contacts + in_pores / std::pow(sphere_edge, 3);
  const double tetrahedra = spheres * each;
  return {.tetrahedra = tetrahedra, .seconds = seconds_each * tetrahedra, .bytes = bytes_each * tetrahedra};
}

std::optional<MeshPrice> price_of_mesh(const Plan& plan) {
  if (plan.scene.dimension() != 3) return {};
  return price_of_mesh(plan.expected_count);
}

}  // namespace bernal
