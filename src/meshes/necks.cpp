// Necks: where they are, how wide they may be, the points of their circles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"
#include "meshes/wall_views.hpp"
#include "near/point_grid.hpp"

namespace bernal {
namespace {

using std::numbers::pi;
/// No neck becomes narrower than this share of what was asked for.
constexpr double least_share = 0.2;

/// What a neck joins, in whatever image; its radius is to be found.
struct NeckBond {
  std::array<std::uint32_t, 2> spheres = {};
  std::optional<std::uint32_t> wall = {};
  std::array<int, 3> step = {};  ///< from the image of the first sphere to that of the second
  Vector<3> axis = Vector<3>::UnitZ();
  double distance = 0;
  double asked = 0, radius = 0;
  double room = std::numeric_limits<double>::infinity();  ///< for the radius, on the wall
};

class Necks {
 public:
  explicit Necks(SurfaceDraft& draft)
      : draft_(draft),
        solids_(draft.solids),
        spheres_(solids_.spheres.in<3>()),
        grid_(spheres_, draft.boundary, 2 * draft.sizes.largest_radius()) {}

  void make() {
    between_spheres();
    at_walls();
    for (NeckBond& bond : bonds_) bond.radius = clear_of_ends(bond, bond.asked, true);
    limit_.assign(bonds_.size(), std::numeric_limits<double>::infinity());
    for (std::uint32_t b = 0; b < bonds_.size(); ++b)
      if (bonds_[b].room < bonds_[b].radius) narrow(b, bonds_[b].room);
    keep_apart_on_spheres();
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) keep_from_others(b);
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) finish(b);
  }

 private:
  /// Shares of a radius that are tried, the nearest first.
  static constexpr std::array<double, 21> shares = {1,   0.95, 1.05, 0.9,  1.1, 0.85, 1.15,
                                                    0.8, 1.2,  0.75, 1.25, 0.7, 1.3,  0.65,
                                                    0.6, 0.55, 0.5,  0.45, 0.4, 0.35, 0.3};

  double edge_of(const NeckBond& bond) const { return draft_.options.neck_edge * least_radius(bond); }
  double least_radius(const NeckBond& bond) const {
    const double r = spheres_.r[bond.spheres[0]];
    return bond.wall ? r : std::min(r, spheres_.r[bond.spheres[1]]);
  }
  /// The centre of the first sphere, or of the second, where the first is in the period.
  Vector<3> center(const NeckBond& bond, std::size_t end) const {
    Vector<3> c = spheres_.center(bond.spheres[end]);
    if (end == 1)
      for (int k = 0; k < 3; ++k) c[k] += bond.step[static_cast<std::size_t>(k)] * draft_.boundary.edges[k];
    return c;
  }

  void between_spheres() {
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::array<int, 3>>> known;
    const Boundary<3>& boundary = draft_.boundary;
    for (const Bridge& bridge : solids_.bridges) {
      NeckBond bond;
      bond.spheres = bridge.spheres;
      const Vector<3> along = (bridge.rims[1] - bridge.rims[0]).normalized();
      std::array<std::array<int, 3>, 2> image{};
      for (std::size_t e = 0; e < 2; ++e) {
        const double r = spheres_.r[bridge.spheres[e]];
        const double depth = std::sqrt(r * r - bridge.radius * bridge.radius);
        const Vector<3> at = bridge.rims[e] + (e == 0 ? -depth : depth) * along -
                             Vector<3>(spheres_.center(bridge.spheres[e]));
        for (int k = 0; k < 3; ++k)
          if (boundary.repeats(k))
            image[e][static_cast<std::size_t>(k)] =
                static_cast<int>(std::nearbyint(at[k] / boundary.edges[k]));
      }
      for (std::size_t k = 0; k < 3; ++k) bond.step[k] = image[1][k] - image[0][k];
      if (!known.insert({bond.spheres[0], bond.spheres[1], bond.step}).second) continue;
      const Vector<3> between = center(bond, 1) - center(bond, 0);
      bond.distance = between.norm();
      bond.axis = between / bond.distance;
      bond.asked = bridge.radius;
      bonds_.push_back(bond);
    }
  }

  void at_walls() {
    if (solids_.contacts.treatment != ContactTreatment::bridge) return;
    if (draft_.flat_walls) return at_flat_walls();
    for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.r[i];
      for (const WallSheet& view : walls_around(solids_.domain, spheres_.center(i))) {
        if (view.distance - r >= solids_.contacts.gap * r) continue;
        bonds_.push_back({.spheres = {i, i},
                          .wall = view.wall,
                          .axis = view.outward,
                          .distance = view.distance,
                          .asked = solids_.bridge_radius * r});
      }
    }
  }

  void at_flat_walls() {
    const PlanarWalls& walls = *draft_.flat_walls;
    const FlatFeet feet(std::get<Mesh>(solids_.domain), walls, draft_.sizes.container());
    for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.r[i], asked = solids_.bridge_radius * r;
      const Vector<3> c = spheres_.center(i);
      for (const FlatFeet::Foot& foot : feet.near(c, r, (1 + solids_.contacts.gap) * r)) {
        const FlatPart& part = walls.parts[foot.part];
        bonds_.push_back({.spheres = {i, i},
                          .wall = foot.part,
                          .axis = part.outward,
                          .distance = (part.origin - c).dot(part.outward),
                          .asked = asked,
                          .room = FlatFeet::radius_in(foot, asked, draft_.options.neck_edge * r)});
      }
    }
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
    };
    std::vector<std::vector<OnSphere>> on(spheres_.size());
    for (std::uint32_t b = 0; b < bonds_.size(); ++b) {
      on[bonds_[b].spheres[0]].push_back({bonds_[b].axis, b});
      if (!bonds_[b].wall) on[bonds_[b].spheres[1]].push_back({-bonds_[b].axis, b});
    }
    for (std::size_t i = 0; i < on.size(); ++i)
      for (std::size_t a = 0; a < on[i].size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const NeckBond &one = bonds_[on[i][a].bond], &other = bonds_[on[i][b].bond];
          const double r = spheres_.r[i];
          const double apart = std::atan2(on[i][a].direction.cross(on[i][b].direction).norm(),
                                          on[i][a].direction.dot(on[i][b].direction));
          const double alpha = std::asin(one.radius / r), beta = std::asin(other.radius / r);
          const double room = apart - 0.5 * std::max(edge_of(one), edge_of(other)) / r;
          if (alpha + beta <= room) continue;
          const double share = room / (alpha + beta);
          narrow(on[i][a].bond, share > 0 ? r * std::sin(share * alpha) : 0);
          narrow(on[i][b].bond, share > 0 ? r * std::sin(share * beta) : 0);
        }
  }

  /// A quarter of an edge stays between a neck and spheres that it does not join.
  void keep_from_others(std::uint32_t b) {
    const NeckBond& bond = bonds_[b];
    const double half = 0.5 * bond.distance;
    const Vector<3> middle = center(bond, 0) + half * bond.axis;
    const double reach = half + draft_.sizes.largest_radius() + bond.radius + edge_of(bond);
    grid_.for_each_near(draft_.boundary.wrap(middle), reach, [&](std::uint32_t j, const Vector<3>& d) {
      const double along = d.dot(bond.axis), r = spheres_.r[j];
      const double beside = (d - along * bond.axis).norm();
      if (beside < 1e-6 * r) return;  // one of its own
      const double outside = std::max(0.0, std::abs(along) - half);
      const double room = std::hypot(beside, outside) - r - 0.25 * edge_of(bond);
      if (room < bond.radius) narrow(b, room);
    });
  }

  void narrow(std::uint32_t b, double radius) {
    if (!(radius > least_share * bonds_[b].asked))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a bridge at sphere {} has no room between others; a smaller radius of bridges "
                              "or a smaller gap makes room",
                              bonds_[b].spheres[0]));
    limit_[b] = std::min(limit_[b], radius);
  }

  void finish(std::uint32_t b) {
    NeckBond& bond = bonds_[b];
    if (limit_[b] < bond.radius) bond.radius = clear_of_ends(bond, limit_[b], false);
    DraftNeck neck;
    neck.bond = b;
    neck.spheres = bond.spheres;
    neck.wall = bond.wall;
    neck.axis = bond.axis;
    neck.across = bond.axis.unitOrthogonal();
    neck.radius = bond.radius;
    neck.distance = bond.distance;
    const double a = neck.radius, r = spheres_.r[bond.spheres[0]];
    neck.begin = std::sqrt(r * r - a * a);
    neck.volume = -cap_volume(r, r - neck.begin);
    neck.end = bond.distance;
    if (!bond.wall) {
      const double other = spheres_.r[bond.spheres[1]], depth = std::sqrt(other * other - a * a);
      neck.end -= depth;
      neck.volume -= cap_volume(other, other - depth);
    } else {
      neck.volume -= volume_before_wall(solids_.domain, *bond.wall, a);
    }
    const double height = neck.end - neck.begin;
    neck.volume += pi * a * a * height;
    neck.count = draft_.sizes.neck_count(
        a, least_radius(bond), height - (bond.wall ? rise_of_wall(solids_.domain, *bond.wall, a) : 0));
    neck.edge = 2 * pi * a / static_cast<double>(neck.count);
    neck.rows = static_cast<std::size_t>(std::max(1.0, std::nearbyint(height / (0.87 * neck.edge))));
    place_images(neck, bond);
    ConformingSurface& made = draft_.made;
    made.statement.contact_area += pi * a * a;
    made.necks.push_back({bond.spheres[0], {}, bond.wall.value_or(0), a});
    if (!bond.wall) made.necks.back().other = bond.spheres[1];
    if (a < bond.asked) {
      ++made.statement.shrunk_necks;
      made.statement.largest_shrink = std::max(made.statement.largest_shrink, 1 - a / bond.asked);
    }
    made.statement.widened_necks += a > bond.asked;
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
                           neck.radius * std::sqrt(std::max(0.0, 1 - neck.axis[k] * neck.axis[k]));
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
        const Vector<3> beside = neck.radius * (std::cos(t) * neck.across + std::sin(t) * neck.around());
        const Vector<3> p =
            e == 0 ? Vector<3>(neck.center + neck.begin * neck.axis + beside)
            : !neck.wall
                ? Vector<3>(draft_.pieces[neck.pieces[1]].piece.center - other_depth * neck.axis + beside)
                : foot_of(draft_, neck, beside);
        neck.rims[e].push_back(draft_.add_vertex(p, neck.edge));
      }
  }

  void put_on_pieces(std::uint32_t n, DraftNeck& neck) {
    for (std::size_t e = 0; e < 2; ++e) {
      if (neck.pieces[e] == Delaunay::none) continue;
      Circle circle;
      circle.kind = Circle::Kind::neck;
      circle.neck = n;
      circle.radius = neck.radius;
      circle.edge = neck.edge;
      circle.normal = e == 0 ? neck.axis : Vector<3>(-neck.axis);
      circle.depth = e == 0 ? neck.begin : neck.distance - neck.end;
      if (!neck.is_cut) {
        circle.is_whole = true;
        circle.chains = {neck.rims[e]};
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
  Vector<3> p = neck.center + beside + neck.distance * neck.axis;
  if (const auto* box = std::get_if<Box>(&draft.solids.domain)) {
    const int k = static_cast<int>(*neck.wall / 2);
    p[k] = *neck.wall % 2 == 0 ? box->corner[k] : box->corner[k] + box->size[k];
  } else if (const double radius = radius_of_wall(draft.solids.domain, *neck.wall); radius > 0) {
    // Where lines along the neck's axis, which is a radius of the wall, meet it.
    const auto* cylinder = std::get_if<Cylinder>(&draft.solids.domain);
    const double x =
        cylinder != nullptr ? beside.dot(cylinder->axis.normalized().cross(neck.axis)) : beside.norm();
    p += (std::sqrt(radius * radius - x * x) - radius) * neck.axis;
  }
  return p;
}

void add_necks(SurfaceDraft& draft) { Necks(draft).make(); }

}  // namespace bernal
