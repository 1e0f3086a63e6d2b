#include "verify/judge_walls.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <Eigen/Geometry>

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
class PieceJudge {
 public:
  PieceJudge(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally)
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
  const Ball<3>& ball_;
  Arithmetic arithmetic_;
  Tally& tally_;
  bool inside_ = true;
};

class BoxWall {
 public:
  explicit BoxWall(const BoxShape& box) : lower_(box.corner), upper_(box.corner + box.size) {
    require(lower_.allFinite() && upper_.allFinite() && (lower_.array() < upper_.array()).all(),
            "a box needs a finite corner and a positive finite size");
  }

  bool inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const {
    PieceJudge judge(ball, arithmetic, tally);
    for (int k = 0; k < 3; ++k) {
      const double c = ball.c[k], r = ball.r, lower = lower_[k], upper = upper_[k];
      judge.piece(c - lower, [=]<class Number>() { return above<Number>(c, r, lower); });
      judge.piece(upper - c, [=]<class Number>() { return below<Number>(c, r, upper); });
    }
    return judge.inside();
  }

 private:
  Vector<3> lower_;
  Vector<3> upper_;
};

class SphereWall {
 public:
  explicit SphereWall(const SphereShape& sphere) : sphere_(sphere) {
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
  const SphereShape& sphere_;
};

class CylinderWall {
 public:
  explicit CylinderWall(const CylinderShape& cylinder) : cylinder_(cylinder) {
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
    judge.piece(height, [&]<class Number>() { return above_base<Number>(ball.c, ball.r, cylinder_); });
    judge.piece(cylinder_.height - height,
                [&]<class Number>() { return below_top<Number>(ball.c, ball.r, cylinder_); });
    judge.piece(cylinder_.radius - std::hypot(across[0], across[1], across[2]),
                [&]<class Number>() { return inside_side<Number>(ball.c, ball.r, cylinder_); });
    return judge.inside();
  }

 private:
  const CylinderShape& cylinder_;
  Vector<3> unit_axis_;
};

template <class Wall>
Tally judge_all(const BallTree<3>& balls, const Wall& wall, Arithmetic arithmetic) {
  const auto all = balls.items();
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, all.size(), 64), Tally{},
      [&](const tbb::blocked_range<std::size_t>& range, Tally tally) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          if (!wall.inside(all[i], arithmetic, tally)) ++tally.protruding;
        return tally;
      },
      [](Tally a, const Tally& b) { return a += b; });
}

struct JudgeShape {
  const BallTree<3>& balls;
  Arithmetic arithmetic;

  Tally operator()(const BoxShape& s) const { return judge_all(balls, BoxWall(s), arithmetic); }
  Tally operator()(const CylinderShape& s) const { return judge_all(balls, CylinderWall(s), arithmetic); }
  Tally operator()(const SphereShape& s) const { return judge_all(balls, SphereWall(s), arithmetic); }
  Tally operator()(const Mesh& s) const { return judge_all(balls, MeshWall(s), arithmetic); }
};

}  // namespace

Tally judge_walls(const BallTree<3>& balls, const Shape& container, Arithmetic arithmetic) {
  return std::visit(JudgeShape{balls, arithmetic}, container);
}

}  // namespace bernal::verify
