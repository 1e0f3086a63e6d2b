#include "solids/cut_out.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "solids/near_faces.hpp"

namespace bernal {
namespace {

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
    refuse_cut(fmt::format("‹cut› takes parts of packings in boxes, cylinders and spheres, not in a {}",
                           name_of(domain)));
  }
  return least;
}

void require_within(const Domain& domain, const ConvexPart& part) {
  const double rounding = 1e-6 * part.bounds().diagonal();  // more than that of coordinates in files
  for (const ConvexPart::Corner& corner : part.corners)
    if (const Vector<3>& p = corner.point; depth_in(domain, p) < -rounding)
      refuse_cut(fmt::format("the part of ‹cut› reaches out of the container at ({:.6g}, {:.6g}, {:.6g})",
                             p[0], p[1], p[2]));
}

/// A part that repeats a period more often than anybody means.
void require_fewer_than_too_many(const Solids& whole, const ConvexPart& part) {
  constexpr double most = 1e7;
  const double count =
      static_cast<double>(whole.spheres.size()) * volume_of(part.domain()) / volume_of(whole.domain);
  if (count > most)
    refuse_cut(
        fmt::format("the part of ‹cut› is {:.6g} wide and would hold about {:.0g} spheres, images of "
                    "the {} in the period; is its unit right?",
                    part.bounds().size().maxCoeff(), count, whole.spheres.size()));
}

/// Calls visit(centre) for the images of a ball, in a domain that may repeat itself, of which periods let
/// some reach into the bounds; without periods for the ball.
template <class Visit>
void for_each_image_in(const Bounds<3>& bounds, const Boundary<3>& boundary, const Vector<3>& center,
                       double r, const Visit& visit) {
  std::array<int, 3> first{}, last{};
  for (int k = 0; k < 3; ++k) {
    if (!boundary.repeats(k)) continue;
    const auto at = static_cast<std::size_t>(k);
    first[at] = static_cast<int>(std::ceil((bounds.lower[k] - r - center[k]) / boundary.edges[k]));
    last[at] = static_cast<int>(std::floor((bounds.upper[k] + r - center[k]) / boundary.edges[k]));
  }
  for (int x = first[0]; x <= last[0]; ++x)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int z = first[2]; z <= last[2]; ++z)
        visit(Vector<3>(center + Vector<3>(x, y, z).cwiseProduct(boundary.edges)));
}

}  // namespace

double volume_in(const ConvexPart& part, const Spheres<dynamic>& spheres, const Domain& domain) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  const Bounds<3> bounds = part.bounds();
  double volume = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for_each_image_in(bounds, boundary, spheres.center(i), spheres.r[i], [&](const Vector<3>& image) {
      if (const auto piece = piece_in(part, image, spheres.r[i])) volume += volume_of(*piece);
    });
  return volume;
}

CutOut cut_out(const Solids& whole, const ConvexPart& part, double gap) {
  require_within(whole.domain, part);
  require_fewer_than_too_many(whole, part);
  const Bounds<3> bounds = part.bounds();
  if (joins(whole.contacts.treatment) || whole.contacts.treatment == ContactTreatment::cap)
    refuse_cut("‹cut› takes contact gap or shrink: bridges and caps are not cut");
  CutOut made{.solids = {.spheres = Spheres<dynamic>(3),
                         .domain = part.domain(),
                         .pieces = {},
                         .bridges = {},
                         .contacts = whole.contacts},
              .of_packing = {}};
  Solids& solids = made.solids;
  solids.bridge_radius = whole.bridge_radius;
  solids.part = part;
  if (!whole.shells.first.empty()) solids.shells.first.push_back(0);
  const Boundary<3> boundary = boundary_of<3>(whole.domain);
  double filled = 0;
  for (std::uint32_t i = 0; i < whole.spheres.size(); ++i) {
    const Vector<3> center(whole.spheres.center(i));
    const double r = whole.spheres.r[i];
    for_each_image_in(bounds, boundary, center, r, [&](const Vector<3>& image) {
      const double height = part.height(image);
      if (!(height < r) || !(part.distance(image) < r)) return;
      double radius = r;
      const std::span<const double> within = whole.shells.of(i);
      std::vector<double> layers(within.begin(), within.end());
      if (height > -2 * r) solids.cleared += NearFaces(part, image).clear(radius, layers, gap);
      std::optional<Piece> piece = piece_in(part, image, radius);
      if (!piece) return;
      filled += volume_of(*piece);
      piece->sphere = static_cast<std::uint32_t>(solids.spheres.size());
      solids.pieces.push_back(std::move(*piece));
      solids.spheres.push_back(image, radius);
      made.of_packing.push_back(i);
      if (solids.shells.first.empty()) return;
      solids.shells.radius.insert(solids.shells.radius.end(), layers.begin(), layers.end());
      solids.shells.first.push_back(solids.shells.radius.size());
    });
  }
  constexpr double rounding = 1e-9;
  if (!(filled < (1 - rounding) * volume_of(solids.domain)))
    refuse_cut("the part of ‹cut› lies within one sphere: there is nothing between spheres to mesh");
  return made;
}

}  // namespace bernal
