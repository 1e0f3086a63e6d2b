#include "bernal/measure/rest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "near/sphere_tree.hpp"

namespace bernal {
namespace {

/// Movement that keeps less than this share of the fall is rolling.
constexpr double least_share = 0.5;
/// With more upright walls at once there is no way down.
constexpr std::size_t most_upright = 8;
/// A sphere is not met if the slope (sine) of its surface along the path is at most this: rounding may cause
/// as much for a sphere beside it.
constexpr double beside = 1e-6;
/// A hanging sphere falls past walls as a ball smaller by this share; otherwise walls that are upright to
/// rounding would stop it.
constexpr double grazing = 1e-3;
/// Walls whose normals differ by a smaller angle (1 - cosine) count once.
constexpr double same_normal = 1e-6;
constexpr double rounding_of_normals = 1e-9;
/// A round wall holds a sphere on all sides if its play is at most this many contact gaps.
constexpr double snug = 10;

using Normals = std::vector<Vector<3>>;  // unit, from walls to the sphere

/// The steepest unit vector that leads into none of the walls; zero if there is none.
Vector<3> way_past(const Vector<3>& direction, const Normals& normals) {
  Vector<3> best = Vector<3>::Zero();
  const auto offer = [&](const Vector<3>& way) {
    if (!(way.norm() > rounding_of_normals)) return;
    const Vector<3> u = way.normalized();
    if (direction.dot(u) > direction.dot(best) &&
        std::ranges::all_of(normals, [&](const auto& n) { return n.dot(u) > -rounding_of_normals; }))
      best = u;
  };
  offer(direction);
  for (std::size_t a = 0; a < normals.size(); ++a) {
    offer(direction - direction.dot(normals[a]) * normals[a]);
    for (std::size_t b = 0; b < a; ++b) {
      const Vector<3> line = normals[a].cross(normals[b]);
      offer(line.dot(direction) * line);
    }
  }
  return best;
}

/// The spheres between their walls, in the walls' frame.
class SpheresInWalls {
 public:
  SpheresInWalls(const Spheres<3>& spheres, const Boundary<3>& boundary, const Container& container,
                 const Vector<3>& direction, double tolerance)
      : spheres_(spheres),
        tree_(spheres, boundary),
        container_(container),
        direction_(direction),
        closed_(std::max(Rest::closed, tolerance)),
        level_(std::max(Rest::level, tolerance)),
        least_closed_(2 * tolerance::skin(std::ranges::min(spheres.r), container.resolution())) {}

  /// The sine of the steepest free way down for sphere i; 0 if it rests. Only a few contacts matter: those
  /// are added one by one that the best way past the others leads into most.
  double slope(std::size_t i) const {
    const Normals normals = normals_at(i);
    Normals few;
    double steepest = 0;
    for (std::size_t k = 0; k <= normals.size(); ++k) {
      const Vector<3> way = way_past(direction_, few);
      steepest = way.dot(direction_);
      if (steepest <= level_) return 0;
      const auto into = [&](const Vector<3>& n) { return n.dot(way); };
      const auto most = std::ranges::min_element(normals, {}, into);
      if (most == normals.end() || into(*most) > -rounding_of_normals) return steepest;
      few.push_back(*most);
    }
    return steepest;
  }

  bool hangs(std::size_t i) const { return !way_down(i).isZero(0); }

  /// The length of a hanging sphere's fall.
  double fall(std::size_t i) const {
    const double r = spheres_.r[i], start = Rest::least_fall * r;
    const Vector<3> p = spheres_.center(i) + start * way_down(i);
    const double limit = first_sphere(i, p, direction_, container_.bounds().size().norm());
    const double wall = container_.free_path(p, (1 - grazing) * r, direction_, limit + grazing * r);
    return start + std::clamp(wall - grazing * r, 0.0, limit);
  }

 private:
  /// Distance that sphere i, placed at p, can move along u until it meets another; at most `limit`.
  double first_sphere(std::size_t i, const Vector<3>& p, const Vector<3>& u, double limit) const {
    const double r = spheres_.r[i];
    tree_.for_each_on_way(p, r, u, limit, [&](std::uint32_t place, const Vector<3>& center) {
      if (tree_.id(place) == i) return limit;
      const Vector<3> to = center - p;
      const double sum = r + tree_.radius(place), along = to.dot(u);
      const double squared_slope = 1 - (to - along * u).squaredNorm() / (sum * sum);
      if (along > 0 && squared_slope > beside * beside)
        limit = std::clamp(along - sum * std::sqrt(squared_slope), 0.0, limit);
      return limit;
    });
    return limit;
  }

  /// Unit normals of the contacts of sphere i, towards it; one for walls with equal normals.
  Normals normals_at(std::size_t i) const {
    const Vector<3> p = spheres_.center(i);
    const double r = spheres_.r[i], reach = r + std::max(closed_ * r, least_closed_);
    Normals normals;
    tree_.for_each_on_way(p, reach, direction_, 0, [&](std::uint32_t place, const Vector<3>& center) {
      const Vector<3> away = p - center;
      if (tree_.id(place) != i && away.norm() <= reach + tree_.radius(place))
        normals.push_back(away.normalized());
      return 0.0;
    });
    thread_local std::vector<NearFacet> near;
    near.clear();
    container_.facets_near(p, reach, near);
    for (const NearFacet& n : near) {
      if (!has_border(n.facet.kind) && n.facet.kind != Facet::Kind::plane &&
          n.facet.radius - r <= snug * (reach - r))
        add_all_around(normals, n.facet);
      else
        add_new(normals, p - closest_point(n.facet, p));
    }
    return normals;
  }

  /// Normals of a round wall into which the sphere just fits, which holds it on all sides.
  void add_all_around(Normals& normals, const Facet& round) const {
    const bool has_axis = round.kind == Facet::Kind::cylinder;
    const Vector<3> across = has_axis ? Vector<3>(round.b.unitOrthogonal()) : direction_;
    for (const Vector<3>& n : {across, Vector<3>(has_axis ? round.b.cross(across) : across)}) {
      add_new(normals, n);
      add_new(normals, -n);
    }
  }

  static bool is_known(const Normals& normals, const Vector<3>& n) {
    return std::ranges::any_of(normals, [&](const auto& other) { return other.dot(n) > 1 - same_normal; });
  }
  static void add_new(Normals& normals, const Vector<3>& away) {
    const Vector<3> n = away.normalized();
    if (!is_known(normals, n)) normals.push_back(n);
  }

  /// The unit vector along which sphere i can move past upright walls; zero if it cannot.
  Vector<3> way_down(std::size_t i) const {
    const double step = Rest::least_fall * spheres_.r[i];
    Normals upright;
    while (upright.size() < most_upright) {
      const Vector<3> u = way_past(direction_, upright);
      if (u.dot(direction_) < least_share || first_sphere(i, spheres_.center(i), u, step) < step) break;
      const std::size_t known = upright.size();
      if (wall_supports(i, u, upright)) break;
      if (upright.size() == known) return u;
    }
    return Vector<3>::Zero();
  }

  /// Whether a wall supports sphere i after a move along u; otherwise appends the walls that it then
  /// overlaps.
  bool wall_supports(std::size_t i, const Vector<3>& u, Normals& upright) const {
    const double r = spheres_.r[i];
    const Vector<3> p = spheres_.center(i) + Rest::least_fall * r * u;
    thread_local std::vector<NearFacet> near;
    near.clear();
    container_.facets_near(p, r, near);
    for (const NearFacet& n : near) {
      const Vector<3> away = p - closest_point(n.facet, p);
      const Vector<3> normal = away.norm() > 0 ? away.normalized() : Vector<3>(-direction_);
      if (normal.dot(direction_) < -Rest::upright) return true;
      if (normal.dot(u) < 0) add_new(upright, normal);
    }
    return false;
  }

  const Spheres<3>& spheres_;
  SphereTree<3> tree_;
  const Container& container_;
  Vector<3> direction_;
  double closed_, level_;
  double least_closed_;  // if coordinates are too coarse for a millionth of a radius
};

constexpr std::string_view how_to_import =
    "for the packing of another program, import with ‹periodic=none› makes its box walls";

Rest rest_in(const Spheres<dynamic>& spheres, const Domain& domain, const Vector<3>& direction,
             const RestOptions& options, const std::shared_ptr<const Container>& made) {
  const int dimension = dimension_of(domain);
  if (dimension < 2 || dimension > 3 || !has_walls(domain))
    throw Error(ErrorCode::bad_argument,
                fmt::format("a bed rests on walls, in two or three dimensions, and this domain has none; {}",
                            how_to_import));
  Rest rest;
  if (spheres.empty()) return rest;
  const Frame frame = frame_of(domain);
  const std::shared_ptr<const Container> container = local_container(domain, made);
  if (!direction.cwiseProduct(container->boundary().edges).isZero(0))
    throw Error(ErrorCode::bad_argument,
                fmt::format("a bed rests on a floor, and this domain repeats itself along the direction of "
                            "gravity; {}",
                            how_to_import));
  const Spheres<3> local = localised(spheres, frame);
  const SpheresInWalls bed(local, container->boundary(), *container, direction.normalized(),
                           options.tolerance);
  std::vector<double> slopes(local.size(), 0), falls(local.size(), 0), held(local.size(), 0);
  const double flattest = std::sin(options.friction * std::numbers::pi / 180) + Rest::level;
  parallel_ranges(local.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      slopes[i] = bed.slope(i);
      if (options.friction > 0 && slopes[i] <= flattest)
        held[i] = std::exchange(slopes[i], 0);
      else if (slopes[i] > 0 && bed.hangs(i))
        falls[i] = bed.fall(i);
    }
  });
  for (std::size_t i = 0; i < local.size(); ++i) {
    rest.hanging += falls[i] > 0;
    rest.unsettled += slopes[i] > 0;
    rest.held_by_friction += held[i] > 0;
    if (options.list && slopes[i] > 0) rest.list.push_back({i, slopes[i], frame.scale * falls[i]});
  }
  rest.friction = std::asin(std::ranges::max(held)) * 180 / std::numbers::pi;
  rest.farthest = frame.scale * std::ranges::max(falls);
  std::ranges::stable_sort(rest.list, [](const auto& a, const auto& b) {
    return std::tie(a.fall, a.slope) > std::tie(b.fall, b.slope);
  });
  return rest;
}

}  // namespace

Rest measure_rest(const Spheres<dynamic>& spheres, const Domain& domain, const Vector<3>& direction,
                  const RestOptions& options, const std::shared_ptr<const Container>& made) {
  const double gap = options.gap, wall_gap = options.wall_gap + margin_of(domain);
  if (gap == 0 && wall_gap == 0) return rest_in(spheres, domain, direction, options, made);
  Spheres<dynamic> with_coats = spheres;
  for (double& r : with_coats.r) r += 0.5 * gap;
  return rest_in(with_coats, with_walls_moved(domain, wall_gap - 0.5 * gap), direction, options, {});
}

}  // namespace bernal
