#include "solids/near_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ranges>

namespace bernal {
namespace {

/// The lowest cap and the least distance at an edge, given the outward normals of its faces. Where the edge
/// pierces the sphere, the circles in the faces cross at 22 degrees or half the angle of the edge: where the
/// centre lies half way between the faces, and the edge at the distance s from it, cos a = (1 - 2 c² + s² c²)
/// / (1 - s² c²) with the sine c of half the edge's angle. Where the sphere ends before the edge, its two
/// circles are as far from each other as at a right angle.
std::array<double, 2> limits_at_edge(const Vector<3>& normal, const Vector<3>& other) {
  constexpr double widest = 22 * std::numbers::pi / 180, farthest = 5;
  const double angle = std::acos(std::clamp(-normal.dot(other), -1.0, 1.0));
  const double c2 = 0.5 * (1 - std::cos(angle)), cosine = std::cos(std::min(widest, 0.5 * angle));
  const double s2 = (2 * c2 - 1 + cosine) / (c2 * (1 + cosine));
  constexpr double rounding = 1e-9;  // a right angle is none to rounding
  const double farther = 2 * c2 > 1 - rounding ? 1 : std::min(farthest, 1 / std::sqrt(2 * c2));
  return {std::max(NearFaces::least_cap, 1 - std::sqrt(std::max(0.0, s2))),
          farther * NearFaces::least_distance};
}

}  // namespace

NearFaces::NearFaces(const Bounds<3>& box, const Vector<3>& p) {
  // Of each axis: a face at its lower end, at its upper end, or none.
  for (int which = 1; which < 27; ++which) {
    double square = 0;
    int faces = 0;
    bool is_beside = true;  // whether the nearest point of the plane, line or corner lies on the box
    for (int k = 0, rest = which; k < 3; ++k, rest /= 3) {
      const double at = rest % 3 == 1 ? box.lower[k] : box.upper[k];
      if (rest % 3 == 0) {
        is_beside = is_beside && p[k] >= box.lower[k] && p[k] <= box.upper[k];
      } else {
        square += (p[k] - at) * (p[k] - at);
        ++faces;
      }
    }
    if (is_beside && std::isfinite(square)) features_.push_back({std::sqrt(square), faces == 1});
  }
}

NearFaces::NearFaces(const ConvexPart& part, const Vector<3>& p) {
  for (const ConvexPart::Face& face : part.faces) {
    const double above = face.keeps.normal.dot(p) - face.keeps.offset;
    if (face.holds(p - above * face.keeps.normal, part)) features_.push_back({std::abs(above), true});
  }
  const auto add = [&](const Vector<3>& d, const std::array<double, 2>& limits) {
    features_.push_back({std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), false, limits[0], limits[1]});
  };
  for (const ConvexPart::Edge& edge : part.edges) {
    const Vector<3>&a = part.corners[edge.corners[0]].point, &b = part.corners[edge.corners[1]].point;
    const double along = (p - a).dot(edge.along);
    if (along >= 0 && along <= (b - a).dot(edge.along))
      add(p - a - along * edge.along,
          limits_at_edge(part.faces[edge.faces[0]].keeps.normal, part.faces[edge.faces[1]].keeps.normal));
  }
  for (const ConvexPart::Corner& corner : part.corners) add(p - corner.point, {least_cap, least_distance});
}

double NearFaces::clear_radius(double radius, double gap, double share) const {
  for (bool changed = true; changed;) {
    changed = false;
    for (const Feature& feature : features_) {
      const double of = feature.is_face ? share : 1;
      const double nearest = std::max(gap, of * feature.nearest), lowest = std::max(gap, of * feature.lowest);
      if (!(feature.distance - radius < nearest * radius && radius - feature.distance < lowest * radius))
        continue;
      // Where rounding says that it is still too near it goes on by roundoffs.
      radius = std::nextafter(std::min(radius, feature.distance / (1 + nearest)), 0.0);
      changed = true;
    }
  }
  return radius;
}

bool NearFaces::clear(double& radius, std::span<double> layers, double gap, double share) const {
  double left = 1;
  const auto make_smaller = [&](double& r) {
    const double smaller = clear_radius(left * r, gap, share);
    left = smaller / r;
    r = smaller;
  };
  make_smaller(radius);
  for (double& layer : std::views::reverse(layers)) make_smaller(layer);
  return left < 1;
}

void clear_of_ends(Solids& solids, double gap, const std::vector<WallFoot>& feet) {
  const bool has_gaps = shrinks(solids.contacts.treatment);
  const double share = has_gaps ? 1 : 1.0 / 3;
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  Bounds<3> ends{Vector<3>::Constant(-unlimited), Vector<3>::Constant(unlimited)};
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k)) {
      ends.lower[k] = boundary.origin[k];
      ends.upper[k] = boundary.origin[k] + boundary.edges[k];
    }
  for (std::size_t i = 0; i < solids.spheres.size(); ++i) {
    if (std::ranges::binary_search(feet, i, {}, &WallFoot::sphere)) continue;
    const double packed = solids.spheres.r[i];
    solids.cleared += NearFaces(ends, Vector<3>(solids.spheres.center(i)))
                          .clear(solids.spheres.r[i], solids.shells.of(i), has_gaps ? gap : 0, share);
    solids.contacts.largest_change =
        std::max(solids.contacts.largest_change, 1 - solids.spheres.r[i] / packed);
  }
  solids.contacts.volume_after = volume_of_balls(solids.spheres);
}

}  // namespace bernal
