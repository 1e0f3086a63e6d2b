#include "geometry/deviation_bounds.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/parallel.hpp"
#include "geometry/curved_patch.hpp"
#include "geometry/point_numbers.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {
namespace {

using Piece = TrueSurface::Piece;
using Flat = TrueSurface::Flat;
using Face = TrueSurface::Face;

/// The flat triangles of one face, each with those that share a corner with it.
class Targets {
 public:
  explicit Targets(std::span<const Flat> flats) {
    PointNumbers<Vector<3>> numbers;
    for (const Flat& flat : flats) {
      const auto flat_number = static_cast<std::uint32_t>(all_.size());
      all_.emplace_back(flat.corners[0], flat.corners[1], flat.corners[2]);
      auto& corners = corners_.emplace_back();
      for (int k = 0; k < 3; ++k) {
        corners[k] = numbers.of(flat.corners[k]);
        if (corners[k] == at_corner_.size()) at_corner_.emplace_back();
        at_corner_[corners[k]].push_back(flat_number);
      }
    }
  }

  /// The largest distance of some points from one set: from that of the flat triangle, or from one around it
  /// that is near enough, or else the nearest.
  double distance(std::uint32_t flat, std::span<const Vector<3>> points, double enough) const {
    double least = std::numeric_limits<double>::infinity();
    const auto is_enough = [&](std::uint32_t number) {
      least = std::min(least, distance_from(all_[number], points, least));
      if (least <= enough) last_ = number;
      return least <= enough;
    };
    if (is_enough(flat) || is_enough(last_)) return least;
    for (const std::uint32_t corner : corners_[flat])
      for (const std::uint32_t other : at_corner_[corner])
        if (is_enough(other)) return least;
    return least;
  }

 private:
  /// Or more than `most`.
  static double distance_from(const PreparedTriangle& target, std::span<const Vector<3>> points,
                              double most) {
    double largest = 0;
    for (const Vector<3>& p : points)
      if (largest <= most) largest = std::max(largest, target.offset(p).norm());
    return largest;
  }

  std::vector<PreparedTriangle> all_;
  mutable std::uint32_t last_ = 0;  ///< the one that was near enough; any may be
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::vector<std::vector<std::uint32_t>> at_corner_;
};

/// The pieces of a face, how much each bends and what is added to that, and its flat triangles.
struct FacePieces {
  std::span<const TrueSurface::Patch> patches;
  std::span<const Piece> pieces;
  std::span<const Flat> flats;
  std::uint32_t first_flat;
  std::vector<Bending> bendings = {};
  std::vector<double> slacks = {};

  void set_bendings() {
    constexpr double rounding = 4;  // of points and, once more, of the distances that others compute of them
    for (const Piece& piece : pieces) {
      const ParameterBox box = box_of(piece.at);
      const DerivativeBounds derivatives = derivative_bounds(patches[piece.patch], box);
      bendings.push_back(bending_of(piece.at, derivatives));
      slacks.push_back(piece.slack + rounding * rounding_of(patches[piece.patch], box, derivatives));
    }
  }
};

/// The largest distance of pieces from the convex sets, by branch and bound.
class Largest {
 public:
  /// Stops where a bound is at most a tenth and `negligible` above what occurs. `around`: whether a piece may
  /// be near to a flat triangle beside its own.
  Largest(const FacePieces& face, bool around, double negligible)
      : face_(face), targets_(face.flats), around_(around), negligible_(negligible) {
    for (const Piece& piece : face.pieces) {
      const auto& at = piece.at;
      note(piece, {(at[0][0] + at[1][0] + at[2][0]) / 3, (at[0][1] + at[1][1] + at[2][1]) / 3});
      for (const auto& corner : at) note(piece, corner);
    }
    for (std::size_t k = 0; k < face.pieces.size(); ++k)
      divide(face.pieces[k], face.pieces[k].at, face.bendings[k], face.slacks[k], 0);
  }

  double proven() const { return proven_; }
  const Vector<3>& where() const { return where_; }

 private:
  double distance(const Piece& piece, std::span<const Vector<3>> points, double enough) const {
    return targets_.distance(piece.flat - face_.first_flat, points,
                             around_ ? enough : std::numeric_limits<double>::infinity());
  }

  void note(const Piece& piece, const std::array<double, 2>& at) {
    const Vector<3> point = point_at(face_.patches[piece.patch], at);
    const double here = distance(piece, {&point, 1}, found_);
    if (here > found_) found_ = here, where_ = point;
  }

  void divide(const Piece& piece, const ParameterTriangle& at, const Bending& bending, double slack,
              int depth) {
    constexpr int deepest = 24;
    const double bend = bend_of(at, bending);
    std::array<Vector<3>, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = point_at(face_.patches[piece.patch], at[k]);
    const auto enough = [&] { return 1.1 * found_ + negligible_ - bend; };
    const double off = distance(piece, corners, enough());
    if (off > found_)
      for (const auto& p : at) note(piece, p);
    if (off <= enough() || bend <= slack || depth == deepest) {
      proven_ = std::max(proven_, off + bend + slack);
      return;
    }
    const int edge = edge_to_halve(at, bending);
    ParameterTriangle first = at, second = at;
    first[(edge + 1) % 3] = second[edge] = middle_of_edge(at, edge);
    divide(piece, first, bending, slack, depth + 1);
    divide(piece, second, bending, slack, depth + 1);
  }

  const FacePieces& face_;
  Targets targets_;
  bool around_;
  double negligible_;
  double found_ = -1, proven_ = 0;
  Vector<3> where_ = Vector<3>::Zero();
};

/// Where what belongs to each face begins, and where all ends. Precondition: face_of(k) does not decrease.
template <class FaceOf>
std::vector<std::size_t> first_of_faces(std::size_t faces, std::size_t count, const FaceOf& face_of) {
  std::vector<std::size_t> first(faces + 1, count);
  for (std::size_t k = count; k-- > 0;) first[face_of(k)] = k;
  for (std::size_t f = faces; f-- > 0;) first[f] = std::min(first[f], first[f + 1]);
  return first;
}

bool has_area(const std::array<std::uint32_t, 3>& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> t) {
  std::ranges::sort(t);
  return t;
}

/// Whether b names the corners of a in the opposite sense.
bool is_turned(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
  const auto k = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
  return b[(k + 1) % 3] != a[1];
}

}  // namespace

void set_deviation_bounds(TrueSurface& surface) {
  const std::size_t faces = surface.faces.size();
  const auto first_piece = first_of_faces(faces, surface.pieces.size(), [&](std::size_t k) {
    return surface.flats[surface.pieces[k].flat].face;
  });
  const auto first_flat =
      first_of_faces(faces, surface.flats.size(), [&](std::size_t k) { return surface.flats[k].face; });
  parallel_ranges(faces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      Face& face = surface.faces[f];
      if (!face.without_bound.empty()) continue;
      const auto part = [f](const auto& all, const std::vector<std::size_t>& first) {
        return std::span(all).subspan(first[f], first[f + 1] - first[f]);
      };
      FacePieces pieces{surface.patches, part(std::as_const(surface.pieces), first_piece),
                        part(std::as_const(surface.flats), first_flat),
                        static_cast<std::uint32_t>(first_flat[f])};
      pieces.set_bendings();
      const Largest apart(pieces, true, 0);
      const Largest track(pieces, false, apart.proven());
      face.apart = apart.proven();
      face.track = track.proven();
      face.worst = apart.where();
    }
  });
}

bool restrict_to(TrueSurface& surface, const Mesh& mesh) {
  PointNumbers<Vector<3>> numbers;
  std::map<std::array<std::uint32_t, 3>, std::array<std::uint32_t, 3>> left;
  for (const FaceCorners& t : mesh.triangles) {
    std::array<std::uint32_t, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = numbers.of(mesh.vertices[t[k]]);
    left.emplace(sorted(corners), corners);
  }
  enum class Is { unknown, there, absent };
  std::vector<Is> is(surface.faces.size(), Is::unknown);
  for (Flat& flat : surface.flats) {
    std::array<std::uint32_t, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = numbers.of(flat.corners[k]);
    if (!has_area(corners)) continue;
    const auto found = left.find(sorted(corners));
    const Is here = found == left.end() ? Is::absent : Is::there;
    Is& face = is[flat.face];
    if (face != Is::unknown && face != here) return false;
    face = here;
    if (here == Is::absent) continue;
    if (is_turned(corners, found->second)) std::swap(flat.corners[1], flat.corners[2]);
    left.erase(found);
  }
  if (!left.empty()) return false;

  constexpr std::uint32_t none = 0xFFFFFFFF;
  std::vector<std::uint32_t> new_face(surface.faces.size(), none), new_flat(surface.flats.size(), none);
  TrueSurface kept;
  for (std::size_t f = 0; f < is.size(); ++f) {
    if (is[f] != Is::there) continue;
    new_face[f] = static_cast<std::uint32_t>(kept.faces.size());
    kept.faces.push_back(std::move(surface.faces[f]));
  }
  for (std::size_t k = 0; k < surface.flats.size(); ++k) {
    const std::uint32_t face = new_face[surface.flats[k].face];
    if (face == none) continue;
    new_flat[k] = static_cast<std::uint32_t>(kept.flats.size());
    kept.flats.push_back({surface.flats[k].corners, face});
  }
  for (Piece& piece : surface.pieces)
    if (const std::uint32_t flat = new_flat[piece.flat]; flat != none) {
      kept.pieces.push_back(piece);
      kept.pieces.back().flat = flat;
    }
  kept.patches = std::move(surface.patches);
  surface = std::move(kept);
  return true;
}

}  // namespace bernal
