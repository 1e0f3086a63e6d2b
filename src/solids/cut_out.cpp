#include "solids/cut_out.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "voxels/ball_in_cells.hpp"

namespace bernal {
namespace {

/// The lowest cap that a face of the box cuts off or leaves, in radii: lower ones end in too sharp an edge.
constexpr double least_cap = 0.03;

[[noreturn]] void refuse_cut(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

/// How far a point is inside of the container's walls; the least over all.
double depth_in(const Domain& domain, const Vector<3>& p) {
  double least = std::numeric_limits<double>::infinity();
  if (const auto* box = std::get_if<Box>(&domain)) {
    for (int k = 0; k < 3; ++k)
      if (!box->repeats(k))
        least = std::min({least, p[k] - box->corner[k], box->corner[k] + box->size[k] - p[k]});
  } else if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> axis = cylinder->axis.normalized(), d = p - cylinder->base;
    const double z = d.dot(axis);
    least = cylinder->radius - (d - z * axis).norm();
    if (!cylinder->periodic) least = std::min({least, z, cylinder->height - z});
  } else if (const auto* sphere = std::get_if<Sphere>(&domain)) {
    least = sphere->radius - (p - sphere->center).norm();
  } else {
    refuse_cut(
        fmt::format("‹cut› takes a part of boxes, cylinders and spheres, not of a {}", name_of(domain)));
  }
  return least;
}

void require_within(const Domain& domain, const Bounds<3>& box) {
  if (!((box.upper - box.lower).minCoeff() > 0)) refuse_cut("the box of ‹cut› holds nothing");
  const double rounding = 1e-9 * (box.upper - box.lower).norm();
  for (int corner = 0; corner < 8; ++corner) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) p[k] = (corner >> k & 1) != 0 ? box.upper[k] : box.lower[k];
    if (depth_in(domain, p) < -rounding)
      refuse_cut(fmt::format("the box of ‹cut› reaches out of the container at ({:.6g}, {:.6g}, {:.6g})",
                             p[0], p[1], p[2]));
  }
}

/// Distances of the faces, edges and corners of a box from a point.
std::vector<double> distances_of(const Bounds<3>& box, const Vector<3>& p) {
  // Of each axis: a face at its lower end, at its upper end, or none.
  std::vector<double> squares;
  for (int which = 1; which < 27; ++which) {
    double square = 0;
    bool is_beside = true;  // whether the nearest point of the plane, line or corner lies on the box
    for (int k = 0, rest = which; k < 3; ++k, rest /= 3) {
      const double at = rest % 3 == 1 ? box.lower[k] : box.upper[k];
      if (rest % 3 == 0) {
        is_beside = is_beside && p[k] >= box.lower[k] && p[k] <= box.upper[k];
      } else {
        square += (p[k] - at) * (p[k] - at);
      }
    }
    if (is_beside) squares.push_back(std::sqrt(square));
  }
  return squares;
}

/// The radius with which a sphere is well off all that it nearly touches, or that cut less than a cap of the
/// height `lowest` off, in radii.
double radius_clear_of(const std::vector<double>& distances, double radius, double gap, double lowest) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const double distance : distances)
      if (distance - radius < gap * radius && radius - distance < lowest * radius) {
        radius = std::nextafter(distance / (1 + gap), 0.0);
        changed = true;
      }
  }
  return radius;
}

double distance_to(const Bounds<3>& box, const Vector<3>& p) {
  return (p - p.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

}  // namespace

std::optional<Piece> piece_in_box(const Vector<3>& center, double radius, const Bounds<3>& box) {
  if (!(distance_to(box, center) < radius)) return {};
  Piece piece{.center = center, .radius = radius};
  for (int k = 0; k < 3; ++k) {
    if (center[k] - radius < box.lower[k])
      piece.cuts.push_back({{-Vector<3>::Unit(k), -box.lower[k]}, 2 * k});
    if (center[k] + radius > box.upper[k])
      piece.cuts.push_back({{Vector<3>::Unit(k), box.upper[k]}, 2 * k + 1});
  }
  return piece;
}

double volume_in_box(const Vector<3>& center, double radius, const Bounds<3>& box) {
  BallInCells ball;
  double volume = 0;
  for (int k = 0; k < 3; ++k)
    ball.planes[static_cast<std::size_t>(k)] = {(box.lower[k] - center[k]) / radius,
                                                (box.upper[k] - center[k]) / radius};
  const double cube = radius * radius * radius;
  ball.add(cube, (box.upper - box.lower).prod(), &volume, 1, 1);
  return volume;
}

CutOut cut_out(const Solids& whole, const Bounds<3>& given, double gap) {
  require_within(whole.domain, given);
  // The upper faces where the corner and the size of the box say that they are.
  const Box box{.corner = given.lower, .size = given.upper - given.lower};
  const Bounds<3> bounds{.lower = box.corner, .upper = box.corner + box.size};
  if (joins(whole.contacts.treatment) || whole.contacts.treatment == ContactTreatment::cap)
    refuse_cut("‹cut› takes contact gap or shrink: bridges and caps are not cut");
  CutOut made{.solids = {.spheres = Spheres<dynamic>(3),
                         .domain = box,
                         .pieces = {},
                         .bridges = {},
                         .contacts = whole.contacts},
              .of_packing = {}};
  Solids& solids = made.solids;
  solids.bridge_radius = whole.bridge_radius;
  solids.is_cut = true;
  if (!whole.shells.first.empty()) solids.shells.first.push_back(0);
  const Boundary<3> boundary = boundary_of<3>(whole.domain);
  for (std::uint32_t i = 0; i < whole.spheres.size(); ++i) {
    const Vector<3> center(whole.spheres.center(i));
    const double r = whole.spheres.r[i];
    std::array<int, 3> first{}, last{};
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const auto at = static_cast<std::size_t>(k);
      first[at] = static_cast<int>(std::ceil((bounds.lower[k] - r - center[k]) / boundary.edges[k]));
      last[at] = static_cast<int>(std::floor((bounds.upper[k] + r - center[k]) / boundary.edges[k]));
    }
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z) {
          const Vector<3> image = center + Vector<3>(x, y, z).cwiseProduct(boundary.edges);
          if (!(distance_to(bounds, image) < r)) continue;
          const std::vector<double> distances = distances_of(bounds, image);
          const double radius = radius_clear_of(distances, r, gap, std::max(gap, least_cap));
          made.shrunk += radius < r;
          std::optional<Piece> piece = piece_in_box(image, radius, bounds);
          if (!piece) continue;
          piece->sphere = static_cast<std::uint32_t>(solids.spheres.size());
          solids.pieces.push_back(std::move(*piece));
          solids.spheres.push_back(image, radius);
          made.of_packing.push_back(i);
          if (solids.shells.first.empty()) continue;
          for (const double shell : whole.shells.of(i))
            solids.shells.radius.push_back(radius_clear_of(distances, shell * radius / r, gap, gap));
          solids.shells.first.push_back(solids.shells.radius.size());
        }
  }
  return made;
}

}  // namespace bernal
