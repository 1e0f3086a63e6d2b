#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "bench/pricing/arithmetic.hpp"
#include "bernal/cad/mesh_container.hpp"

#include <fmt/format.h>

namespace bernal::pricing {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Coordinates that are multiples of this, and sums and differences of them, are doubles.
constexpr double grain = 0x1p-24;

/// Vectors of integers whose lengths are integers.
constexpr std::array<std::array<int, 4>, 5> whole = {
    {{1, 2, 2, 3}, {2, -3, 6, 7}, {-6, 2, 3, 7}, {4, 4, -7, 9}, {-1, 8, 4, 9}}};
/// Across the axis (2, 1, 2) of the cylinder; each of length 3.
const std::array<Vector<3>, 2> ways_across = {Vector<3>{1, 2, -2}, Vector<3>{2, -2, -1}};

const Box box_shape{Vector<3>(-1, -0.75, -0.5), Vector<3>(2, 1.5, 1.25)};
const Cylinder cylinder_shape{{-0.75, -0.25, -0.5}, {2, 1, 2}, 0.75, 1.5};
/// Solids of revolution about the axis of the cylinder. The wall of the cone rises by 4 on 3.
Revolved about_the_axis(std::vector<Vector<2>> profile) {
  return {cylinder_shape.base, cylinder_shape.axis, std::move(profile)};
}
const Revolved cone_shape = about_the_axis({{0, 0}, {0.25, 0}, {1.375, 1.5}, {0, 1.5}});
const Revolved tube_shape = about_the_axis({{0.25, 0}, {0.75, 0}, {0.75, 1.5}, {0.25, 1.5}});
const Revolved hopper_shape = about_the_axis({{0, 0}, {0.25, 0}, {0.75, 0.25}, {0.75, 1.5}, {0, 1.5}});
const Sphere sphere_shape{{0.125, -0.25, 0.5}, 63.0 / 64};  // a multiple of 3, 7 and 9 of a grain

/// The cube from -1 to 1, each face cut into n x n squares of two triangles, the upper one wavy.
Mesh wavy_cube(int n) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      Vector<3> v;
      for (int k = 0; k < 3; ++k) v[k] = 2.0 * at[static_cast<std::size_t>(k)] / n - 1;
      if (at[2] == n)
        v[2] += 0.1 * (1 + std::sin(3 * std::numbers::pi * v[0]) * std::sin(2 * std::numbers::pi * v[1]));
      mesh.vertices.push_back(v);
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = upper ? n : 0;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (upper) {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          }
        }
      }
    }
  }
  return mesh;
}

PricedContainer price_container(std::string name, Domain shape) {
  PricedContainer priced;
  priced.name = std::move(name);
  priced.shape = std::move(shape);
  const Bounds<3> bounds = bounds_of(priced.shape);
  const double largest = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
  priced.ulp = std::nextafter(largest, unbounded) - largest;
  for (std::size_t level = 0; level < level_count; ++level)
    priced.at[level] = make_container(priced.shape, static_cast<WallArithmetic>(level), priced.ulp);
  if (const auto* mesh = std::get_if<Mesh>(&priced.shape)) priced.triangles = mesh->triangles.size();
  return priced;
}

double on_grain(double x) { return std::round(x / grain) * grain; }

double few_doubles_off(double x, Random& random) {
  for (double k = std::floor(random.uniform(-2, 3)); k != 0; k -= std::copysign(1, k))
    x = std::nextafter(x, k > 0 ? unbounded : 0);
  return x;
}

Vector<3> place_inside(const Container& container, Random& random) {
  constexpr double least = 1e-3;
  for (;;) {
    const Vector<3> c = uniform_point<3>(random, container.bounds());
    if (container.clearance_within(c, 2 * least) > least) return c;
  }
}

const std::array<int, 4>& whole_vector(Random& random) {
  return whole[static_cast<std::size_t>(random.uniform() * whole.size())];
}
/// The middle of the axis, at the height of 0.75.
Vector<3> middle_of_axis() { return cylinder_shape.base + 0.25 * cylinder_shape.axis; }
/// Such that a point 3 s from the middle of the axis is a multiple of the grain from the wall of the cone.
double toward_slope(double s) { return grain * (5 * std::floor(s / (5 * grain)) + 1); }
double distance_from_slope(double s) { return (3.25 - 12 * s) / 5; }
const Vector<3>& vector_across(Random& random) { return ways_across[random.uniform() < 0.5 ? 0 : 1]; }

/// A ball that touches exactly.
Query touching(const PricedContainer& priced, Random& random) {
  Query q;
  if (std::holds_alternative<Sphere>(priced.shape)) {
    const auto& [x, y, z, length] = whole_vector(random);
    const double s = on_grain(random.uniform(0.02, 0.1));
    q.c = sphere_shape.center + s * Vector<3>(x, y, z);
    q.r = sphere_shape.radius - length * s;
  } else if (std::holds_alternative<Cylinder>(priced.shape)) {
    const double s = on_grain(random.uniform(0.12, 0.22));
    q.c = middle_of_axis() + s * vector_across(random);
    q.r = cylinder_shape.radius - 3 * s;
  } else if (priced.name == "cone") {
    const double s = toward_slope(random.uniform(0.02, 0.12));
    q.c = middle_of_axis() + s * vector_across(random);
    q.r = distance_from_slope(s);
  } else if (std::holds_alternative<Revolved>(priced.shape)) {
    const double s = on_grain(random.uniform(0.12, 0.22)), inner = priced.name == "tube" ? 3 * s - 0.25 : 1;
    q.c = middle_of_axis() + s * vector_across(random);
    q.r = std::min(cylinder_shape.radius - 3 * s, inner);
  } else if (priced.is_mesh()) {
    q.r = on_grain(random.uniform(0.01, 0.4));
    q.c = {on_grain(random.uniform(-0.5, 0.5)), on_grain(random.uniform(-0.5, 0.5)), q.r - 1};
  } else {
    q.c = place_inside(priced.exact(), random).unaryExpr(&on_grain);
    q.r = priced.exact().clearance(q.c);  // a difference of two multiples of the grain
  }
  return q;
}

}  // namespace

std::string_view name_of_level(std::size_t level) {
  constexpr std::string_view names[] = {"double", "filtered", "exact"};
  return names[level];
}

std::vector<PricedContainer> containers_to_price(std::uint64_t largest) {
  std::vector<PricedContainer> all;
  all.push_back(price_container("box", box_shape));
  all.push_back(price_container("cylinder", cylinder_shape));
  all.push_back(price_container("sphere", sphere_shape));
  all.push_back(price_container("cone", cone_shape));
  all.push_back(price_container("tube", tube_shape));
  all.push_back(price_container("hopper", hopper_shape));
  double triangles = 100;
  for (int power = 2; triangles <= static_cast<double>(largest); ++power, triangles *= 10)
    all.push_back(price_container(fmt::format("mesh 1e{}", power),
                                  wavy_cube(static_cast<int>(std::round(std::sqrt(triangles / 12))))));
  return all;
}

Query query_of_place(const PricedContainer& priced, Population population, Random& random) {
  if (population == Population::tie) return touching(priced, random);
  const Container& container = priced.exact();
  Query q;
  q.c = place_inside(container, random);
  q.r = container.clearance(q.c);
  if (population == Population::anywhere) q.r *= random.uniform(0.8, 1.2);
  if (population == Population::near) q.r *= 1 + 1e-12 * random.uniform(-1, 1);
  if (population == Population::nearest) q.r = few_doubles_off(q.r, random);
  return q;
}

Query query_of_centre(const PricedContainer& priced, Population population, Random& random) {
  Query q;
  const Container& container = priced.exact();
  if (population == Population::anywhere) {
    const Bounds<3> bounds = container.bounds();
    q.c = bounds.center() + 1.1 * (uniform_point<3>(random, bounds) - bounds.center());
    return q;
  }
  if (population == Population::tie) {
    if (std::holds_alternative<Sphere>(priced.shape)) {
      const auto& [x, y, z, length] = whole_vector(random);
      q.c = sphere_shape.center + sphere_shape.radius / length * Vector<3>(x, y, z);
    } else if (priced.name == "cone") {  // on its floor
      q.c = cylinder_shape.base + on_grain(random.uniform(0.01, 0.08)) * vector_across(random);
    } else if (!priced.is_mesh() && !std::holds_alternative<Box>(priced.shape)) {
      q.c = cylinder_shape.base + on_grain(random.uniform(0.1, 0.49)) * cylinder_shape.axis +
            cylinder_shape.radius / 3 * vector_across(random);
    } else {
      q.c = place_inside(container, random);
      q.c[2] = container.bounds().lower[2];
    }
    return q;
  }
  const Query touching_ball = query_of_place(priced, Population::nearest, random);
  std::vector<NearFacet> near;
  container.facets_near(touching_ball.c, 1.1 * touching_ball.r, near);
  q.c = closest_point(near.front().facet, touching_ball.c);
  if (population == Population::near)
    q.c += 1e-12 * random.uniform(-1, 1) / touching_ball.r * (touching_ball.c - q.c);
  else
    for (double& x : q.c) x = few_doubles_off(x, random);
  return q;
}

Query query_of_way(const PricedContainer& priced, Population population, Random& random) {
  if (population == Population::tie) {
    Query q = touching(priced, random);
    q.limit = on_grain(random.uniform(0.05, 0.2));
    if (random.uniform() < 0.5) {  // it rests, and leaves, slides or presses
      q.direction = uniform_direction<3>(random);
      return q;
    }
    // It ends in contact exactly where its way does.
    if (std::holds_alternative<Sphere>(priced.shape)) {
      const auto& [x, y, z, length] = whole_vector(random);
      q.c = sphere_shape.center;
      q.direction = Vector<3>(x, y, z);
      q.limit /= 8;
      q.r = sphere_shape.radius - length * q.limit;
    } else if (priced.name == "cone") {
      q.c = middle_of_axis();
      q.direction = vector_across(random);
      q.limit = toward_slope(q.limit);
      q.r = distance_from_slope(q.limit);
    } else if (!priced.is_mesh() && !std::holds_alternative<Box>(priced.shape)) {
      // In a tube it starts between the walls.
      const bool is_tube = priced.name == "tube";
      const double start = is_tube ? 10. / 64 : 0;
      q.direction = vector_across(random);
      q.c = middle_of_axis() + start * q.direction;
      if (is_tube) q.limit = on_grain(random.uniform(0.03, 0.06));
      q.r = cylinder_shape.radius - 3 * (start + q.limit);
    } else {
      q.c[2] = priced.exact().bounds().lower[2] + 0.25;
      q.direction = {0, 0, -1};
      q.r = 0.25 - q.limit;
      if (!priced.is_mesh()) q.c.head<2>().setZero();
    }
    return q;
  }
  Query q = query_of_place(priced, Population::nearest, random);
  const double clearance = q.r;
  q.r *= random.uniform(0.2, 0.9);
  q.direction = random.uniform(0.5, 2) * uniform_direction<3>(random);
  q.limit = random.uniform(0, 2) * clearance;
  if (population == Population::anywhere) return q;
  const auto filtered = static_cast<std::size_t>(WallArithmetic::filtered);
  q.limit = priced.at[filtered]->free_path(q.c, q.r, q.direction, 8);
  q.limit = population == Population::near ? q.limit * (1 + 1e-12 * random.uniform(-1, 1))
                                           : few_doubles_off(q.limit, random);
  return q;
}

}  // namespace bernal::pricing
