#include "meshes/wall_views.hpp"

#include <cmath>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>

#include "solids/solids.hpp"

namespace bernal {

std::vector<WallSheet> walls_around(const Domain& domain, const Vector<3>& p) {
  std::vector<WallSheet> views;
  if (const auto* box = std::get_if<Box>(&domain)) {
    for (int k = 0; k < 3; ++k) {
      if (box->repeats(k)) continue;
      views.push_back({static_cast<std::uint32_t>(2 * k), -Vector<3>::Unit(k), p[k] - box->corner[k]});
      views.push_back(
          {static_cast<std::uint32_t>(2 * k + 1), Vector<3>::Unit(k), box->corner[k] + box->size[k] - p[k]});
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> a = cylinder->axis.normalized(), d = p - cylinder->base;
    const double z = d.dot(a);
    const Vector<3> across = d - z * a;
    if (across.norm() > 0) views.push_back({0, across.normalized(), cylinder->radius - across.norm()});
    if (!cylinder->periodic) {
      views.push_back({1, -a, z});
      views.push_back({2, a, cylinder->height - z});
    }
  } else if (const auto* sphere = std::get_if<Sphere>(&domain)) {
    const Vector<3> d = p - sphere->center;
    if (d.norm() > 0) views.push_back({0, d.normalized(), sphere->radius - d.norm()});
  }
  return views;
}

double radius_of_wall(const Domain& domain, std::uint32_t wall) {
  if (const auto* sphere = std::get_if<Sphere>(&domain)) return sphere->radius;
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  return cylinder != nullptr && wall == 0u ? cylinder->radius : 0;
}

double rise_of_wall(const Domain& domain, std::uint32_t wall, double radius) {
  const double of_wall = radius_of_wall(domain, wall);
  return of_wall > 0 ? radius * radius / (of_wall + std::sqrt(of_wall * of_wall - radius * radius)) : 0;
}

Vector<3> across_wall(const Domain& domain, const Vector<3>& axis) {
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  return cylinder != nullptr ? cylinder->axis.normalized().cross(axis) : Vector<3>(Vector<3>::Zero());
}

double rise_at_wall(const Domain& domain, std::uint32_t wall, const Vector<3>& axis,
                    const Vector<3>& beside) {
  if (!(radius_of_wall(domain, wall) > 0)) return 0;
  const bool is_ball = std::holds_alternative<Sphere>(domain);
  return rise_of_wall(domain, wall, is_ball ? beside.norm() : beside.dot(across_wall(domain, axis)));
}

namespace {

/// The integral of the rise of a round wall over a disc. Of a cylinder of radius R that of R - sqrt(R² - x²),
/// by Gauss and Chebyshev's rule.
double rise_over_disc(const Domain& domain, std::uint32_t wall, double radius) {
  const double of_wall = radius_of_wall(domain, wall), squared = radius * radius;
  if (std::holds_alternative<Sphere>(domain)) {
    const double rise = rise_of_wall(domain, wall, radius);
    return std::numbers::pi * squared * rise - cap_volume(of_wall, rise);
  }
  constexpr int nodes = 48;
  double sum = 0;
  for (int k = 1; k <= nodes; ++k) {
    const double t = std::numbers::pi * k / (nodes + 1), x = radius * std::cos(t), s = std::sin(t);
    sum += s * s * (x * x / (of_wall + std::sqrt(of_wall * of_wall - x * x)));
  }
  return 2 * squared * std::numbers::pi / (nodes + 1) * sum;
}

}  // namespace

double volume_before_wall(const Domain& domain, std::uint32_t wall, const NeckShape& shape) {
  if (!(radius_of_wall(domain, wall) > 0)) return 0;
  if (!shape.is_fillet()) return rise_over_disc(domain, wall, shape.radius);
  using Rule = boost::math::quadrature::gauss<double, 30>;
  const auto [from, to] = shape.turns();
  return Rule::integrate(
             [&](double turn) {
               const double radius = shape.spine() - shape.tube * std::cos(turn);
               return rise_over_disc(domain, wall, radius) * shape.tube * std::cos(turn);
             },
             from, to) /
         (shape.end - shape.begin);
}

}  // namespace bernal
