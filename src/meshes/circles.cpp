// Points on the circles in which pieces are cut: at ends of periods, the same at opposite ends, and by caps.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

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
      for (std::size_t c = 0; c < draft_.pieces[p].circles.size(); ++c) fill(p, c);
    for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p)
      for (std::size_t a = 0; a < draft_.pieces[p].circles.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          if (const std::vector<std::uint32_t> ids = chord(p, b, a); !ids.empty())
            draft_.pieces[p].chords.push_back({{b, a}, ids});
  }

 private:
  /// The image of a piece one period before along an axis; none where it does not reach into the domain, as
  /// it does if a part of its circle at the upper end is in there.
  std::uint32_t piece_before(std::uint32_t p, int axis) const {
    auto image = draft_.pieces[p].piece.image;
    --image[static_cast<std::size_t>(axis)];
    return draft_.piece_at(draft_.pieces[p].piece.sphere, image);
  }

  static std::uint32_t known(std::uint32_t piece) {
    if (piece == Delaunay::none) fail();
    return piece;
  }
  [[noreturn]] static void fail() {
    throw Error(ErrorCode::bad_argument,
                "a sphere touches an end of a period to rounding, where the images of it do not agree");
  }

  std::size_t circle_at(std::uint32_t p, int face) const {
    const auto& circles = draft_.pieces[p].circles;
    for (std::size_t c = 0; c < circles.size(); ++c)
      if (circles[c].kind == Circle::Kind::end && circles[c].face == face) return c;
    fail();
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
    put_on_ends(p, std::array{a, b}, q);
    return q;
  }

  /// The vertex where two circles of a piece cross; `at`: about where. At ends it is that of the image at the
  /// lower ends, moved.
  std::uint32_t corner(std::uint32_t p, std::size_t a, std::size_t b, const Vector<3>& at) {
    for (const std::size_t c : {a, b}) {
      const Circle& circle = draft_.pieces[p].circles[c];
      if (circle.kind != Circle::Kind::end || circle.face % 2 == 0) continue;
      const int axis = circle.face / 2;
      const std::uint32_t lower = known(piece_before(p, axis));
      const auto same = [&](std::size_t of) {
        const Circle& wanted = draft_.pieces[p].circles[of];
        if (wanted.kind == Circle::Kind::end)
          return circle_at(lower, of == c ? wanted.face - 1 : wanted.face);
        return same_as(lower, wanted);
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
      const double size = size_at(p, q);
      entry->second = add(p, std::array{a, b}, q, size);
    }
    return entry->second;
  }

  /// What `of` is, a circle of a piece, at the image one period before.
  std::size_t circle_before(std::uint32_t p, std::uint32_t lower, std::size_t of, int face) const {
    const Circle& wanted = draft_.pieces[p].circles[of];
    if (wanted.kind == Circle::Kind::end)
      return circle_at(lower, wanted.face == face ? face - 1 : wanted.face);
    return same_as(lower, wanted);
  }

  /// An upper end among circles of a piece, or none.
  int upper_among(std::uint32_t p, std::span<const std::size_t> circles) const {
    for (const std::size_t c : circles)
      if (const Circle& circle = draft_.pieces[p].circles[c];
          circle.kind == Circle::Kind::end && circle.face % 2 == 1)
        return circle.face;
    return -1;
  }

  void put_on_ends(std::uint32_t p, std::span<const std::size_t> circles, Vector<3>& q) const {
    for (const std::size_t c : circles)
      if (const Circle& circle = draft_.pieces[p].circles[c]; circle.kind == Circle::Kind::end)
        q[circle.face / 2] = draft_.boundary.origin[circle.face / 2] +
                             (circle.face % 2 == 1 ? draft_.boundary.edges[circle.face / 2] : 0);
  }

  bool has_end(std::uint32_t p, std::span<const std::size_t> circles) const {
    return std::ranges::any_of(
        circles, [&](std::size_t c) { return draft_.pieces[p].circles[c].kind == Circle::Kind::end; });
  }

  std::uint32_t add(std::uint32_t p, std::span<const std::size_t> circles, Vector<3> q, double size) {
    put_on_ends(p, circles, q);
    return has_end(p, circles) ? draft_.vertex_at(q, size) : draft_.add_vertex(q, size);
  }

  /// The vertex inside a ball where three of its planes meet.
  std::uint32_t triple(std::uint32_t p, std::array<std::size_t, 3> of) {
    if (const int face = upper_among(p, of); face >= 0) {
      const std::uint32_t lower = known(piece_before(p, face / 2));
      std::array<std::size_t, 3> there;
      for (std::size_t k = 0; k < 3; ++k) there[k] = circle_before(p, lower, of[k], face);
      return draft_.lifted(face / 2, triple(lower, there));
    }
    std::ranges::sort(of);
    const auto [entry, is_new] = triples_.try_emplace({p, of[0], of[1], of[2]}, 0);
    if (is_new) {
      const auto& circles = draft_.pieces[p].circles;
      Eigen::Matrix3d normals;
      Vector<3> depths;
      for (int k = 0; k < 3; ++k) {
        const Circle& circle = circles[of[static_cast<std::size_t>(k)]];
        normals.row(k) = circle.normal.transpose();
        depths[k] = circle.depth;
      }
      const Vector<3> q = draft_.pieces[p].piece.center + normals.inverse() * depths;
      entry->second = add(p, of, q, chord_size(p, of));
    }
    return entry->second;
  }

  double chord_size(std::uint32_t p, std::span<const std::size_t> circles) const {
    double size = draft_.options.sphere_edge * draft_.pieces[p].piece.radius;
    for (const std::size_t c : circles)
      if (const Circle& circle = draft_.pieces[p].circles[c]; circle.kind == Circle::Kind::neck) {
        const DraftNeck& neck = draft_.necks[circle.neck];
        size = std::min({size, neck.edge, 2 * (neck.end - neck.begin)});
      } else if (circle.kind == Circle::Kind::contact) {
        size = std::min(size, draft_.sizes.at_caps(draft_.pieces[p].piece.radius));
      }
    return size;
  }

  /// Vertices along the part of a line of two planes that is inside a piece; none if there is no such part,
  /// or no flat face needs it.
  std::vector<std::uint32_t> chord(std::uint32_t p, std::size_t a, std::size_t b) {
    const std::array<std::size_t, 2> both = {a, b};
    const auto& circles = draft_.pieces[p].circles;
    const Circle &one = circles[a], &other = circles[b];
    if (!draft_.options.solids && one.kind != Circle::Kind::contact && other.kind != Circle::Kind::contact)
      return {};
    const double c = one.normal.dot(other.normal), sine2 = 1 - c * c;
    if (sine2 < 1e-12) return {};
    if (a > b) return chord(p, b, a);
    if (const auto found = chords_.find({p, a, b}); found != chords_.end()) return found->second;
    const Piece& piece = draft_.pieces[p].piece;
    const Vector<3> foot =
        ((one.depth - c * other.depth) * one.normal + (other.depth - c * one.depth) * other.normal) / sine2;
    const double squared = piece.radius * piece.radius - foot.squaredNorm();
    if (!(squared > 0)) return {};
    const Vector<3> along = one.normal.cross(other.normal).normalized();
    std::array<double, 2> ends = {-std::sqrt(squared), std::sqrt(squared)};
    std::array<std::size_t, 2> by = {a, a};
    for (std::size_t k = 0; k < circles.size(); ++k) {
      if (k == a || k == b) continue;
      const double rise = circles[k].normal.dot(along), left = circles[k].depth - circles[k].normal.dot(foot);
      if (rise > 0 && left / rise < ends[1]) {
        ends[1] = left / rise;
        by[1] = k;
      } else if (rise < 0 && left / rise > ends[0]) {
        ends[0] = left / rise;
        by[0] = k;
      } else if (rise == 0 && left < 0) {
        return {};
      }
    }
    if (!(ends[0] < ends[1])) return {};
    if (const int face = upper_among(p, both); face >= 0) {
      const std::uint32_t lower = piece_before(p, face / 2);
      if (lower == Delaunay::none) return {};
      std::vector<std::uint32_t> ids =
          chord(lower, circle_before(p, lower, a, face), circle_before(p, lower, b, face));
      for (std::uint32_t& id : ids) id = draft_.lifted(face / 2, id);
      return ids;
    }
    const auto at = [&](double t) { return Vector<3>(piece.center + foot + t * along); };
    const auto end = [&](std::size_t e) {
      return by[e] == a ? corner(p, a, b, at(ends[e])) : triple(p, {a, b, by[e]});
    };
    std::vector<std::uint32_t>& ids = chords_[{p, a, b}];
    ids.push_back(end(0));
    const double length = ends[1] - ends[0];
    const double size = chord_size(p, both);
    for (const double share : spaced(length, 1, [&](double) { return size; }))
      ids.push_back(add(p, both, at(ends[0] + share * length), size));
    ids.push_back(end(1));
    return ids;
  }

  std::size_t same_as(std::uint32_t p, const Circle& wanted) const {
    const auto& circles = draft_.pieces[p].circles;
    for (std::size_t c = 0; c < circles.size(); ++c)
      if (circles[c].kind == wanted.kind && circles[c].normal == wanted.normal) return c;
    fail();
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
      if (j == c) continue;
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
      const std::uint32_t lower = piece_before(p, axis);
      if (lower == Delaunay::none) return;
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
    const double turn = arc.to - arc.from;
    std::vector<double> angles;
    if (circle.is_whole) angles.push_back(arc.from);
    for (const double share : spaced(turn * circle.radius, circle.is_whole ? 8 : 2, [&](double t) {
           return circle.kind == Circle::Kind::neck ? circle.edge
                                                    : size_along(p, circle, at(arc.from + t * turn));
         }))
      angles.push_back(arc.from + share * turn);
    return angles;
  }

  /// Edges on an end's or a cap's circle. Where an end's begins at a neck or cap, they begin
  /// with the neck's height or the cap's edges.
  double size_along(std::uint32_t p, const Circle& circle, const Vector<3>& q) {
    constexpr double least_per_turn = 8, growth = 0.6;
    double size = std::min(size_at(p, q), 2 * pi / least_per_turn * circle.radius);
    const Vector<3> from = q - draft_.pieces[p].piece.center;
    for (const Circle& other : draft_.pieces[p].circles) {
      double least = draft_.sizes.at_caps(draft_.pieces[p].piece.radius);
      if (other.kind == Circle::Kind::neck && draft_.necks[other.neck].is_cut) {
        least = draft_.necks[other.neck].end - draft_.necks[other.neck].begin;
      } else if (other.kind != Circle::Kind::contact || circle.kind != Circle::Kind::end) {
        continue;
      }
      const double along = from.dot(other.normal);
      const double beside = (from - along * other.normal).norm() - other.radius;
      size = std::min(size, least + growth * std::hypot(along - other.depth, beside));
    }
    return size;
  }

  SurfaceDraft& draft_;
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t, int>, std::uint32_t> corners_;
  std::map<std::array<std::size_t, 4>, std::uint32_t> triples_;
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t>, std::vector<std::uint32_t>> chords_;
  std::vector<std::vector<NearBall>> near_;
  std::vector<char> has_near_;
};

}  // namespace

void add_circles(SurfaceDraft& draft) { Circles(draft).make(); }

}  // namespace bernal
