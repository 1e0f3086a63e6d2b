#include "verify/judge.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "bernal/core/error.hpp"
#include "core/every_dimension.hpp"
#include "verify/mesh_wall.hpp"
#include "verify/polygon_wall.hpp"
#include "verify/predicates.hpp"
#include "verify/repeated_wall.hpp"
#include "verify/revolved_wall.hpp"
#include "verify/true_wall.hpp"

namespace bernal::verify {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0; }

/// Tests a ball against a container's few pieces of wall.
template <int D>
class PieceJudge {
 public:
  PieceJudge(const Ball<D>& ball, const CertifyOptions& options, Tally& tally)
      : reach_{ball.r, options.wall_gap}, arithmetic_(options.arithmetic), tally_(tally) {}

  const Reach& reach() const { return reach_; }

  /// `clearance` is the signed distance of the centre from the piece, in double.
  template <class Predicate>
  void piece(double clearance, const Predicate& predicate) {
    ++tally_.walls;
    const bool holds = decide(arithmetic_, tally_.decisions, predicate) == Truth::yes;
    state_.add(clearance, reach_, holds);
  }

  const WallState& state() const { return state_; }

 private:
  Reach reach_;
  Arithmetic arithmetic_;
  Tally& tally_;
  WallState state_;
};

/// In any dimension; only non-periodic axes have walls.
template <int D>
class BoxWall {
 public:
  explicit BoxWall(const bernal::Box& box) : box_(box) {
    for (int k = 0; k < D; ++k)
      require(!box.has_wall(k) || (std::isfinite(box.corner[k]) && positive(box.size[k]) &&
                                   std::isfinite(box.corner[k] + box.size[k])),
              "a box needs a finite corner and a positive finite size");
  }

  WallState wall_state_of(const Ball<D>& ball, const CertifyOptions& options, Tally& tally) const {
    PieceJudge judge(ball, options, tally);
    for (int k = 0; k < D; ++k) {
      if (!box_.has_wall(k)) continue;
      const double c = ball.c[k], lower = box_.corner[k], size = box_.size[k];
      const Reach& r = judge.reach();
      judge.piece(c - lower, [&]<class Number>() { return above<Number>(c, r, lower); });
      judge.piece(lower + size - c, [&]<class Number>() { return below<Number>(c, r, lower, size); });
    }
    return judge.state();
  }

 private:
  const bernal::Box& box_;
};

class SphereWall {
 public:
  explicit SphereWall(const Sphere& sphere) : sphere_(sphere) {
    require(sphere.center.allFinite() && positive(sphere.radius),
            "a sphere needs a finite centre and a positive finite radius");
  }

  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, Tally& tally) const {
    const Vector<3> d = ball.c - sphere_.center;
    PieceJudge judge(ball, options, tally);
    judge.piece(sphere_.radius - std::hypot(d[0], d[1], d[2]),
                [&]<class Number>() { return ball_in_ball<Number>(ball.c, judge.reach(), sphere_); });
    return judge.state();
  }

 private:
  const Sphere& sphere_;
};

class CylinderWall {
 public:
  explicit CylinderWall(const Cylinder& cylinder) : cylinder_(cylinder) {
    require(
        cylinder.base.allFinite() && cylinder.axis.allFinite() && !cylinder.axis.isZero(0) &&
            positive(cylinder.radius) && positive(cylinder.height),
        "a cylinder needs a finite base, an axis that is not zero, and a positive finite radius and height");
    unit_axis_ = cylinder.axis.stableNormalized();
  }

  WallState wall_state_of(const Ball<3>& ball, const CertifyOptions& options, Tally& tally) const {
    const Vector<3> w = ball.c - cylinder_.base;
    const Vector<3> across = w.cross(unit_axis_);
    const double height = w.dot(unit_axis_);
    PieceJudge judge(ball, options, tally);
    if (!cylinder_.periodic) judge_lids(judge, ball, height);
    judge.piece(cylinder_.radius - std::hypot(across[0], across[1], across[2]),
                [&]<class Number>() { return inside_side<Number>(ball.c, judge.reach(), cylinder_); });
    return judge.state();
  }

 private:
  void judge_lids(PieceJudge<3>& judge, const Ball<3>& ball, double height) const {
    judge.piece(height, [&]<class Number>() { return above_base<Number>(ball.c, judge.reach(), cylinder_); });
    judge.piece(cylinder_.height - height,
                [&]<class Number>() { return below_top<Number>(ball.c, judge.reach(), cylinder_); });
  }

  const Cylinder& cylinder_;
  Vector<3> unit_axis_;
};

template <int D, class Wall>
Walls<D> made(Wall wall) {
  return [wall = std::make_shared<const Wall>(std::move(wall))](const Ball<D>& ball,
                                                                const CertifyOptions& options, Tally& tally) {
    return wall->wall_state_of(ball, options, tally);
  };
}

}  // namespace

static_assert(std::variant_size_v<Domain> == 6, "walls_of needs the walls of the new container");

template <int D>
Walls<D> walls_of(const Domain& domain) {
  if (const auto* box = std::get_if<bernal::Box>(&domain)) return made<D>(BoxWall<D>(*box));
  if constexpr (D == 2) return made<D>(PolygonWall(std::get<Polygon>(domain)));
  if constexpr (D == 3) {
    if (const auto* cylinder = std::get_if<Cylinder>(&domain)) return made<D>(CylinderWall(*cylinder));
    if (const auto* sphere = std::get_if<Sphere>(&domain)) return made<D>(SphereWall(*sphere));
    if (const auto* revolved = std::get_if<Revolved>(&domain)) return made<D>(RevolvedWall(*revolved));
    const Mesh& mesh = std::get<Mesh>(domain);
    if (mesh.repeats()) return made<D>(RepeatedWall(mesh));
    return mesh.surface ? made<D>(TrueWall(mesh)) : made<D>(MeshWall(mesh));
  }
  return [](const Ball<D>&, const CertifyOptions&, Tally&) { return WallState(); };
}

template <int D>
Tally judge_walls(std::span<const Ball<D>> balls, const Walls<D>& walls, const Job& job) {
  return job.for_each("walls", balls.size(), 64, [&](std::size_t i, Tally& tally) {
    const WallState state = walls(balls[i], job.options(), tally);
    tally.add_ball({balls[i].index, state.gap}, state.inside);
    tally.least_wall_distance = std::min(tally.least_wall_distance, state.distance);
  });
}

#define BERNAL_INSTANTIATE(D)                \
  template Walls<D> walls_of(const Domain&); \
  template Tally judge_walls(std::span<const Ball<D>>, const Walls<D>&, const Job&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal::verify
