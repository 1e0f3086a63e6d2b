#include "domain/volume_below.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "domain/ball_below.hpp"
#include "domain/revolved_surface.hpp"
#include "domain/share_of_area.hpp"

namespace bernal {
namespace {

constexpr int sides_of_cylinder = 1024;

/// Of min(z, 0) over a triangle whose corners have the heights a <= b <= c.
double mean_below(double a, double b, double c) {
  if (a >= 0) return 0;
  if (c <= 0) return (a + b + c) / 3;
  if (b >= 0) return a / (a - b) * (a / (a - c)) * a / 3;
  return (a + b + c) / 3 - c / (c - a) * (c / (c - b)) * c / 3;
}

}  // namespace

VolumeBelow::VolumeBelow(const Domain& domain, const Vector<3>& down) : up_(-down) {
  std::visit([this](const auto& shape) { add(shape); }, domain);
  if (const auto* ball = std::get_if<Sphere>(&domain)) {
    radius_ = ball->radius;
    lowest_ = up_.dot(ball->center) - radius_;
    highest_ = lowest_ + 2 * radius_;
    return;
  }
  lowest_ = highest_ = slopes_.empty() ? 0 : slopes_.front().z.front();
  for (const Slope& slope : slopes_) {
    lowest_ = std::min(lowest_, slope.z.front());
    highest_ = std::max(highest_, slope.z.back());
  }
  if (const double whole = between_facets(highest_); whole > 0) scale_ = volume_of(domain) / whole;
}

double VolumeBelow::operator()(double height) const {
  if (!(radius_ > 0)) return scale_ * between_facets(std::clamp(height, lowest_, highest_));
  return ball_below(3, radius_, height - lowest_ - radius_);
}

double VolumeBelow::between_facets(double height) const {
  double volume = 0;
  for (const auto& [area, z] : slopes_)
    volume += area * mean_below(z[0] - height, z[1] - height, z[2] - height);
  return volume;
}

void VolumeBelow::add_triangle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  Slope slope{0.5 * (b - a).cross(c - a).dot(up_), {up_.dot(a), up_.dot(b), up_.dot(c)}};
  std::ranges::sort(slope.z);
  if (slope.area != 0) slopes_.push_back(slope);
}

/// Of what the base sweeps over along an edge; corners run round outward normals, seen along the edge.
void VolumeBelow::add_prism(const std::vector<Vector<3>>& base, const Vector<3>& edge) {
  for (std::size_t k = 0; k < base.size(); ++k) {
    const Vector<3>&a = base[k], &b = base[(k + 1) % base.size()];
    if (k > 0) {
      add_triangle(base[0], b, a);
      add_triangle(base[0] + edge, a + edge, b + edge);
    }
    add_triangle(a, b, b + edge);
    add_triangle(a, b + edge, a + edge);
  }
}

void VolumeBelow::add(const Box& box) {
  const auto [lower, upper] = bounds_of(box);
  const double depth = box.dimension() == 3 ? upper[2] - lower[2] : 1;
  add_prism(
      {lower, {upper[0], lower[1], lower[2]}, {upper[0], upper[1], lower[2]}, {lower[0], upper[1], lower[2]}},
      depth * Vector<3>::UnitZ());
}

void VolumeBelow::add(const Cylinder& cylinder) {
  constexpr double step = 2 * std::numbers::pi / sides_of_cylinder;
  const Vector<3> axis = cylinder.axis.normalized(), across = axis.unitOrthogonal();
  const double radius = cylinder.radius * std::sqrt(step / std::sin(step));  // of the same area
  std::vector<Vector<3>> base;
  for (int k = 0; k < sides_of_cylinder; ++k)
    base.push_back(cylinder.base + radius * std::cos(k * step) * across +
                   radius * std::sin(k * step) * axis.cross(across));
  add_prism(base, cylinder.height * axis);
}

void VolumeBelow::add(const Mesh& mesh) {
  for (const auto& [i, j, k] : mesh.triangles)
    add_triangle(mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]);
}

void VolumeBelow::add(const Revolved& shape) {
  constexpr std::size_t most_sides = 1024, fewest_sides = 64, most_triangles = 32768;
  const std::size_t sides =
      std::clamp(most_triangles / std::max<std::size_t>(1, shape.profile.size()), fewest_sides, most_sides);
  add(surface_of(shape, static_cast<int>(sides), RoundAs::of_same_area));
}

/// As a plate of unit thickness. Of a line that may run either way, the area that it encloses tells the sign.
void VolumeBelow::add(const Polygon& polygon) {
  for (std::size_t loop = 0; loop < polygon.loops.size(); ++loop) {
    const std::size_t first = slopes_.size();
    std::vector<Vector<3>> base;
    for (const Vector<2>& p : polygon.loops[loop]) base.push_back({p[0], p[1], 0});
    add_prism(base, Vector<3>::UnitZ());
    double own = 0;  // about any height
    for (std::size_t k = first; k < slopes_.size(); ++k)
      own += slopes_[k].area * (slopes_[k].z[0] + slopes_[k].z[1] + slopes_[k].z[2]) / 3;
    const bool turned = (own < 0) != (share_of_area(polygon, loop) < 0);
    for (std::size_t k = first; k < slopes_.size(); ++k) slopes_[k].area *= turned ? -1 : 1;
  }
}

}  // namespace bernal
