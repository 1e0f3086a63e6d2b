// Necks: how wide they may be, the points of their circles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/neck_bonds.hpp"
#include "meshes/wall_views.hpp"
#include "near/point_grid.hpp"

namespace bernal {
namespace {

using std::numbers::pi;
/// No neck becomes narrower than this share of what was asked for.
constexpr double least_share = 0.2;

class Necks {
 public:
  explicit Necks(SurfaceDraft& draft)
      : draft_(draft),
        solids_(draft.solids),
        spheres_(solids_.spheres.in<3>()),
        grid_(spheres_, draft.boundary, 2 * draft.sizes.largest_radius()) {}

  void make() {
    bonds_ = neck_bonds_of(draft_);
    for (NeckBond& bond : bonds_) {
      if (bond.is_fillet && !is_clear_fillet(bond)) {
        bond.is_fillet = false;
        ++draft_.made.statement.cut_fillets;
      }
      if (!bond.is_fillet) bond.radius = clear_of_ends(bond, bond.asked, true);
    }
    limit_.assign(bonds_.size(), std::numeric_limits<double>::infinity());
    for (std::uint32_t b = 0; b < bonds_.size(); ++b)
      if (bonds_[b].wall) narrow(b, 1, bonds_[b].room);
    keep_apart_on_spheres();
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) keep_from_others(b);
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) finish(b);
  }

 private:
  /// Shares of a radius that are tried, the nearest first.
  static constexpr std::array<double, 21> shares = {1,   0.95, 1.05, 0.9,  1.1, 0.85, 1.15,
                                                    0.8, 1.2,  0.75, 1.25, 0.7, 1.3,  0.65,
                                                    0.6, 0.55, 0.5,  0.45, 0.4, 0.35, 0.3};

  double edge_of(const NeckBond& bond) const { return draft_.options.neck_edge * bond.ends.least_radius(); }
  /// The centre of the first sphere, or of the second, where the first is in the period.
  Vector<3> center(const NeckBond& bond, std::size_t end) const {
    Vector<3> c = spheres_.center(bond.spheres[end]);
    if (end == 1)
      for (int k = 0; k < 3; ++k) c[k] += bond.step[static_cast<std::size_t>(k)] * draft_.boundary.edges[k];
    return c;
  }

  /// Of some shares of a radius the first that ends of periods cut or miss clearly, or the best. Bridges on
  /// walls are not cut.
  double clear_of_ends(const NeckBond& bond, double radius, bool may_widen) const {
    if (!draft_.boundary.repeats()) return radius;
    double best = radius, most = -1;
    for (const double share : shares) {
      const double a = share * radius;
      if ((share > 1 && (!may_widen || bond.wall)) || (bond.wall && is_crossed(bond, a))) continue;
      double clearance = clearance_of_ends(draft_.boundary, center(bond, 0), spheres_.r[bond.spheres[0]],
                                           bond.axis, a, edge_of(bond));
      if (!bond.wall)
        clearance =
            std::min(clearance, clearance_of_ends(draft_.boundary, center(bond, 1),
                                                  spheres_.r[bond.spheres[1]], -bond.axis, a, edge_of(bond)));
      if (clearance >= 1) return a;
      if (clearance > most) {
        most = clearance;
        best = a;
      }
    }
    return best;
  }

  /// Whether ends of periods are half an edge away from what lies between the circles of a fillet, and its
  /// circles clear of theirs.
  bool is_clear_fillet(const NeckBond& bond) const {
    const Boundary<3>& boundary = draft_.boundary;
    if (!boundary.repeats()) return true;
    const NeckShape shape = bond.shape(bond.radius);
    const double edge = edge_of(bond);
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const double along = bond.axis[k], beside = std::sqrt(std::max(0.0, 1 - along * along));
      const double from = center(bond, 0)[k] - boundary.origin[k];
      const std::array<double, 2> at = {from + shape.begin * along, from + shape.end * along};
      double lower = 0, upper = 0;
      for (std::size_t e = 0; e < 2; ++e) {
        const double reach = shape.rims[e] * beside + 0.5 * edge;
        lower = e == 0 ? at[e] - reach : std::min(lower, at[e] - reach);
        upper = e == 0 ? at[e] + reach : std::max(upper, at[e] + reach);
      }
      if (std::floor(lower / boundary.edges[k]) != std::floor(upper / boundary.edges[k])) return false;
    }
    for (std::size_t e = 0; e < (bond.wall ? 1u : 2u); ++e)
      if (clearance_of_ends(boundary, center(bond, e), spheres_.r[bond.spheres[e]],
                            e == 0 ? bond.axis : Vector<3>(-bond.axis), shape.rims[e], edge) < 1)
        return false;
    return true;
  }

  bool is_crossed(const NeckBond& bond, double radius) const {
    for (int k = 0; k < 3; ++k) {
      if (!draft_.boundary.repeats(k)) continue;
      const double from = (center(bond, 0)[k] - draft_.boundary.origin[k]) / draft_.boundary.edges[k];
      if (std::abs(from - std::nearbyint(from)) * draft_.boundary.edges[k] <= radius) return true;
    }
    return false;
  }

  /// Circles on one sphere stay half an edge apart.
  void keep_apart_on_spheres() {
    struct OnSphere {
      Vector<3> direction;
      std::uint32_t bond;
      std::size_t end;
      double angle;  ///< half of that under which the circle is seen
    };
    std::vector<std::vector<OnSphere>> on(spheres_.size());
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) {
      const NeckBond& bond = bonds_[b];
      const NeckShape shape = bond.shape(bond.radius);
      for (std::size_t e = 0; e < (bond.wall ? 1u : 2u); ++e)
        on[bond.spheres[e]].push_back({e == 0 ? bond.axis : Vector<3>(-bond.axis), b, e,
                                       std::asin(shape.rims[e] / spheres_.r[bond.spheres[e]])});
    }
    for (std::size_t i = 0; i < on.size(); ++i)
      for (std::size_t a = 0; a < on[i].size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const OnSphere &one = on[i][a], &other = on[i][b];
          const double r = spheres_.r[i];
          const double apart =
              std::atan2(one.direction.cross(other.direction).norm(), one.direction.dot(other.direction));
          const double both = one.angle + other.angle;
          const double room =
              apart - 0.5 * std::max(edge_of(bonds_[one.bond]), edge_of(bonds_[other.bond])) / r;
          if (both <= room) continue;
          const double share = std::max(0.0, room / both);
          for (const OnSphere* each : {&one, &other})
            narrow(each->bond, each->end, r * std::sin(share * each->angle));
        }
  }

  /// A quarter of an edge stays between a neck and spheres that it does not join.
  void keep_from_others(std::uint32_t b) {
    const NeckBond& bond = bonds_[b];
    const double half = 0.5 * bond.ends.distance, radius = bond.shape(bond.radius).largest_radius();
    const Vector<3> middle = center(bond, 0) + half * bond.axis;
    const double reach = half + draft_.sizes.largest_radius() + radius + edge_of(bond);
    grid_.for_each_near(draft_.boundary.wrap(middle), reach, [&](std::uint32_t j, const Vector<3>& d) {
      const double along = d.dot(bond.axis), r = spheres_.r[j];
      const double beside = (d - along * bond.axis).norm();
      if (beside < 1e-6 * r) return;  // one of its own
      const double outside = std::max(0.0, std::abs(along) - half);
      const double room = std::hypot(beside, outside) - r - 0.25 * edge_of(bond);
      if (room < radius)
        for (const std::size_t end : {0, 1}) narrow(b, end, room);
    });
  }

  /// Lets the circle at one end of a neck have at most this radius.
  void narrow(std::uint32_t b, std::size_t end, double rim) {
    const NeckBond& bond = bonds_[b];
    if (bond.shape(bond.radius).rims[end] <= rim) return;
    const double radius = !bond.is_fillet ? rim
                          : rim > 0       ? radius_for_rim(bond.ends, end, rim, bond.radius)
                                          : 0;
    if (!(radius > least_share * bond.asked))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a bridge at sphere {} has no room between others; a smaller radius of bridges "
                              "or a smaller gap makes room",
                              bond.spheres[0]));
    limit_[b] = std::min(limit_[b], radius);
  }

  void finish(std::uint32_t b) {
    NeckBond& bond = bonds_[b];
    if (limit_[b] < bond.radius)
      bond.radius = bond.is_fillet ? limit_[b] : clear_of_ends(bond, limit_[b], false);
    DraftNeck neck{bond.shape(bond.radius)};
    neck.bond = b;
    neck.spheres = bond.spheres;
    neck.wall = bond.wall;
    neck.axis = bond.axis;
    neck.across = bond.axis.unitOrthogonal();
    neck.distance = bond.ends.distance;
    neck.volume = neck.NeckShape::volume() - cap_volume(bond.ends.first, bond.ends.first - neck.begin);
    if (bond.ends.second) {
      neck.volume -= cap_volume(*bond.ends.second, *bond.ends.second - (neck.distance - neck.end));
    } else {
      neck.volume -= volume_before_wall(solids_.domain, *bond.wall, neck);
    }
    divide(neck, bond);
    place_images(neck, bond);
    ConformingSurface& made = draft_.made;
    made.statement.contact_area += pi * neck.radius * neck.radius;
    made.necks.push_back({bond.spheres[0], {}, bond.wall.value_or(0), neck.radius});
    if (!bond.wall) made.necks.back().other = bond.spheres[1];
    if (neck.radius < bond.asked) {
      ++made.statement.shrunk_necks;
      made.statement.largest_shrink = std::max(made.statement.largest_shrink, 1 - neck.radius / bond.asked);
    }
    made.statement.widened_necks += neck.radius > bond.asked;
  }

  /// How many points and rows of triangles the side has.
  void divide(DraftNeck& neck, const NeckBond& bond) const {
    const double rise = bond.wall ? rise_of_wall(solids_.domain, *bond.wall, neck.rims[1]) : 0;
    const double least = bond.ends.least_radius();
    if (neck.is_fillet()) {
      // Rows turn by this many radians for each unit of the edge over the radius, and are at least so high
      // over their edges.
      constexpr double turn_per_edge = 5.5, edge_per_row = 4;
      const auto [from, to] = neck.turns();
      const double length = neck.length(), asked = edge_of(bond);
      neck.rows = static_cast<std::size_t>(
          std::max({3.0, std::ceil((to - from) / (turn_per_edge * draft_.options.neck_edge)),
                    std::ceil(length / (0.87 * asked))}));
      const double row = length / static_cast<double>(neck.rows) * (1 - rise / (neck.end - neck.begin));
      neck.count = static_cast<std::size_t>(
          std::max(6.0, std::ceil(2 * pi * neck.largest_radius() / std::min(asked, edge_per_row * row))));
    } else {
      neck.count = draft_.sizes.neck_count(neck.radius, least, neck.end - neck.begin - rise);
    }
    neck.edge = 2 * pi * neck.largest_radius() / static_cast<double>(neck.count);
    if (!neck.is_fillet())
      neck.rows = static_cast<std::size_t>(
          std::max(1.0, std::nearbyint((neck.end - neck.begin) / (0.87 * neck.edge))));
  }

  /// A neck for every image of it of which a part is in the domain.
  void place_images(const DraftNeck& neck, const NeckBond& bond) {
    const Boundary<3>& boundary = draft_.boundary;
    const Vector<3> first = center(bond, 0), middle = first + 0.5 * (neck.begin + neck.end) * neck.axis;
    std::array<int, 3> lower{}, upper{};
    bool is_cut = false;
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const auto at = static_cast<std::size_t>(k);
      const double reach = 0.5 * (neck.end - neck.begin) * std::abs(neck.axis[k]) +
                           neck.largest_radius() * std::sqrt(std::max(0.0, 1 - neck.axis[k] * neck.axis[k]));
      const double from = (middle[k] - boundary.origin[k]) / boundary.edges[k],
                   share = reach / boundary.edges[k];
      lower[at] = -static_cast<int>(std::floor(from + share));
      upper[at] = -static_cast<int>(std::floor(from - share));
      is_cut |= lower[at] != upper[at];
    }
    if (is_cut && bond.wall)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("the bridge from sphere {} to the wall crosses an end of a period, which no "
                              "mesh is made of; contact gap, shrink or cap has none",
                              bond.spheres[0]));
    for (int x = lower[0]; x <= upper[0]; ++x)
      for (int y = lower[1]; y <= upper[1]; ++y)
        for (int z = lower[2]; z <= upper[2]; ++z) {
          DraftNeck image = neck;
          image.image = {x, y, z};
          image.is_cut = is_cut;
          image.center = first;
          std::array<int, 3> other{};
          for (std::size_t k = 0; k < 3; ++k) {
            image.center[static_cast<int>(k)] += image.image[k] * boundary.edges[static_cast<int>(k)];
            other[k] = image.image[k] + bond.step[k];
          }
          if (is_cut && !reaches_in(image)) continue;
          image.pieces[0] = draft_.piece_at(bond.spheres[0], image.image);
          if (!bond.wall) image.pieces[1] = draft_.piece_at(bond.spheres[1], other);
          const auto n = static_cast<std::uint32_t>(draft_.necks.size());
          if (!is_cut) make_rims(image);
          put_on_pieces(n, image);
          draft_.necks.push_back(std::move(image));
        }
  }

  /// Whether a part of the side of a cut neck is in the domain: its pieces are far larger than the samples'
  /// distance, as `clear_of_ends` sees to.
  bool reaches_in(const DraftNeck& neck) const {
    constexpr int around = 96, along = 5;
    const Boundary<3>& boundary = draft_.boundary;
    for (int k = 0; k < around; ++k)
      for (int l = 0; l < along; ++l) {
        const double t = 2 * pi * k / around;
        const Vector<3> p = neck.center +
                            (neck.begin + (neck.end - neck.begin) * l / (along - 1)) * neck.axis +
                            neck.radius * (std::cos(t) * neck.across + std::sin(t) * neck.around());
        bool is_in = true;
        for (int m = 0; m < 3; ++m)
          is_in = is_in && (!boundary.repeats(m) ||
                            (p[m] > boundary.origin[m] && p[m] < boundary.origin[m] + boundary.edges[m]));
        if (is_in) return true;
      }
    return false;
  }

  void make_rims(DraftNeck& neck) {
    const double other_depth = neck.distance - neck.end;
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t k = 0; k < neck.count; ++k) {
        const double t = 2 * pi *
                         (static_cast<double>(k) + (e == 1 ? 0.5 * static_cast<double>(neck.rows) : 0.0)) /
                         static_cast<double>(neck.count);
        const Vector<3> beside = neck.rims[e] * (std::cos(t) * neck.across + std::sin(t) * neck.around());
        const Vector<3> p =
            e == 0 ? Vector<3>(neck.center + neck.begin * neck.axis + beside)
            : !neck.wall
                ? Vector<3>(draft_.pieces[neck.pieces[1]].piece.center - other_depth * neck.axis + beside)
                : foot_of(draft_, neck, beside);
        neck.rim_points[e].push_back(draft_.add_vertex(p, neck.edge));
      }
  }

  void put_on_pieces(std::uint32_t n, DraftNeck& neck) {
    for (std::size_t e = 0; e < 2; ++e) {
      if (neck.pieces[e] == Delaunay::none) continue;
      Circle circle;
      circle.kind = Circle::Kind::neck;
      circle.neck = n;
      circle.radius = neck.rims[e];
      circle.edge = neck.edge;
      circle.normal = e == 0 ? neck.axis : Vector<3>(-neck.axis);
      circle.depth = e == 0 ? neck.begin : neck.distance - neck.end;
      if (!neck.is_cut) {
        circle.is_whole = true;
        circle.chains = {neck.rim_points[e]};
        if (e == 1) std::ranges::reverse(circle.chains[0]);
      }
      auto& circles = draft_.pieces[neck.pieces[e]].circles;
      neck.circles[e] = circles.size();
      circles.push_back(circle);
    }
  }

  SurfaceDraft& draft_;
  const Solids& solids_;
  Spheres<3> spheres_;
  PointGrid<3> grid_;
  std::vector<NeckBond> bonds_;
  std::vector<double> limit_;  ///< of the radius, by bond
};

}  // namespace

Vector<3> foot_of(const SurfaceDraft& draft, const DraftNeck& neck, const Vector<3>& beside) {
  Vector<3> p =
      neck.center + beside +
      (neck.distance - rise_at_wall(draft.solids.domain, *neck.wall, neck.axis, beside)) * neck.axis;
  if (const auto* box = std::get_if<Box>(&draft.solids.domain)) {
    const int k = static_cast<int>(*neck.wall / 2);
    p[k] = *neck.wall % 2 == 0 ? box->corner[k] : box->corner[k] + box->size[k];
  }
  return p;
}

RoundSurface shape_of_side(const SurfaceDraft& draft, const DraftNeck& neck) {
  RoundSurface side{
      .kind = RoundSurface::Kind::cylinder, .center = neck.center, .axis = neck.axis, .radius = neck.radius};
  if (!neck.is_fillet()) return side;
  side.kind = RoundSurface::Kind::torus;
  side.center += neck.waist * neck.axis;
  side.radius = neck.spine();
  side.tube = neck.tube;
  if (!neck.wall) return side;
  side.bend = {.wall_radius = radius_of_wall(draft.solids.domain, *neck.wall),
               .across = across_wall(draft.solids.domain, neck.axis),
               .from = neck.begin - neck.waist,
               .height = neck.end - neck.begin};
  return side;
}

Vector<3> point_on_side(const SurfaceDraft& draft, const DraftNeck& neck, double share, double angle) {
  const NeckShape::Ring ring = neck.ring(share);
  const Vector<3> beside = ring.radius * (std::cos(angle) * neck.across + std::sin(angle) * neck.around());
  double rise = 0;
  if (neck.wall) rise = rise_at_wall(draft.solids.domain, *neck.wall, neck.axis, beside);
  const double height = neck.begin + (ring.height - neck.begin) * (1 - rise / (neck.end - neck.begin));
  return neck.center + height * neck.axis + beside;
}

void add_necks(SurfaceDraft& draft) { Necks(draft).make(); }

}  // namespace bernal
