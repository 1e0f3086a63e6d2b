// Necks: where they are, how wide they may be, the points of their circles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"
#include "near/point_grid.hpp"

namespace bernal {
namespace {

using std::numbers::pi;
/// No neck becomes narrower than this share of what was asked for.
constexpr double least_share = 0.2;

/// A wall as seen from a point inside.
struct WallView {
  std::uint32_t wall;
  Vector<3> outward;
  double distance;
  double room = std::numeric_limits<double>::infinity();  ///< for the radius of a bridge
};

std::vector<WallView> walls_seen_from(const Domain& domain, const Vector<3>& p) {
  std::vector<WallView> views;
  if (const auto* box = std::get_if<Box>(&domain)) {
    for (int k = 0; k < 3; ++k) {
      if (box->repeats(k)) continue;
      views.push_back({static_cast<std::uint32_t>(2 * k), -Vector<3>::Unit(k), p[k] - box->corner[k]});
      views.push_back(
          {static_cast<std::uint32_t>(2 * k + 1), Vector<3>::Unit(k), box->corner[k] + box->size[k] - p[k]});
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> a = cylinder->axis.normalized(), d = p - cylinder->base;
    const double z = d.dot(a);
    const Vector<3> across = d - z * a;
    if (across.norm() > 0) views.push_back({0, across.normalized(), cylinder->radius - across.norm()});
    if (!cylinder->periodic) {
      views.push_back({1, -a, z});
      views.push_back({2, a, cylinder->height - z});
    }
  } else if (const auto* sphere = std::get_if<Sphere>(&domain)) {
    const Vector<3> d = p - sphere->center;
    if (d.norm() > 0) views.push_back({0, d.normalized(), sphere->radius - d.norm()});
  }
  return views;
}

/// The radius of the round wall on which a neck stands; 0 for flat ones.
double radius_of_wall(const Domain& domain, const DraftNeck& neck) {
  if (const auto* sphere = std::get_if<Sphere>(&domain)) return sphere->radius;
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  return cylinder != nullptr && neck.wall == 0u ? cylinder->radius : 0;
}

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
    limit_.assign(bonds_, std::numeric_limits<double>::infinity());
    for (const DraftNeck& neck : draft_.necks)
      if (neck.most_radius < neck.asked) narrow(neck, neck.most_radius);
    keep_apart_on_spheres();
    keep_from_others();
    for (std::uint32_t n = 0; n < draft_.necks.size(); ++n) finish(n);
  }

 private:
  double edge_of(const DraftNeck& neck) const { return draft_.options.neck_edge * least_radius(neck); }
  double least_radius(const DraftNeck& neck) const {
    const double r = draft_.pieces[neck.pieces[0]].piece.radius;
    return neck.wall ? r : std::min(r, draft_.pieces[neck.pieces[1]].piece.radius);
  }

  void between_spheres() {
    std::vector<std::vector<std::uint32_t>> of_sphere(solids_.spheres.size());
    for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p)
      of_sphere[draft_.pieces[p].piece.sphere].push_back(p);
    const Bridge* before = nullptr;
    for (const Bridge& bridge : solids_.bridges) {
      if (!bridge.cuts.empty())
        throw Error(
            ErrorCode::bad_argument,
            fmt::format("the bridge between spheres {} and {} crosses an end of a period, which no mesh "
                        "is made of; contact gap, shrink or cap, or a container with walls, has none",
                        bridge.spheres[0], bridge.spheres[1]));
      DraftNeck neck;
      for (std::size_t e = 0; e < 2; ++e) {
        const double r = solids_.spheres.r[bridge.spheres[e]];
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t p : of_sphere[bridge.spheres[e]]) {
          const double off = std::abs((bridge.rims[e] - draft_.pieces[p].piece.center).norm() -
                                      std::sqrt(r * r - bridge.radius * bridge.radius));
          if (off >= nearest || (e == 1 && p == neck.pieces[0])) continue;
          nearest = off;
          neck.pieces[e] = p;
        }
      }
      const Vector<3> between =
          draft_.pieces[neck.pieces[1]].piece.center - draft_.pieces[neck.pieces[0]].piece.center;
      neck.distance = between.norm();
      neck.axis = between / neck.distance;
      neck.asked = bridge.radius;
      const bool is_image =
          before != nullptr && before->spheres == bridge.spheres &&
          (before->rims[1] - before->rims[0] - bridge.rims[1] + bridge.rims[0]).norm() < 1e-9 * bridge.radius;
      neck.bond = is_image ? bonds_ - 1 : bonds_++;
      before = &bridge;
      draft_.necks.push_back(neck);
    }
  }

  /// Of flat walls those that are nearer than the gap.
  std::vector<WallView> walls_around(const Piece& piece) const {
    const auto* mesh = std::get_if<Mesh>(&solids_.domain);
    if (mesh == nullptr) return walls_seen_from(solids_.domain, piece.center);
    std::vector<WallView> views;
    const double r = piece.radius, reach = (1 + solids_.contacts.gap) * r;
    for (const FlatFeet::Foot& foot : feet_->near(piece.center, r, reach)) {
      const FlatPart& part = draft_.flat_walls->parts[foot.part];
      views.push_back({foot.part, part.outward, (part.origin - piece.center).dot(part.outward),
                       FlatFeet::radius_in(foot, solids_.bridge_radius * r, draft_.options.neck_edge * r)});
    }
    return views;
  }

  void at_walls() {
    if (solids_.contacts.treatment != ContactTreatment::bridge) return;
    if (const auto* mesh = std::get_if<Mesh>(&solids_.domain))
      feet_.emplace(*mesh, *draft_.flat_walls, draft_.sizes.container());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> bonds;
    for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p) {
      const Piece& piece = draft_.pieces[p].piece;
      for (const WallView& view : walls_around(piece)) {
        if (view.distance - piece.radius >= solids_.contacts.gap * piece.radius) continue;
        DraftNeck neck;
        neck.pieces = {p, p};
        neck.wall = view.wall;
        neck.axis = view.outward;
        neck.asked = solids_.bridge_radius * piece.radius;
        neck.distance = view.distance;
        neck.most_radius = view.room;
        const auto [entry, is_new] = bonds.try_emplace({piece.sphere, view.wall}, bonds_);
        bonds_ += is_new;
        neck.bond = entry->second;
        for (int k = 0; k < 3; ++k)
          if (draft_.boundary.repeats(k) && std::abs(view.outward[k]) < 0.5 &&
              (piece.center[k] - neck.asked < draft_.boundary.origin[k] ||
               piece.center[k] + neck.asked > draft_.boundary.origin[k] + draft_.boundary.edges[k]))
            throw Error(
                ErrorCode::bad_argument,
                fmt::format("the bridge from sphere {} to the wall crosses an end of a period, which no "
                            "mesh is made of; contact gap, shrink or cap has none",
                            piece.sphere));
        draft_.necks.push_back(neck);
      }
    }
  }

  /// Circles on one sphere stay half an edge apart.
  void keep_apart_on_spheres() {
    struct OnSphere {
      Vector<3> direction;
      std::uint32_t neck;
    };
    std::vector<std::vector<OnSphere>> on(solids_.spheres.size());
    for (std::uint32_t n = 0; n < draft_.necks.size(); ++n) {
      const DraftNeck& neck = draft_.necks[n];
      on[draft_.pieces[neck.pieces[0]].piece.sphere].push_back({neck.axis, n});
      if (!neck.wall) on[draft_.pieces[neck.pieces[1]].piece.sphere].push_back({-neck.axis, n});
    }
    for (std::size_t i = 0; i < on.size(); ++i)
      for (std::size_t a = 0; a < on[i].size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
          const DraftNeck &one = draft_.necks[on[i][a].neck], &other = draft_.necks[on[i][b].neck];
          const double r = solids_.spheres.r[i];
          const double apart = std::atan2(on[i][a].direction.cross(on[i][b].direction).norm(),
                                          on[i][a].direction.dot(on[i][b].direction));
          if (one.bond == other.bond && apart < 1e-6) continue;
          const double alpha = std::asin(one.asked / r), beta = std::asin(other.asked / r);
          const double room = apart - 0.5 * std::max(edge_of(one), edge_of(other)) / r;
          if (alpha + beta <= room) continue;
          const double share = room / (alpha + beta);
          narrow(one, share > 0 ? r * std::sin(share * alpha) : 0);
          narrow(other, share > 0 ? r * std::sin(share * beta) : 0);
        }
  }

  /// A quarter of an edge stays between a neck and spheres that it does not join.
  void keep_from_others() {
    for (const DraftNeck& neck : draft_.necks) {
      const Vector<3> from = draft_.pieces[neck.pieces[0]].piece.center;
      const double half = 0.5 * neck.distance;
      const Vector<3> middle = from + half * neck.axis;
      const double reach = half + draft_.sizes.largest_radius() + neck.asked + edge_of(neck);
      grid_.for_each_near(draft_.boundary.wrap(middle), reach, [&](std::uint32_t j, const Vector<3>& d) {
        const double along = d.dot(neck.axis), r = spheres_.r[j];
        const double beside = (d - along * neck.axis).norm();
        if (beside < 1e-6 * r) return;  // one of its own
        const double outside = std::max(0.0, std::abs(along) - half);
        const double room = std::hypot(beside, outside) - r - 0.25 * edge_of(neck);
        if (room < neck.asked) narrow(neck, room);
      });
    }
  }

  void narrow(const DraftNeck& neck, double radius) {
    if (!(radius > least_share * neck.asked))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a bridge at sphere {} has no room between others; a smaller radius of bridges "
                              "or a smaller gap makes room",
                              draft_.pieces[neck.pieces[0]].piece.sphere));
    limit_[neck.bond] = std::min(limit_[neck.bond], radius);
  }

  void finish(std::uint32_t n) {
    DraftNeck& neck = draft_.necks[n];
    neck.radius = std::min(neck.asked, limit_[neck.bond]);
    neck.across = neck.axis.unitOrthogonal();
    const Piece& first = draft_.pieces[neck.pieces[0]].piece;
    const double a = neck.radius, depth = std::sqrt(first.radius * first.radius - a * a);
    double other_depth = 0;
    if (!neck.wall) {
      const double r = draft_.pieces[neck.pieces[1]].piece.radius;
      other_depth = std::sqrt(r * r - a * a);
    }
    const double height = neck.distance - depth - other_depth;
    neck.count = draft_.sizes.neck_count(a, least_radius(neck), height - least_height_less(neck));
    const double edge = 2 * pi * a / static_cast<double>(neck.count);
    neck.rows = static_cast<std::size_t>(std::max(1.0, std::nearbyint(height / (0.87 * edge))));
    const Vector<3> around = neck.axis.cross(neck.across);
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t k = 0; k < neck.count; ++k) {
        const double t = 2 * pi *
                         (static_cast<double>(k) + (e == 1 ? 0.5 * static_cast<double>(neck.rows) : 0.0)) /
                         static_cast<double>(neck.count);
        const Vector<3> beside = a * (std::cos(t) * neck.across + std::sin(t) * around);
        const Vector<3> p =
            e == 0 ? Vector<3>(first.center + depth * neck.axis + beside)
            : !neck.wall
                ? Vector<3>(draft_.pieces[neck.pieces[1]].piece.center - other_depth * neck.axis + beside)
                : foot_of(draft_, neck, beside);
        neck.rims[e].push_back(draft_.add_vertex(p, edge));
      }
    neck.volume =
        pi * a * a * (neck.distance - depth - other_depth) - cap_volume(first.radius, first.radius - depth);
    if (!neck.wall) {
      const double r = draft_.pieces[neck.pieces[1]].piece.radius;
      neck.volume -= cap_volume(r, r - other_depth);
    } else if (const double bulge = beyond_tangent(neck); bulge != 0) {
      neck.volume -= bulge;
    }
    put_on_pieces(n, depth, other_depth, edge);
    if (n == 0 || draft_.necks[n - 1].bond != neck.bond) draft_.made.statement.contact_area += pi * a * a;
    draft_.made.necks.push_back({first.sphere, {}, neck.wall.value_or(0), a});
    if (!neck.wall) draft_.made.necks.back().other = draft_.pieces[neck.pieces[1]].piece.sphere;
    if (a < neck.asked) {
      ++draft_.made.statement.shrunk_necks;
      draft_.made.statement.largest_shrink =
          std::max(draft_.made.statement.largest_shrink, 1 - a / neck.asked);
    }
  }

  /// By how much a neck to a round wall is lower at most beside its middle.
  double least_height_less(const DraftNeck& neck) const {
    const double a = neck.radius, radius = radius_of_wall(solids_.domain, neck);
    return radius > 0 ? a * a / (radius + std::sqrt(radius * radius - a * a)) : 0;
  }

  /// What a neck to a round wall lacks between its tangent plane and the wall. Of a cylinder the integral
  /// over the neck's section of R - sqrt(R² - x²), by Gauss and Chebyshev's rule.
  double beyond_tangent(const DraftNeck& neck) const {
    const double a = neck.radius, radius = radius_of_wall(solids_.domain, neck);
    if (!(radius > 0)) return 0;
    if (std::holds_alternative<Sphere>(solids_.domain)) {
      const double lower = least_height_less(neck);
      return pi * a * a * lower - cap_volume(radius, lower);
    }
    constexpr int nodes = 48;
    double sum = 0;
    for (int k = 1; k <= nodes; ++k) {
      const double t = pi * k / (nodes + 1), x = a * std::cos(t), s = std::sin(t);
      sum += s * s * (x * x / (radius + std::sqrt(radius * radius - x * x)));
    }
    return 2 * a * a * pi / (nodes + 1) * sum;
  }

  void put_on_pieces(std::uint32_t n, double depth, double other_depth, double edge) {
    const DraftNeck& neck = draft_.necks[n];
    Circle circle;
    circle.kind = Circle::Kind::neck;
    circle.neck = n;
    circle.radius = neck.radius;
    circle.edge = edge;
    circle.is_whole = true;
    circle.normal = neck.axis;
    circle.depth = depth;
    circle.chains = {neck.rims[0]};
    draft_.pieces[neck.pieces[0]].circles.push_back(circle);
    if (neck.wall) return;
    circle.normal = -neck.axis;
    circle.depth = other_depth;
    circle.chains = {{neck.rims[1].rbegin(), neck.rims[1].rend()}};
    draft_.pieces[neck.pieces[1]].circles.push_back(circle);
  }

  SurfaceDraft& draft_;
  const Solids& solids_;
  Spheres<3> spheres_;
  PointGrid<3> grid_;
  std::optional<FlatFeet> feet_;  ///< in a mesh
  std::uint32_t bonds_ = 0;
  std::vector<double> limit_;  ///< of the radius, by bond
};

}  // namespace

Vector<3> foot_of(const SurfaceDraft& draft, const DraftNeck& neck, const Vector<3>& beside) {
  Vector<3> p = draft.pieces[neck.pieces[0]].piece.center + beside + neck.distance * neck.axis;
  if (const auto* box = std::get_if<Box>(&draft.solids.domain)) {
    const int k = static_cast<int>(*neck.wall / 2);
    p[k] = *neck.wall % 2 == 0 ? box->corner[k] : box->corner[k] + box->size[k];
  } else if (const double radius = radius_of_wall(draft.solids.domain, neck); radius > 0) {
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
