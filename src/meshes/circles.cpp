// Points on the circles in which pieces are cut: at ends of periods, the same at opposite ends, and by caps.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

using std::numbers::pi;

/// Directions in the plane of a circle.
struct CircleFrame {
  Vector<3> u, v;
};
CircleFrame frame_of(const Circle& circle) {
  const Vector<3> u = circle.normal.unitOrthogonal();
  return {u, circle.normal.cross(u)};
}

/// A part of a circle, from angle to angle, with the circles that end it; whole if it ends nowhere.
struct Arc {
  double from, to;
  std::array<std::size_t, 2> ended_by;
};

class Circles {
 public:
  explicit Circles(SurfaceDraft& draft) : draft_(draft) {
    for (std::uint32_t p = 0; p < draft.pieces.size(); ++p)
      numbers_[{draft.pieces[p].piece.sphere, draft.pieces[p].piece.image}] = p;
    near_.resize(draft.pieces.size());
    has_near_.resize(draft.pieces.size(), 0);
  }

  void make() {
    for (DraftPiece& piece : draft_.pieces)
      for (const Cut& cut : piece.piece.cuts) {
        Circle circle;
        circle.kind = cut.face == Cut::contact ? Circle::Kind::contact : Circle::Kind::end;
        circle.face = cut.face;
        circle.normal = cut.keeps.normal;
        circle.depth = cut.keeps.offset - cut.keeps.normal.dot(piece.piece.center);
        const double r = piece.piece.radius;
        circle.radius = std::sqrt(std::max(0.0, r * r - circle.depth * circle.depth));
        piece.circles.push_back(circle);
      }
    for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p)
      for (std::size_t c = 0; c < draft_.pieces[p].circles.size(); ++c)
        if (draft_.pieces[p].circles[c].kind != Circle::Kind::neck) fill(p, c);
  }

 private:
  std::uint32_t piece_moved(std::uint32_t p, int axis, int by) const {
    auto image = draft_.pieces[p].piece.image;
    image[static_cast<std::size_t>(axis)] += by;
    const auto found = numbers_.find({draft_.pieces[p].piece.sphere, image});
    if (found == numbers_.end())
      throw Error(ErrorCode::bad_argument, "a sphere at the end of a period has no image at the other end");
    return found->second;
  }

  std::size_t circle_at(std::uint32_t p, int face) const {
    const auto& circles = draft_.pieces[p].circles;
    for (std::size_t c = 0; c < circles.size(); ++c)
      if (circles[c].kind == Circle::Kind::end && circles[c].face == face) return c;
    throw Error(ErrorCode::bad_argument, "a sphere at the end of a period has no image at the other end");
  }

  const std::vector<NearBall>& near_of(std::uint32_t p) {
    if (!has_near_[p]) {
      near_[p] = draft_.sizes.near(draft_.pieces[p].piece.center, draft_.pieces[p].piece.sphere);
      has_near_[p] = 1;
    }
    return near_[p];
  }

  /// Where two circles of a piece cross: the point on the side of `side` of the plane through the centre and
  /// both normals.
  Vector<3> crossing(std::uint32_t p, std::size_t a, std::size_t b, int side) const {
    const Piece& piece = draft_.pieces[p].piece;
    const Circle &one = draft_.pieces[p].circles[a], &other = draft_.pieces[p].circles[b];
    const double c = one.normal.dot(other.normal), sine2 = 1 - c * c;
    const Vector<3> foot =
        ((one.depth - c * other.depth) * one.normal + (other.depth - c * one.depth) * other.normal) / sine2;
    const double along = std::sqrt(std::max(0.0, piece.radius * piece.radius - foot.squaredNorm()));
    Vector<3> q = piece.center + foot + side * along * one.normal.cross(other.normal).normalized();
    for (const Circle* end : {&one, &other})
      if (end->kind == Circle::Kind::end)
        q[end->face / 2] = std::abs(end->face % 2) == 0
                               ? draft_.boundary.origin[end->face / 2]
                               : draft_.boundary.origin[end->face / 2] + draft_.boundary.edges[end->face / 2];
    return q;
  }

  /// The vertex where two circles of a piece cross; `at`: about where. At ends it is that of the image at the
  /// lower ends, moved.
  std::uint32_t corner(std::uint32_t p, std::size_t a, std::size_t b, const Vector<3>& at) {
    for (const std::size_t c : {a, b}) {
      const Circle& circle = draft_.pieces[p].circles[c];
      if (circle.kind != Circle::Kind::end || circle.face % 2 == 0) continue;
      const int axis = circle.face / 2;
      const std::uint32_t lower = piece_moved(p, axis, -1);
      const auto same = [&](std::size_t of) {
        const Circle& wanted = draft_.pieces[p].circles[of];
        if (wanted.kind == Circle::Kind::end)
          return circle_at(lower, of == c ? wanted.face - 1 : wanted.face);
        return contact_like(lower, wanted);
      };
      const Vector<3> moved = at - draft_.boundary.edges[axis] * Vector<3>::Unit(axis);
      return draft_.lifted(axis, corner(lower, same(a), same(b), moved));
    }
    if (a > b) std::swap(a, b);
    const Circle &one = draft_.pieces[p].circles[a], &other = draft_.pieces[p].circles[b];
    const int side = (at - draft_.pieces[p].piece.center).dot(one.normal.cross(other.normal)) > 0 ? 1 : -1;
    const auto [entry, is_new] = corners_.try_emplace({p, a, b, side}, 0);
    if (is_new) {
      const Vector<3> q = crossing(p, a, b, side);
      const bool is_end = one.kind == Circle::Kind::end || other.kind == Circle::Kind::end;
      const double size = size_at(p, q);
      entry->second = is_end ? draft_.vertex_at(q, size) : draft_.add_vertex(q, size);
    }
    return entry->second;
  }

  std::size_t contact_like(std::uint32_t p, const Circle& wanted) const {
    const auto& circles = draft_.pieces[p].circles;
    for (std::size_t c = 0; c < circles.size(); ++c)
      if (circles[c].kind == Circle::Kind::contact && circles[c].normal == wanted.normal) return c;
    throw Error(ErrorCode::bad_argument, "an image of a sphere has other caps");
  }

  double size_at(std::uint32_t p, const Vector<3>& q) {
    const DraftPiece& piece = draft_.pieces[p];
    return draft_.sizes.on_sphere(q, piece.piece.center, piece.piece.radius, true, near_of(p));
  }

  std::vector<Arc> arcs_of(std::uint32_t p, std::size_t c) const {
    const auto& circles = draft_.pieces[p].circles;
    const Circle& circle = circles[c];
    const auto [u, v] = frame_of(circle);
    struct Gone {
      double from, to;
      std::size_t by;
    };
    std::vector<Gone> gone;
    for (std::size_t j = 0; j < circles.size(); ++j) {
      if (j == c || circles[j].kind == Circle::Kind::neck) continue;
      const double a = circles[j].normal.dot(u), b = circles[j].normal.dot(v), m = std::hypot(a, b);
      const double level = circles[j].depth - circle.depth * circles[j].normal.dot(circle.normal);
      if (level <= -circle.radius * m) return {};
      if (level >= circle.radius * m) continue;
      const double middle = std::atan2(b, a), half = std::acos(level / (circle.radius * m));
      double from = middle - half;
      from -= 2 * pi * std::floor(from / (2 * pi));
      gone.push_back({from, from + 2 * half, j});
    }
    if (gone.empty()) return {{0, 2 * pi, {c, c}}};
    std::ranges::sort(gone, {}, &Gone::from);
    std::vector<Arc> arcs;
    // The end of what is gone so far, begun a turn before.
    const auto last = std::ranges::max_element(gone, {}, &Gone::to);
    double end = last->to - 2 * pi;
    std::size_t by = last->by;
    for (const Gone& g : gone) {
      if (g.from > end) arcs.push_back({end, g.from, {by, g.by}});
      if (g.to > end) {
        end = g.to;
        by = g.by;
      }
    }
    std::erase_if(arcs, [](const Arc& arc) { return arc.to - arc.from < 1e-9; });
    return arcs;
  }

  void fill(std::uint32_t p, std::size_t c) {
    Circle& circle = draft_.pieces[p].circles[c];
    if (!circle.chains.empty() || circle.is_whole) return;
    if (circle.kind == Circle::Kind::end && circle.face % 2 == 1) {
      const int axis = circle.face / 2;
      const std::uint32_t lower = piece_moved(p, axis, -1);
      const std::size_t there = circle_at(lower, circle.face - 1);
      fill(lower, there);
      const Circle& given = draft_.pieces[lower].circles[there];
      circle.is_whole = given.is_whole;
      for (const auto& chain : given.chains) {  // which runs about the opposite normal
        auto& own = circle.chains.emplace_back();
        for (auto id = chain.rbegin(); id != chain.rend(); ++id) own.push_back(draft_.lifted(axis, *id));
      }
      return;
    }
    const Piece& piece = draft_.pieces[p].piece;
    const auto [u, v] = frame_of(circle);
    const auto at = [&](double t) {
      Vector<3> q =
          piece.center + circle.depth * circle.normal + circle.radius * (std::cos(t) * u + std::sin(t) * v);
      if (circle.kind == Circle::Kind::end) q[circle.face / 2] = draft_.boundary.origin[circle.face / 2];
      return q;
    };
    for (const Arc& arc : arcs_of(p, c)) {
      circle.is_whole = arc.ended_by[0] == c;
      const std::vector<double> angles = angles_of(p, circle, arc, at);
      auto& chain = circle.chains.emplace_back();
      if (!circle.is_whole) chain.push_back(corner(p, c, arc.ended_by[0], at(arc.from)));
      for (const double t : angles) {
        const Vector<3> q = at(t);
        const double size = size_at(p, q);
        chain.push_back(circle.kind == Circle::Kind::end ? draft_.vertex_at(q, size)
                                                         : draft_.add_vertex(q, size));
      }
      if (!circle.is_whole) chain.push_back(corner(p, c, arc.ended_by[1], at(arc.to)));
    }
  }

  /// Angles of points along an arc, without its ends, as many as the sizes there ask for.
  std::vector<double> angles_of(std::uint32_t p, const Circle& circle, const Arc& arc, const auto& at) {
    constexpr double least_per_turn = 8;
    const double turn = arc.to - arc.from;
    std::vector<double> angles;
    if (circle.is_whole) angles.push_back(arc.from);
    for (const double share : spaced(turn * circle.radius, circle.is_whole ? 8 : 2, [&](double t) {
           return std::min(size_at(p, at(arc.from + t * turn)), 2 * pi / least_per_turn * circle.radius);
         }))
      angles.push_back(arc.from + share * turn);
    return angles;
  }

  SurfaceDraft& draft_;
  std::map<std::pair<std::uint32_t, std::array<int, 3>>, std::uint32_t> numbers_;
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t, int>, std::uint32_t> corners_;
  std::vector<std::vector<NearBall>> near_;
  std::vector<char> has_near_;
};

}  // namespace

void add_circles(SurfaceDraft& draft) { Circles(draft).make(); }

}  // namespace bernal
