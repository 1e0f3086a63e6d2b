#include "voxels/inside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bernal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 2> nowhere = {infinity, -infinity};

/// The interval where b x² + 2 c x + d <= 0 for b >= 0, with x measured from a point near the answer.
std::array<double, 2> below_zero(double b, double c, double d) {
  if (!(b > 0)) return d <= 0 ? std::array{-infinity, infinity} : nowhere;
  const double discriminant = c * c - b * d;
  if (!(discriminant >= 0)) return nowhere;
  const double root = std::sqrt(discriminant);
  return {(-c - root) / b, (-c + root) / b};
}

struct PlanePoint {
  double y, x;
};

/// The point at height z on the line from p to q, which are on different sides of z: the same doubles for
/// both facets of an edge, which traverse it in opposite directions.
PlanePoint at_height(const Vector<3>& p, const Vector<3>& q, double z) {
  const Vector<3>&lower = p[2] < q[2] ? p : q, &upper = p[2] < q[2] ? q : p;
  const double t = (z - lower[2]) / (upper[2] - lower[2]);
  return {lower[1] + t * (upper[1] - lower[1]), lower[0] + t * (upper[0] - lower[0])};
}

}  // namespace

InsideOfDomain::InsideOfDomain(const Domain& domain, const VoxelGrid& grid) : domain_(domain), grid_(grid) {
  const auto* mesh = std::get_if<Mesh>(&domain);
  if (!mesh) return;
  for (const auto& [i, j, k] : mesh->triangles) {
    const auto [low, high] = std::minmax({mesh->vertices[i][2], mesh->vertices[j][2], mesh->vertices[k][2]});
    heights_.push_back({low, high});
  }
}

std::int64_t InsideOfDomain::row_from(double y) const {
  const std::int64_t n = grid_.count[1];
  const double guess = std::ceil((y - grid_.corner[1]) / grid_.spacing[1] - 0.5);
  auto row = static_cast<std::int64_t>(std::clamp(guess, 0.0, static_cast<double>(n)));
  while (row > 0 && grid_.center(1, row - 1) >= y) --row;
  while (row < n && grid_.center(1, row) < y) ++row;
  return row;
}

void InsideOfDomain::add(std::int64_t row, const Interval& x, std::vector<InsideRun>& out) const {
  if (!(x[0] <= x[1])) return;
  const auto n = static_cast<double>(grid_.count[0]);
  const auto place = [&](double at) { return (at - grid_.corner[0]) / grid_.spacing[0] - 0.5; };
  auto first = static_cast<std::int64_t>(std::clamp(std::ceil(place(x[0])), 0.0, n));
  auto last = static_cast<std::int64_t>(std::clamp(std::floor(place(x[1])), -1.0, n - 1));
  while (first > 0 && grid_.center(0, first - 1) >= x[0]) --first;
  while (first <= last && grid_.center(0, first) < x[0]) ++first;
  while (last + 1 < grid_.count[0] && grid_.center(0, last + 1) <= x[1]) ++last;
  while (last >= first && grid_.center(0, last) > x[1]) --last;
  if (first <= last) out.push_back({row, first, last});
}

InsideOfDomain::Interval InsideOfDomain::interval(const Box& box, double y, double z) const {
  const double at[] = {0, y, z};
  Interval x = {-infinity, infinity};
  for (int k = 0; k < box.dimension(); ++k) {
    if (box.repeats(k)) continue;
    const double lower = box.corner[k], upper = box.corner[k] + box.size[k];
    if (k == 0) {
      x = {lower, upper};
    } else if (!(at[k] >= lower && at[k] <= upper)) {
      return nowhere;
    }
  }
  return x;
}

InsideOfDomain::Interval InsideOfDomain::interval(const Cylinder& cylinder, double y, double z) const {
  const Vector<3> axis = cylinder.axis.stableNormalized(),
                  from(0, y - cylinder.base[1], z - cylinder.base[2]);
  // Points from + x e, with x measured from the base, split into parts along the axis and normal to it.
  const double along = from.dot(axis);
  const Vector<3> across = from - along * axis, step = Vector<3>::UnitX() - axis[0] * axis;
  Interval x = below_zero(step.squaredNorm(), step.dot(across),
                          across.squaredNorm() - cylinder.radius * cylinder.radius);
  if (!cylinder.periodic) {
    if (axis[0] == 0) {
      if (!(along >= 0 && along <= cylinder.height)) return nowhere;
    } else {
      const double one = -along / axis[0], other = (cylinder.height - along) / axis[0];
      x = {std::max(x[0], std::min(one, other)), std::min(x[1], std::max(one, other))};
    }
  }
  return {x[0] + cylinder.base[0], x[1] + cylinder.base[0]};
}

InsideOfDomain::Interval InsideOfDomain::interval(const Sphere& sphere, double y, double z) const {
  const double dy = y - sphere.center[1], dz = z - sphere.center[2];
  const Interval x = below_zero(1, 0, dy * dy + dz * dz - sphere.radius * sphere.radius);
  return {x[0] + sphere.center[0], x[1] + sphere.center[0]};
}

void InsideOfDomain::cross(const Mesh& mesh, double z, std::vector<Crossing>& out) const {
  for (std::size_t t = 0; t < heights_.size(); ++t) {
    if (!(heights_[t][0] <= z && z < heights_[t][1])) continue;
    const auto& corners = mesh.triangles[t];
    PlanePoint ends[2];
    int met = 0;  // of three edges, two have an end at z or below and one above
    for (std::size_t e = 0; e < 3; ++e) {
      const Vector<3>&p = mesh.vertices[corners[e]], &q = mesh.vertices[corners[(e + 1) % 3]];
      if ((p[2] > z) != (q[2] > z)) ends[met++] = at_height(p, q, z);
    }
    if (ends[1].y < ends[0].y) std::swap(ends[0], ends[1]);
    const auto [low, high] = std::minmax(ends[0].x, ends[1].x);
    const std::int64_t end = row_from(ends[1].y);
    for (std::int64_t row = row_from(ends[0].y); row < end; ++row) {
      const double part = (grid_.center(1, row) - ends[0].y) / (ends[1].y - ends[0].y);
      out.push_back({row, std::clamp(ends[0].x + part * (ends[1].x - ends[0].x), low, high)});
    }
  }
}

void InsideOfDomain::cross(const Polygon& polygon, double, std::vector<Crossing>& out) const {
  for (const auto& loop : polygon.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      Vector<2> p = loop[k], q = loop[(k + 1) % loop.size()];
      if (q[1] < p[1]) std::swap(p, q);
      const auto [low, high] = std::minmax(p[0], q[0]);
      const std::int64_t end = row_from(q[1]);
      for (std::int64_t row = row_from(p[1]); row < end; ++row) {
        const double part = (grid_.center(1, row) - p[1]) / (q[1] - p[1]);
        out.push_back({row, std::clamp(p[0] + part * (q[0] - p[0]), low, high)});
      }
    }
  }
}

/// Between two neighbours among all places where the line meets what edges sweep over, the middle tells.
std::vector<InsideOfDomain::Interval> InsideOfDomain::parts(const Revolved& solid, double y, double z) const {
  const Vector<3> axis = solid.axis.stableNormalized(), from(0, y - solid.base[1], z - solid.base[2]);
  const double along = from.dot(axis), slope = axis[0];
  const Vector<3> across = from - along * axis, step = Vector<3>::UnitX() - slope * axis;
  const double pp = across.squaredNorm(), pv = across.dot(step), vv = step.squaredNorm();
  std::vector<double> places;
  solid.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
    const Vector<2> e = b - a;
    if (e[1] == 0) {
      if (slope != 0) places.push_back((a[1] - along) / slope);
      return;
    }
    // r(x) = k + m x on the cone of the edge
    const double rise = e[0] / e[1], k = a[0] + rise * (along - a[1]), m = rise * slope;
    const double qa = vv - m * m, qb = pv - k * m, qc = pp - k * k;
    if (std::abs(qa) <= 1e-14) {
      if (qb != 0) places.push_back(-0.5 * qc / qb);
    } else if (const double discriminant = qb * qb - qa * qc; discriminant >= 0) {
      const double q = -(qb + std::copysign(std::sqrt(discriminant), qb));
      places.push_back(q / qa);
      if (q != 0) places.push_back(qc / q);
    }
  });
  std::ranges::sort(places);
  const auto is_inside = [&](double x) {
    const double r = std::sqrt(std::max(0.0, pp + x * (2 * pv + x * vv))), h = along + x * slope;
    bool odd = false;
    solid.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
      if ((a[1] > h) == (b[1] > h)) return;
      odd ^= r < a[0] + (h - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    });
    return odd;
  };
  std::vector<Interval> found;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    if (!(places[k] < places[k + 1]) || !is_inside(0.5 * (places[k] + places[k + 1]))) continue;
    const double begin = places[k] + solid.base[0], end = places[k + 1] + solid.base[0];
    if (!found.empty() && found.back()[1] == begin)
      found.back()[1] = end;
    else
      found.push_back({begin, end});
  }
  return found;
}

void InsideOfDomain::layer(std::int64_t k, std::vector<InsideRun>& out) const {
  out.clear();
  const double z = grid_.center(2, k);
  std::visit(
      [&](const auto& shape) {
        if constexpr (requires(std::vector<Crossing> & found) { this->cross(shape, z, found); }) {
          std::vector<Crossing> crossings;
          cross(shape, z, crossings);
          std::sort(crossings.begin(), crossings.end());
          for (std::size_t c = 0; c + 1 < crossings.size(); c += 2)
            add(crossings[c].row, {crossings[c].x, crossings[c + 1].x}, out);
        } else if constexpr (requires { this->parts(shape, z, z); }) {
          for (std::int64_t row = 0; row < grid_.count[1]; ++row)
            for (const Interval& part : parts(shape, grid_.center(1, row), z)) add(row, part, out);
        } else {
          for (std::int64_t row = 0; row < grid_.count[1]; ++row)
            add(row, interval(shape, grid_.center(1, row), z), out);
        }
      },
      domain_);
}

}  // namespace bernal
