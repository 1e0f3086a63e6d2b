#include "measure/cell_in_container.hpp"

#include <algorithm>

#include "bernal/cad/mesh_container.hpp"
#include "domain/revolved_surface.hpp"
#include "measure/round_walls.hpp"

namespace bernal {

static_assert(std::variant_size_v<Domain> == 6, "trim and volume below need the walls of the new container");

namespace {

/// Of a solid of revolution: off by 1e-4 of its radius.
constexpr int sides_around = 256;

Domain flat_sided(const Domain& domain) {
  const auto* revolved = std::get_if<Revolved>(&domain);
  return revolved ? Domain(surface_of(*revolved, sides_around, RoundAs::of_same_area)) : domain;
}

}  // namespace

CellInContainer::CellInContainer(const Domain& domain, const Container& container)
    : domain_(domain),
      flat_sided_(std::holds_alternative<Revolved>(domain)
                      ? make_container(flat_sided(domain), WallArithmetic::plain, container.resolution())
                      : nullptr),
      container_(flat_sided_ ? *flat_sided_ : container) {
  require_closed_walls(domain, "a cell");
  if (is_faceted(domain)) polygons_.emplace(flat_sided(domain), container_);
}

void CellInContainer::trim(ConvexCell& cell, const Vector<3>& center) const {
  if (const auto* cylinder = std::get_if<Cylinder>(&domain_)) cut_behind(cell, center, *cylinder);
  if (const auto* sphere = std::get_if<Sphere>(&domain_)) cut_behind(cell, center, *sphere);
}

double CellInContainer::volume(const ConvexCell& cell, const Vector<3>& center) const {
  if (const auto* cylinder = std::get_if<Cylinder>(&domain_)) return volume_inside(cell, center, *cylinder);
  if (const auto* sphere = std::get_if<Sphere>(&domain_)) return volume_inside(cell, center, *sphere);
  return volume_between_facets(cell, center);
}

double CellInContainer::volume_between_facets(const ConvexCell& cell, const Vector<3>& center) const {
  if (cell.empty() || !(cell.volume() > 0)) return 0;
  const auto place = [&](Vector<3> p) {
    p += center;
    if (container_.dimension() == 2) p[2] = 0;
    return p;
  };
  const auto corners = cell.corners();
  Vector<3> mean = Vector<3>::Zero();
  for (const Vector<3>& corner : corners) mean += corner;
  const Vector<3> apex = place(mean / static_cast<double>(corners.size()));
  double farthest = 0;
  for (const Vector<3>& corner : corners) farthest = std::max(farthest, (place(corner) - apex).norm());
  const double clearance = container_.clearance_within(apex, 2 * farthest);
  if (clearance >= farthest) return cell.volume();
  if (clearance <= -farthest) return 0;
  return polygons_->volume_inside(cell, center);
}

}  // namespace bernal
