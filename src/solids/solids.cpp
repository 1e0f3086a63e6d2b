#include "solids/solids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "measure/touching.hpp"
#include "near/point_grid.hpp"
#include "solids/near_faces.hpp"
#include "verify/exact.hpp"

namespace bernal {
namespace {

/// A cap of a sphere, in its own frame: the part beyond normal·p = depth.
struct Cap {
  Vector<3> normal;
  double depth;
};

/// Two near spheres, with the direction to the second.
struct Bond {
  std::uint32_t first, second;
  Vector<3> direction;  ///< unit
  double distance;      ///< of the centres
  double gap;           ///< ratio
};

std::vector<Bond> bonds_of(const Spheres<dynamic>& spheres, const Domain& domain, double gap) {
  std::vector<Bond> bonds;
  for (const NearBond& near : near_bonds(spheres, domain, gap))
    bonds.push_back({near.first, near.second, near.displacement.normalized(),
                     (1 + near.gap) * (spheres.r[near.first] + spheres.r[near.second]), near.gap});
  return bonds;
}

double angle_between(const Vector<3>& a, const Vector<3>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The number of pairs of circles on one sphere that meet; a circle is given by the direction of its centre
/// and its angular radius.
struct Circle {
  Vector<3> direction;
  double angle;
};
std::size_t meetings_on(const std::vector<std::vector<Circle>>& circles) {
  std::size_t meetings = 0;
  for (const std::vector<Circle>& of_sphere : circles)
    for (std::size_t a = 0; a < of_sphere.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        meetings += angle_between(of_sphere[a].direction, of_sphere[b].direction) <=
                    of_sphere[a].angle + of_sphere[b].angle;
  return meetings;
}

double roundings_at(const Spheres<dynamic>& spheres, std::uint32_t i) {
  return 64 * tolerance::roundoff * (spheres.center(i).norm() + spheres.r[i]);
}

/// Caps at walls. Round walls are nearer beside the nearest point: then the cap is deeper.
void add_wall_caps(const Spheres<dynamic>& spheres, const Domain& domain, double gap,
                   std::vector<std::vector<Cap>>& caps, ContactReport& report) {
  if (!has_walls(domain)) return;
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, nullptr);
  std::vector<WallPoint> points;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i], left = gap * r;
    const Vector<3> c = spheres.center(i);
    points.clear();
    container->walls_near(frame.to_local(c), (1 + gap) * r / frame.scale, points);
    // What is beside a nearer point of the same flat wall, or behind that wall, its cap cuts off, too.
    std::vector<const WallPoint*> taken;
    for (const WallPoint& point : points) {
      if (std::ranges::any_of(taken, [&](const WallPoint* nearer) {
            return (nearer->point - point.point).dot(nearer->inward) >= -8 * tolerance::roundoff;
          }))
        continue;
      taken.push_back(&point);
      const Vector<3> outward = -point.inward, across = outward.unitOrthogonal();
      double depth = point.clearance * frame.scale - left - roundings_at(spheres, i);
      constexpr int rounds = 20, rim_points = 48;
      for (int round = 0; round < rounds; ++round) {
        const double rim = std::sqrt(std::max(0.0, r * r - depth * depth));
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = 0; k < rim_points; ++k) {
          const Vector<3> beside =
              Eigen::AngleAxisd(2 * std::numbers::pi * k / rim_points, outward) * across * rim;
          nearest = std::min(
              nearest, frame.scale * container->clearance(frame.to_local(c + depth * outward + beside)));
        }
        if (nearest >= left * (1 - 1e-6)) break;
        depth -= 1.1 * (left - nearest);
      }
      caps[i].push_back({outward, depth});
      ++report.walls;
      report.contact_area += std::numbers::pi * (r * r - depth * depth);
    }
  }
}

std::vector<std::vector<Cap>> caps_of(const Spheres<dynamic>& spheres, const Domain& domain,
                                      const std::vector<Bond>& bonds, ContactReport& report) {
  std::vector<std::vector<Cap>> caps(spheres.size());
  for (const Bond& bond : bonds) {
    const double ri = spheres.r[bond.first], rj = spheres.r[bond.second], height = report.gap - bond.gap;
    const double margin = roundings_at(spheres, bond.first) + roundings_at(spheres, bond.second);
    caps[bond.first].push_back({bond.direction, ri * (1 - height) - margin});
    caps[bond.second].push_back({-bond.direction, rj * (1 - height) - margin});
    const double smaller = std::min(ri, rj);
    report.contact_area += std::numbers::pi * smaller * smaller * height * (2 - height);
  }
  add_wall_caps(spheres, domain, report.gap, caps, report);
  std::vector<std::vector<Circle>> circles(spheres.size());
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    report.changed += !caps[i].empty();
    for (const Cap& cap : caps[i]) {
      circles[i].push_back({cap.normal, std::acos(std::clamp(cap.depth / r, -1.0, 1.0))});
      report.volume_after -= cap_volume(r, r - cap.depth);
      report.largest_change = std::max(report.largest_change, 1 - cap.depth / r);
    }
  }
  report.meetings = meetings_on(circles);
  return caps;
}

/// Whether the planes of two pieces, with exactly opposite normals, are at least gap times the sum of radii
/// apart: exact.
bool are_apart(const HalfSpace& a, const HalfSpace& b, double gap, double sum_of_radii) {
  using verify::Exact;
  const Exact between = Exact(0) - Exact(a.offset) - Exact(b.offset);
  const Exact width = Exact(gap) * Exact(sum_of_radii);
  const Exact squared = square(Exact(a.normal[0])) + square(Exact(a.normal[1])) + square(Exact(a.normal[2]));
  return is_negative(between.sign()) == verify::Truth::no &&
         at_least(square(between), square(width) * squared) == verify::Truth::yes;
}

/// Gives every piece the caps of its sphere, and proves them disjoint for every two pieces that face each
/// other. Of pieces on opposite sides of a period the images are not in the domain together.
bool add_caps(const std::vector<std::vector<Cap>>& caps, const Spheres<dynamic>& spheres,
              const std::vector<Bond>& bonds, double gap, std::vector<Piece>& pieces) {
  std::vector<std::vector<std::size_t>> of_sphere(spheres.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Piece& piece = pieces[p];
    of_sphere[piece.sphere].push_back(p);
    for (const Cap& cap : caps[piece.sphere])
      piece.cuts.push_back({{cap.normal, cap.normal.dot(piece.center) + cap.depth}, Cut::contact});
  }
  const auto cut_along = [](const Piece& piece, const Vector<3>& normal) -> const HalfSpace* {
    for (const Cut& cut : piece.cuts)
      if (cut.face == Cut::contact && cut.keeps.normal == normal) return &cut.keeps;
    return nullptr;
  };
  for (const Bond& bond : bonds)
    for (const std::size_t a : of_sphere[bond.first])
      for (const std::size_t b : of_sphere[bond.second]) {
        const Vector<3> between = pieces[b].center - pieces[a].center;
        const double sum = pieces[a].radius + pieces[b].radius;
        if ((between - bond.distance * bond.direction).norm() > 1e-6 * sum) continue;
        const HalfSpace* one = cut_along(pieces[a], bond.direction);
        const HalfSpace* other = cut_along(pieces[b], -bond.direction);
        if (!one || !other || !are_apart(*one, *other, gap, sum)) return false;
      }
  return true;
}

void add_images(const Bridge& bridge, const Boundary<3>& boundary, std::vector<Bridge>& out) {
  const Vector<3> middle = 0.5 * (bridge.rims[0] + bridge.rims[1]);
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      for (int c = -1; c <= 1; ++c) {
        Bridge image = bridge;
        const std::array<int, 3> moves = {a, b, c};
        bool is_inside = true;
        for (int k = 0; k < 3; ++k) {
          const int moved = moves[static_cast<std::size_t>(k)];
          if (!boundary.repeats(k)) {
            is_inside = is_inside && moved == 0;
            continue;
          }
          const double lower = boundary.origin[k], upper = lower + boundary.edges[k];
          const double at = middle[k] + moved * boundary.edges[k], reach = bridge.reach_along(k);
          is_inside = is_inside && at + reach > lower && at - reach < upper;
          for (Vector<3>& rim : image.rims) rim[k] += moved * boundary.edges[k];
          if (at - reach < lower) image.cuts.push_back({{-Vector<3>::Unit(k), -lower}, 2 * k});
          if (at + reach > upper) image.cuts.push_back({{Vector<3>::Unit(k), upper}, 2 * k + 1});
        }
        if (is_inside) out.push_back(std::move(image));
      }
}

double distance_to_segment(const Vector<3>& p, const Vector<3>& from, const Vector<3>& to) {
  const Vector<3> span = to - from;
  const double along = std::clamp((p - from).dot(span) / span.squaredNorm(), 0.0, 1.0);
  return (p - from - along * span).norm();
}

/// The number of spheres besides its own two that a bridge meets.
std::size_t third_spheres_met(const Spheres<3>& spheres, const PointGrid<3>& grid,
                              const Boundary<3>& boundary, double largest, const Bridge& bridge) {
  const Vector<3> middle = 0.5 * (bridge.rims[0] + bridge.rims[1]), at = boundary.wrap(middle);
  const double half = 0.5 * (bridge.rims[1] - bridge.rims[0]).norm();
  std::size_t met = 0;
  grid.for_each_near(at, half + bridge.radius + largest, [&](std::uint32_t k, const Vector<3>& d) {
    const double r = spheres.r[k];
    if (k == bridge.spheres[0] || k == bridge.spheres[1]) {
      // Its own two reach the rims, to rounding; their images come no nearer than other spheres.
      const double rim = std::sqrt(std::max(0.0, r * r - bridge.radius * bridge.radius));
      for (const Vector<3>& end : bridge.rims)
        if (std::abs((d - (end - middle)).norm() - rim) < 1e-6 * r) return;
    }
    met += distance_to_segment(d, bridge.rims[0] - middle, bridge.rims[1] - middle) < r + bridge.radius;
  });
  return met;
}

constexpr double rounding = 1e-9;  // far above that of coordinates, far below the resolution of CAD

void require_inside(const NearWall& wall) {
  if (wall.gap < -rounding)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("sphere {} reaches through a wall by {:.2g} of its radius, where no bridge can stand; "
                    "bernal verify says more, and contact gap or cap makes room",
                    wall.sphere, -wall.gap));
}

std::vector<Bridge> bridges_of(const Spheres<dynamic>& given, const Domain& domain,
                               const std::vector<Bond>& bonds, const SolidsOptions& options,
                               ContactReport& report) {
  const Spheres<3> spheres = given.in<3>();
  const Boundary<3> boundary = boundary_of<3>(domain);
  const double largest = spheres.empty() ? 0 : std::ranges::max(spheres.r);
  const PointGrid<3> grid(spheres, boundary, std::max(2 * largest, 1e-300));

  std::vector<Bridge> bridges;
  std::vector<std::vector<Circle>> circles(spheres.size());
  report.smallest_angle = 180;
  for (const Bond& bond : bonds) {
    if (bond.gap < -rounding)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("spheres {} and {} overlap by {:.2g} of the sum of their radii, which bridges "
                              "cannot join; contact gap or cap makes room",
                              bond.first, bond.second, -bond.gap));
    const double ri = spheres.r[bond.first], rj = spheres.r[bond.second];
    double a = options.bridge_radius * std::min(ri, rj);
    if (options.bridge_angle > 0)
      a = std::min(std::max(ri, rj) * std::sin(options.bridge_angle * std::numbers::pi / 180),
                   0.7 * std::min(ri, rj));
    const double rim_i = std::sqrt(ri * ri - a * a), rim_j = std::sqrt(rj * rj - a * a);
    const Vector<3> c = spheres.center(bond.first);
    const Bridge bridge{.spheres = {bond.first, bond.second},
                        .rims = {c + rim_i * bond.direction, c + (bond.distance - rim_j) * bond.direction},
                        .radius = a};
    report.volume_after += std::numbers::pi * a * a * (bond.distance - rim_i - rim_j) -
                           cap_volume(ri, ri - rim_i) - cap_volume(rj, rj - rim_j);
    report.contact_area += std::numbers::pi * a * a;
    for (const double r : {ri, rj})
      report.smallest_angle = std::min(report.smallest_angle, 90 + std::asin(a / r) * 180 / std::numbers::pi);
    circles[bond.first].push_back({bond.direction, std::asin(a / ri)});
    circles[bond.second].push_back({-bond.direction, std::asin(a / rj)});
    report.meetings += third_spheres_met(spheres, grid, boundary, largest, bridge);
    add_images(bridge, boundary, bridges);
  }
  report.meetings += meetings_on(circles);
  for (const std::vector<Circle>& of_sphere : circles) report.changed += !of_sphere.empty();
  return bridges;
}

/// The spheres, and those within them as if they were others.
Spheres<dynamic> with_shells(const Spheres<dynamic>& spheres, const InnerSpheres& shells) {
  Spheres<dynamic> all = spheres;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (const double radius : shells.of(i)) all.push_back(spheres.center(i), radius);
  return all;
}

}  // namespace

InnerSpheres scaled(InnerSpheres shells, const Spheres<dynamic>& before, const Spheres<dynamic>& after) {
  if (shells.first.empty()) return shells;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t k = shells.first[i]; k < shells.first[i + 1]; ++k)
      shells.radius[k] *= after.r[i] / before.r[i];
  return shells;
}

double cap_volume(double radius, double height) {
  return std::numbers::pi / 3 * height * height * (3 * radius - height);
}

Solids solids_of(const Spheres<dynamic>& spheres, const Domain& domain, const SolidsOptions& options,
                 const Monitor& monitor) {
  require_closed_walls(domain, "a file of solids");
  Solids made{.spheres = spheres, .domain = domain, .pieces = {}, .bridges = {}, .contacts = {}};
  made.bridge_radius = options.bridge_radius;
  made.bridge_angle = options.bridge_angle;
  if (shrinks(options.contact))
    made.contacts = shrink_contacts(made.spheres, domain, options.contact, options.gap, false, monitor);
  std::vector<Bridge> bridges;
  std::vector<WallFoot> feet;
  if (joins(options.contact)) {
    ContactReport unused;
    const std::vector<Bond> bonds = bonds_of(made.spheres, domain, options.gap);
    bridges = bridges_of(made.spheres, domain, bonds, options, unused);
    if (has_walls(domain)) {
      double foot = options.bridge_angle > 0 ? std::sin(options.bridge_angle * std::numbers::pi / 180)
                                             : options.bridge_radius;
      if (options.contact == ContactTreatment::fillet) foot *= 1.2;  // where it is widest
      for (const NearWall& wall : near_walls(made.spheres, domain, options.gap, nullptr)) {
        require_inside(wall);
        feet.push_back({wall.sphere, foot * made.spheres.r[wall.sphere]});
      }
    }
  }
  made.shells = scaled(options.shells, spheres, made.spheres);
  const ClearEnds ends = with_clear_ends(with_shells(made.spheres, made.shells), domain, bridges, feet);
  made.end_distance = ends.distance;
  made.domain = ends.domain;
  wrap(made.spheres, made.domain);
  if (shrinks(options.contact)) {
    if (options.clear_of_ends) clear_of_ends(made, options.gap, {});
    made.pieces = pieces_of(made.spheres, made.domain);
    // Moved images were rounded, so the gap is proven again.
    if (!has_gap(made.spheres, made.domain, options.gap, monitor)) {
      ContactReport again =
          shrink_contacts(made.spheres, made.domain, options.contact, options.gap, false, monitor);
      made.contacts.volume_after = again.volume_after;
      made.shells = scaled(options.shells, spheres, made.spheres);
      made.pieces = pieces_of(made.spheres, made.domain);
    }
    return made;
  }
  ContactReport& report = made.contacts;
  report = {.treatment = options.contact, .gap = options.gap, .spheres = spheres.size()};
  report.volume_before = report.volume_after = volume_of_balls(made.spheres);
  report.domain_volume = volume_of(domain);
  std::vector<Bond> bonds;
  if (options.contact != ContactTreatment::none) bonds = bonds_of(made.spheres, made.domain, options.gap);
  report.pairs = bonds.size();
  if (options.clear_of_ends) clear_of_ends(made, options.gap, feet);
  made.pieces = pieces_of(made.spheres, made.domain);
  if (options.contact == ContactTreatment::none) return made;
  if (joins(options.contact)) {
    made.bridges = bridges_of(made.spheres, made.domain, bonds, options, report);
    report.walls = near_walls(made.spheres, made.domain, options.gap, nullptr).size();
  } else {
    if (made.cleared > 0) bonds = bonds_of(made.spheres, made.domain, options.gap);
    const auto caps = caps_of(made.spheres, made.domain, bonds, report);
    if (add_caps(caps, made.spheres, bonds, options.gap, made.pieces)) report.proven_gap = options.gap;
  }
  return made;
}

}  // namespace bernal
