#include "verify/judge_walls.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <Eigen/Geometry>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "verify/mesh_wall.hpp"
#include "verify/predicates.hpp"

namespace bernal::verify {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw Error(ErrorCode::bad_argument, what);
}

bool positive(double x) { return std::isfinite(x) && x > 0; }

/// Tries one ball against the pieces of wall of a container that has few.
template <int D>
class PieceJudge {
 public:
  PieceJudge(const Ball<D>& ball, Arithmetic arithmetic, Tally& tally)
      : ball_(ball), arithmetic_(arithmetic), tally_(tally) {}

  /// `clearance` is the signed distance of the centre from the piece, in double.
  template <class Predicate>
  void piece(double clearance, const Predicate& predicate) {
    ++tally_.walls;
    const bool holds = decide(arithmetic_, tally_, predicate) == Truth::yes;
    inside_ = inside_ && holds;
    tally_.add_wall_ratio(ball_.index, with_sign((clearance - ball_.r) / ball_.r, holds));
  }

  bool inside() const { return inside_; }

 private:
  const Ball<D>& ball_;
  Arithmetic arithmetic_;
  Tally& tally_;
  bool inside_ = true;
};

/// Of any dimension; only the axes that end have walls.
template <int D>
class BoxWall {
 public:
  explicit BoxWall(const bernal::Box& box) : box_(box), lower_(box.corner), upper_(box.corner + box.size) {
    require(lower_.allFinite() && upper_.allFinite() && (lower_.array() < upper_.array()).all(),
            "a box needs a finite corner and a positive finite size");
  }

  bool inside(const Ball<D>& ball, Arithmetic arithmetic, Tally& tally) const {
    PieceJudge judge(ball, arithmetic, tally);
    for (int k = 0; k < D; ++k) {
      if (!box_.has_wall(k)) continue;
      const double c = ball.c[k], r = ball.r, lower = lower_[k], upper = upper_[k];
      judge.piece(c - lower, [=]<class Number>() { return above<Number>(c, r, lower); });
      judge.piece(upper - c, [=]<class Number>() { return below<Number>(c, r, upper); });
    }
    return judge.inside();
  }

 private:
  const bernal::Box& box_;
  Vector<D> lower_;
  Vector<D> upper_;
};

class SphereWall {
 public:
  explicit SphereWall(const Sphere& sphere) : sphere_(sphere) {
    require(sphere.center.allFinite() && positive(sphere.radius),
            "a sphere needs a finite centre and a positive finite radius");
  }

  bool inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const {
    const Vector<3> d = ball.c - sphere_.center;
    PieceJudge judge(ball, arithmetic, tally);
    judge.piece(sphere_.radius - std::hypot(d[0], d[1], d[2]),
                [&]<class Number>() { return ball_in_ball<Number>(ball.c, ball.r, sphere_); });
    return judge.inside();
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

  bool inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const {
    const Vector<3> w = ball.c - cylinder_.base;
    const Vector<3> across = w.cross(unit_axis_);
    const double height = w.dot(unit_axis_);
    PieceJudge judge(ball, arithmetic, tally);
    if (!cylinder_.periodic) judge_lids(judge, ball, height);
    judge.piece(cylinder_.radius - std::hypot(across[0], across[1], across[2]),
                [&]<class Number>() { return inside_side<Number>(ball.c, ball.r, cylinder_); });
    return judge.inside();
  }

 private:
  void judge_lids(PieceJudge<3>& judge, const Ball<3>& ball, double height) const {
    judge.piece(height, [&]<class Number>() { return above_base<Number>(ball.c, ball.r, cylinder_); });
    judge.piece(cylinder_.height - height,
                [&]<class Number>() { return below_top<Number>(ball.c, ball.r, cylinder_); });
  }

  const Cylinder& cylinder_;
  Vector<3> unit_axis_;
};

template <int D, class Wall>
void judge(const Ball<D>& ball, const Wall& wall, Arithmetic arithmetic, Tally& tally) {
  if (!wall.inside(ball, arithmetic, tally)) ++tally.protruding;
}

template <class Wall>
Tally judge_all(const BallTree<3>& balls, const Wall& wall, Arithmetic arithmetic) {
  const auto all = balls.items();
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, all.size(), 64), Tally{},
      [&](const tbb::blocked_range<std::size_t>& range, Tally tally) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) judge(all[i], wall, arithmetic, tally);
        return tally;
      },
      [](Tally a, const Tally& b) { return a += b; });
}

struct JudgeBalls {
  const BallTree<3>& balls;
  Arithmetic arithmetic;

  Tally operator()(const bernal::Box& s) const { return judge_all(balls, BoxWall<3>(s), arithmetic); }
  Tally operator()(const Cylinder& s) const { return judge_all(balls, CylinderWall(s), arithmetic); }
  Tally operator()(const Sphere& s) const { return judge_all(balls, SphereWall(s), arithmetic); }
  Tally operator()(const Mesh& s) const { return judge_all(balls, MeshWall(s), arithmetic); }
};

/// One after the other, as they stand in the file.
template <int D, class Wall>
Tally judge_in_order(const Spheres<dynamic>& spheres, const Wall& wall, Arithmetic arithmetic) {
  Tally tally;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    judge(Ball<D>{spheres.center(i), spheres.r[i], i}, wall, arithmetic, tally);
  return tally;
}

}  // namespace

Tally judge_walls(const BallTree<3>& balls, const Domain& container, Arithmetic arithmetic) {
  return std::visit(JudgeBalls{balls, arithmetic}, container);
}

Tally judge_walls(const Spheres<dynamic>& spheres, const Domain& domain, Arithmetic arithmetic) {
  if (const auto* box = std::get_if<bernal::Box>(&domain))
    return with_dimension(box->dimension(), EveryDimension{}, [&](auto dimension) {
      constexpr int D = decltype(dimension)::value;
      return judge_in_order<D>(spheres, BoxWall<D>(*box), arithmetic);
    });
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  require(cylinder, "only boxes and cylinders repeat themselves");
  return judge_in_order<3>(spheres, CylinderWall(*cylinder), arithmetic);
}

}  // namespace bernal::verify
