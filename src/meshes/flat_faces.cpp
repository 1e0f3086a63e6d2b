// Flat faces of pieces: of caps, at the ends of periods, and where necks begin or end.
#include <map>

#include "meshes/planar_part.hpp"

namespace bernal {
namespace {

class FlatFaces {
 public:
  explicit FlatFaces(SurfaceDraft& draft) : draft_(draft) {}

  void mesh() {
    if (draft_.options.solids) {
      mesh_faces([](Circle::Kind) { return true; });
      mesh_ends_of_necks();
      return;
    }
    mesh_faces([](Circle::Kind kind) { return kind == Circle::Kind::contact; });
    ConformingSurface& made = draft_.made;
    const std::size_t patches = made.patches.size();
    const auto first = static_cast<std::ptrdiff_t>(made.triangles.size());
    mesh_faces([](Circle::Kind kind) { return kind == Circle::Kind::end; });
    mesh_ends_of_necks();
    made.lids.triangles.assign(made.triangles.begin() + first, made.triangles.end());
    made.triangles.erase(made.triangles.begin() + first, made.triangles.end());
    made.patch.resize(made.triangles.size());
    made.patches.resize(patches);
    const auto is_of = [](const DraftPiece& piece, const Chord& chord, Circle::Kind kind) {
      return std::ranges::any_of(chord.circles, [&](std::size_t c) { return piece.circles[c].kind == kind; });
    };
    for (const DraftPiece& piece : draft_.pieces)
      for (const Chord& chord : piece.chords)
        if (is_of(piece, chord, Circle::Kind::neck) && is_of(piece, chord, Circle::Kind::end))
          made.lids.chords.push_back(chord.ids);
  }

 private:
  void mesh_faces(const std::function<bool(Circle::Kind)>& are_wanted) {
    for (const bool upper : {false, true})
      for (std::uint32_t p = 0; p < draft_.pieces.size(); ++p)
        for (std::size_t c = 0; c < draft_.pieces[p].circles.size(); ++c) {
          const Circle& circle = draft_.pieces[p].circles[c];
          if (!has_face(draft_.pieces[p], c) ||
              (circle.kind == Circle::Kind::end && draft_.is_lifted(circle.face)) != upper)
            continue;
          if (are_wanted(circle.kind)) make_face(p, c);
        }
  }
  void mesh_ends_of_necks() {
    for (std::uint32_t n = 0; n < draft_.necks.size(); ++n)
      if (draft_.necks[n].wall) make_foot(n);
    for (const bool upper : {false, true})
      for (std::uint32_t n = 0; n < draft_.necks.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          if (draft_.necks[n].is_cut && draft_.boundary.repeats(axis)) make_end(n, axis, upper);
  }

  /// Whether something of a circle's disc is left: a ball that holds a whole face of a part that is cut out
  /// has chords there alone.
  bool has_face(const DraftPiece& piece, std::size_t c) const {
    if (!piece.circles[c].chains.empty()) return true;
    return draft_.solids.is_cut() && std::ranges::any_of(piece.chords, [&](const Chord& chord) {
             return chord.circles[0] == c || chord.circles[1] == c;
           });
  }
  /// Inside a flat face sizes are those of spheres; smaller ones follow from the edges around it.
  std::function<double(const Vector<3>&)> size_in(std::uint32_t p) const {
    const DraftPiece& piece = draft_.pieces[p];
    const double size = draft_.options.sphere_edge * piece.piece.radius;
    if (piece.within == DraftPiece::none) return [size](const Vector<3>&) { return size; };
    // In a layer they follow its thickness, and the distance of the sphere within.
    const Piece& within = draft_.pieces[piece.within].piece;
    const double most = std::min(size, piece.largest_edge);
    return [=, center = within.center, r = within.radius,
            per_gap = draft_.per_gap_of_layers()](const Vector<3>& q) {
      const double from = (q - center).norm() - r;
      return from > 0 ? std::max(std::min(most, per_gap * from), 1e-3 * most) : size;
    };
  }
  /// The circle at the same end of the piece within, if it has one.
  const Circle* circle_within(const DraftPiece& piece, const Circle& circle) const {
    if (piece.within == DraftPiece::none || circle.kind != Circle::Kind::end) return nullptr;
    for (const Circle& other : draft_.pieces[piece.within].circles)
      if (other.kind == Circle::Kind::end && other.face == circle.face && !other.chains.empty())
        return &other;
    return nullptr;
  }

  PlanarPart part_of(const Circle& circle, const Vector<3>& center) {
    return part_in(circle.normal, center + circle.depth * circle.normal,
                   circle.kind == Circle::Kind::end ? circle.face : -1);
  }

  /// In the plane through a point; `face`: the end of a period that it is, or -1.
  PlanarPart part_in(const Vector<3>& normal, const Vector<3>& origin, int face) {
    const Vector<3> u = normal.unitOrthogonal(), v = normal.cross(u);
    return {draft_,
            [=](const Vector<3>& p) { return Vector<3>((p - origin).dot(u), (p - origin).dot(v), 0); },
            [=, &draft = draft_](const Vector<3>& p) {
              Vector<3> q = origin + p[0] * u + p[1] * v;
              if (face >= 0) draft.put_on_end(face, q);
              return q;
            }};
  }

  void make_face(std::uint32_t p, std::size_t c) {
    const DraftPiece& piece = draft_.pieces[p];
    const Circle& circle = piece.circles[c];
    const Circle* within = circle_within(piece, circle);
    if (within != nullptr && draft_.pieces[piece.within].is_copied) return;  // where prisms end
    SurfacePatch patch{SurfacePatch::Kind::cut_face, piece.piece.sphere, {draft_.region_of_piece(p), 0}};
    if (circle.kind == Circle::Kind::neck) patch.regions[1] = draft_.region_of_neck(circle.neck);
    if (circle.kind == Circle::Kind::end) {
      patch.kind = draft_.kind_of_ends();
      patch.index = static_cast<std::uint32_t>(circle.face);
      patch.regions[1] = SurfacePatch::nothing;
    }
    const std::uint32_t number = draft_.add_patch(patch);
    if (circle.kind == Circle::Kind::end && draft_.is_lifted(circle.face)) {
      const int axis = circle.face / 2;
      std::array<int, 3> image = piece.piece.image;
      --image[static_cast<std::size_t>(axis)];
      for (const FaceCorners& t : lower_.at({piece.piece.sphere, image, axis, piece.layer}))
        draft_.add_triangle(number, draft_.lifted(axis, t[0]), draft_.lifted(axis, t[2]),
                            draft_.lifted(axis, t[1]));
      return;
    }
    PlanarPart part = part_of(circle, piece.piece.center);
    for (const auto& chain : circle.chains) part.add_chain(chain, circle.is_whole);
    if (within != nullptr)
      for (const auto& chain : within->chains) part.add_chain(chain, within->is_whole);
    for (const Chord& chord : piece.chords)
      if (chord.circles[0] == c || chord.circles[1] == c) part.add_chain(chord.ids, false);
    const double cap = draft_.sizes.at_caps(piece.piece.radius);
    part.mesh(number, false,
              circle.kind == Circle::Kind::contact ? [cap](const Vector<3>&) { return cap; } : size_in(p));
    if (circle.kind == Circle::Kind::end && !draft_.solids.is_cut())
      lower_[{piece.piece.sphere, piece.piece.image, circle.face / 2, piece.layer}] = part.triangles();
  }

  /// Where a neck stands on a wall.
  void make_foot(std::uint32_t n) {
    const DraftNeck neck = draft_.necks[n];
    const Vector<3> center = neck.center, around = neck.around();
    PlanarPart part(
        draft_,
        [&](const Vector<3>& p) {
          return Vector<3>((p - center).dot(neck.across), (p - center).dot(around), 0);
        },
        [&](const Vector<3>& p) { return foot_of(draft_, neck, p[0] * neck.across + p[1] * around); });
    part.add_chain(neck.rim_points[1], true);
    part.mesh(draft_.add_patch({SurfacePatch::Kind::wall,
                                *neck.wall,
                                {draft_.region_of_neck(n), SurfacePatch::nothing},
                                shape_of_wall(draft_.solids.domain, *neck.wall)}),
              false, size_in(neck.pieces[0]));
  }

  /// Where an end of a period cuts a neck.
  void make_end(std::uint32_t n, int axis, bool upper) {
    const DraftNeck neck = draft_.necks[n];
    const int face = 2 * axis + upper;
    if (std::ranges::none_of(neck.traces, [&](const NeckTrace& trace) { return trace.face == face; })) return;
    const std::uint32_t number = draft_.add_patch({SurfacePatch::Kind::period_end,
                                                   static_cast<std::uint32_t>(face),
                                                   {draft_.region_of_neck(n), SurfacePatch::nothing}});
    if (upper) {
      std::array<int, 3> image = neck.image;
      --image[static_cast<std::size_t>(axis)];
      for (const FaceCorners& t : lower_of_necks_.at({neck.bond, image, axis}))
        draft_.add_triangle(number, draft_.lifted(axis, t[0]), draft_.lifted(axis, t[2]),
                            draft_.lifted(axis, t[1]));
      return;
    }
    Vector<3> origin = neck.center;
    origin[axis] = draft_.boundary.origin[axis];
    PlanarPart part = part_in(-Vector<3>::Unit(axis), origin, 2 * axis);
    std::vector<std::uint32_t> ends;  // of what bounds it so far
    const auto add = [&](const std::vector<std::uint32_t>& chain, bool is_closed) {
      part.add_chain(chain, is_closed);
      if (!is_closed) ends.insert(ends.end(), {chain.front(), chain.back()});
    };
    for (const NeckTrace& trace : neck.traces)
      if (trace.face == face) add(trace.ids, trace.is_closed);
    for (std::size_t e = 0; e < 2; ++e) {
      if (neck.pieces[e] == Delaunay::none) continue;
      const DraftPiece& piece = draft_.pieces[neck.pieces[e]];
      for (const Chord& chord : piece.chords)
        for (const std::size_t side : {0, 1})
          if (const Circle& other = piece.circles[chord.circles[1 - side]];
              chord.circles[side] == neck.circles[e] && other.kind == Circle::Kind::end && other.face == face)
            add(chord.ids, false);
    }
    const double size = draft_.options.sphere_edge * draft_.solids.spheres.r[neck.spheres[0]];
    for (int other = 0; other < 3; ++other)
      if (other != axis && draft_.boundary.repeats(other))
        for (const bool at_upper : {false, true})
          if (const auto line = line_of(ends, other, at_upper, 3 - axis - other, size); !line.empty())
            part.add_chain(line, false);
    part.mesh(number, false, [size](const Vector<3>&) { return size; });
    lower_of_necks_[{neck.bond, neck.image, axis}] = part.triangles();
  }

  /// The part of an edge of the box in a neck, along an axis, between those of some vertices that are on it;
  /// empty if there are none.
  std::vector<std::uint32_t> line_of(const std::vector<std::uint32_t>& ends, int axis, bool upper, int along,
                                     double size) {
    const double at = draft_.boundary.origin[axis] + (upper ? draft_.boundary.edges[axis] : 0);
    std::vector<std::uint32_t> on;
    for (const std::uint32_t id : ends)
      if (draft_.made.vertices[id][axis] == at) on.push_back(id);
    std::ranges::sort(on, {}, [&](std::uint32_t id) { return draft_.made.vertices[id][along]; });
    on.erase(std::unique(on.begin(), on.end()), on.end());
    if (on.size() < 2) return {};
    const Vector<3> from = draft_.made.vertices[on.front()], to = draft_.made.vertices[on.back()];
    const int count = std::max(1, static_cast<int>(std::ceil((to[along] - from[along]) / size)));
    std::vector<std::uint32_t> line = {on.front()};
    for (int k = 1; k < count; ++k) {
      Vector<3> p = from;
      p[axis] = draft_.boundary.origin[axis];
      p[along] += (to[along] - from[along]) * k / count;
      const std::uint32_t lower = draft_.vertex_at(p, size);
      line.push_back(upper ? draft_.lifted(axis, lower) : lower);
    }
    line.push_back(on.back());
    return line;
  }

  SurfaceDraft& draft_;
  std::map<std::tuple<std::uint32_t, std::array<int, 3>, int>, std::vector<FaceCorners>> lower_of_necks_;
  std::map<std::tuple<std::uint32_t, std::array<int, 3>, int, std::uint32_t>, std::vector<FaceCorners>>
      lower_;
};

}  // namespace

void mesh_flat_faces(SurfaceDraft& draft) { FlatFaces(draft).mesh(); }

}  // namespace bernal
