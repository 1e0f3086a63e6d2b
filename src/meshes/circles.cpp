// Points on the circles in which pieces are cut: at ends of periods, the same at opposite ends, and by caps.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "bernal/core/error.hpp"
#include "meshes/arcs.hpp"

namespace bernal {
namespace {

using std::numbers::pi;

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
          for (const std::vector<std::uint32_t>& ids : chords_of(p, b, a))
            draft_.pieces[p].chords.push_back({{b, a}, ids});
  }

 private:
  /// The image of a piece one period before along an axis; none where it does not reach into the domain, as
  /// it does if a part of its circle at the upper end is in there.
  std::uint32_t piece_before(std::uint32_t p, int axis) const {
    auto image = draft_.pieces[p].piece.image;
    --image[static_cast<std::size_t>(axis)];
    return draft_.piece_at(draft_.pieces[p].piece.sphere, image, draft_.pieces[p].below);
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
      if (draft_.pieces[p].is_outer())
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
    if (const int face = upper_among(p, std::array{a, b}); face >= 0) {
      const int axis = face / 2;
      const std::uint32_t lower = known(piece_before(p, axis));
      const Vector<3> moved = at - draft_.boundary.edges[axis] * Vector<3>::Unit(axis);
      return draft_.lifted(
          axis, corner(lower, circle_before(p, lower, a, face), circle_before(p, lower, b, face), moved));
    }
    if (a > b) std::swap(a, b);
    const Circle &one = draft_.pieces[p].circles[a], &other = draft_.pieces[p].circles[b];
    const int side = (at - draft_.pieces[p].piece.center).dot(one.normal.cross(other.normal)) > 0 ? 1 : -1;
    const auto [entry, is_new] = corners_.try_emplace({p, a, b, side}, 0);
    if (is_new) {
      const Vector<3> q = crossing(p, a, b, side);
      entry->second = add(p, std::array{a, b}, q, size_at(p, q));
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
          circle.kind == Circle::Kind::end && draft_.is_lifted(circle.face))
        return circle.face;
    return -1;
  }

  void put_on_ends(std::uint32_t p, std::span<const std::size_t> circles, Vector<3>& q) const {
    for (const std::size_t c : circles)
      if (const Circle& circle = draft_.pieces[p].circles[c]; circle.kind == Circle::Kind::end)
        draft_.put_on_end(circle.face, q);
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

  using Chains = std::vector<std::vector<std::uint32_t>>;

  /// Vertices along the parts of a line of two planes that are inside a piece and outside of the piece within
  /// it; none if there are no such parts.
  Chains chords_of(std::uint32_t p, std::size_t a, std::size_t b) {
    const std::array<std::size_t, 2> both = {a, b};
    const auto& circles = draft_.pieces[p].circles;
    const Circle &one = circles[a], &other = circles[b];
    const double c = one.normal.dot(other.normal), sine2 = 1 - c * c;
    if (sine2 < 1e-12) return {};
    if (a > b) return chords_of(p, b, a);
    if (const auto found = chords_.find({p, a, b}); found != chords_.end()) return found->second;
    const Piece& piece = draft_.pieces[p].piece;
    const Vector<3> foot =
        ((one.depth - c * other.depth) * one.normal + (other.depth - c * one.depth) * other.normal) / sine2;
    const double squared = piece.radius * piece.radius - foot.squaredNorm();
    if (!(squared > 0)) return {};
    const Vector<3> along = one.normal.cross(other.normal).normalized();
    std::array<double, 2> ends = {-std::sqrt(squared), std::sqrt(squared)};
    std::array<std::size_t, 2> by = {a, a};
    std::array<std::uint32_t, 2> corners = {Delaunay::none, Delaunay::none};
    const std::optional<ConvexPart>& part = draft_.solids.part;
    if (part) {
      const auto edge =
          part->edge_between(static_cast<std::uint32_t>(one.face), static_cast<std::uint32_t>(other.face));
      if (!edge) return {};
      const bool is_turned = part->edges[*edge].along.dot(along) < 0;
      for (const std::size_t e : {0, 1}) {
        const std::uint32_t there = part->edges[*edge].corners[is_turned ? 1 - e : e];
        const double t = (part->corners[there].point - piece.center - foot).dot(along);
        if (e == 1 ? t >= ends[1] : t <= ends[0]) continue;
        ends[e] = t;
        corners[e] = there;
      }
    }
    for (std::size_t k = 0; k < circles.size() && !part; ++k) {
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
      Chains made = chords_of(lower, circle_before(p, lower, a, face), circle_before(p, lower, b, face));
      for (auto& ids : made)
        for (std::uint32_t& id : ids) id = draft_.lifted(face / 2, id);
      return made;
    }
    const auto at = [&](double t) { return Vector<3>(piece.center + foot + t * along); };
    const auto end = [&](std::size_t e) {
      if (corners[e] != Delaunay::none)
        return draft_.vertex_at(part->corners[corners[e]].point, chord_size(p, both));
      return by[e] == a ? corner(p, a, b, at(ends[e])) : triple(p, {a, b, by[e]});
    };
    struct End {
      double t;
      std::uint32_t id;
    };
    std::vector<std::array<End, 2>> parts;
    const std::uint32_t within = draft_.pieces[p].within;
    const double half = within == DraftPiece::none ? 0 : half_chord(within, foot.squaredNorm());
    if (half > 0 && ends[0] < half && ends[1] > -half) {
      const auto same = [&](std::size_t of) { return circle_at(within, circles[of].face); };
      const auto inner = [&](double t) { return End{t, corner(within, same(a), same(b), at(t))}; };
      if (ends[0] < -half) parts.push_back({End{ends[0], end(0)}, inner(-half)});
      if (ends[1] > half) parts.push_back({inner(half), End{ends[1], end(1)}});
    } else {
      parts.push_back({End{ends[0], end(0)}, End{ends[1], end(1)}});
    }
    double size = chord_size(p, both);
    if (within != DraftPiece::none) size = std::min(size, draft_.pieces[p].largest_edge);
    const bool has_prisms = within != DraftPiece::none && draft_.pieces[within].is_copied;
    Chains made;
    for (const auto& [from, to] : parts) {
      std::vector<std::uint32_t>& ids = made.emplace_back(1, from.id);
      const double length = to.t - from.t;
      if (!has_prisms)
        for (const double share : spaced(length, 1, [&](double) { return size; }))
          ids.push_back(add(p, both, at(from.t + share * length), size));
      ids.push_back(to.id);
    }
    return chords_[{p, a, b}] = made;
  }

  /// Half the length of a line in a ball, from the square of its distance from the centre; 0 outside.
  double half_chord(std::uint32_t p, double squared) const {
    const double r = draft_.pieces[p].piece.radius;
    return std::sqrt(std::max(0.0, r * r - squared));
  }

  std::size_t same_as(std::uint32_t p, const Circle& wanted) const {
    const auto& circles = draft_.pieces[p].circles;
    for (std::size_t c = 0; c < circles.size(); ++c)
      if (circles[c].kind == wanted.kind && circles[c].normal == wanted.normal) return c;
    fail();
  }

  double size_at(std::uint32_t p, const Vector<3>& q) {
    const DraftPiece& piece = draft_.pieces[p];
    return draft_.size_on(piece, q, true, near_of(p));
  }

  void fill(std::uint32_t p, std::size_t c) {
    Circle& circle = draft_.pieces[p].circles[c];
    if (!circle.chains.empty() || circle.is_whole) return;
    if (circle.kind == Circle::Kind::end && draft_.is_lifted(circle.face)) {
      const int axis = circle.face / 2;
      const std::uint32_t lower = piece_before(p, axis);
      if (lower == Delaunay::none) return;
      const std::size_t there = circle_at(lower, circle.face - 1);
      fill(lower, there);
      const Circle& given = draft_.pieces[lower].circles[there];
      circle.is_whole = given.is_whole;
      circle.chains_around = given.chains_around;
      for (const auto& chain : given.chains) {  // which runs about the opposite normal
        auto& own = circle.chains.emplace_back();
        for (auto id = chain.rbegin(); id != chain.rend(); ++id) own.push_back(draft_.lifted(axis, *id));
      }
      return;
    }
    const Piece& piece = draft_.pieces[p].piece;
    const auto [u, v] = frame_of(circle);
    if (draft_.pieces[p].is_copied) fill_around(p, c);
    const auto at = [&](double t) {
      Vector<3> q =
          piece.center + circle.depth * circle.normal + circle.radius * (std::cos(t) * u + std::sin(t) * v);
      if (circle.kind == Circle::Kind::end) draft_.put_on_end(circle.face, q);
      return q;
    };
    for (const Arc& arc : arcs_on(draft_.pieces[p], c)) {
      circle.is_whole = arc.ended_by[0] == c;
      const std::vector<double> angles =
          draft_.pieces[p].is_copied ? copied_angles(p, circle, arc) : angles_of(p, circle, arc, at);
      circle.ended_by.push_back(arc.ended_by);
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

  /// The circle at the same end of the piece around a copied one.
  void fill_around(std::uint32_t p, std::size_t c) {
    const std::uint32_t around = draft_.pieces[p].around;
    fill(around, circle_at(around, draft_.pieces[p].circles[c].face));
  }

  /// Angles of an arc of a copied piece: those of the arc around it.
  std::vector<double> copied_angles(std::uint32_t p, Circle& copied, const Arc& arc) const {
    const std::uint32_t around = draft_.pieces[p].around;
    const std::size_t there = circle_at(around, copied.face);
    const auto like = arc_like(draft_, draft_.pieces[p], arc, draft_.pieces[around], there);
    if (!like) fail();
    copied.chains_around.push_back(like->chain);
    return like->angles;
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
  std::map<std::tuple<std::uint32_t, std::size_t, std::size_t>, Chains> chords_;
  std::vector<std::vector<NearBall>> near_;
  std::vector<char> has_near_;
};

}  // namespace

void add_circles(SurfaceDraft& draft) { Circles(draft).make(); }

}  // namespace bernal
