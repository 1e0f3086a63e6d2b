#include "geometry/deviation_bounds.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/made.hpp"
#include "core/parallel.hpp"
#include "geometry/curved_patch.hpp"
#include "geometry/point_numbers.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {
namespace {

using Piece = TrueSurface::Piece;
using Flat = TrueSurface::Flat;
using Face = TrueSurface::Face;

using CornerNumbers = std::array<std::uint32_t, 3>;

/// The flat triangles of one face, each with those around it.
class Targets {
 public:
  explicit Targets(std::span<const Flat> flats) : flats_(flats) {
    for (const Flat& flat : flats) all_.emplace_back(flat.corners[0], flat.corners[1], flat.corners[2]);
  }

  double distance(std::uint32_t flat, const Vector<3>& p) const { return all_[flat].offset(p).norm(); }

  /// The largest distance of some points from one triangle: from `flat`, or from one that is reached from
  /// there by going to a nearer one around it until it is near `enough`. `flat` becomes that one.
  double distance(std::span<const Vector<3>> points, double enough, std::uint32_t& flat) const {
    double least = distance_from(flat, points, std::numeric_limits<double>::infinity());
    if (least > enough) std::call_once(is_known_, [&] { find_around(); });
    for (bool nearer = true; nearer && least > enough;) {
      nearer = false;
      const auto begin = around_.begin() + static_cast<std::ptrdiff_t>(first_[flat]);
      for (const std::uint32_t other : std::span(begin, first_[flat + 1] - first_[flat]))
        if (const double here = distance_from(other, points, least); here < least)
          least = here, flat = other, nearer = true;
    }
    return least;
  }

 private:
  void find_around() const {
    PointNumbers<Vector<3>> numbers;
    std::vector<CornerNumbers> corners;
    for (const Flat& flat : flats_)
      corners.push_back(
          {numbers.of(flat.corners[0]), numbers.of(flat.corners[1]), numbers.of(flat.corners[2])});
    std::vector<std::uint32_t> first(numbers.points.size() + 1, 0), at_corner(3 * flats_.size());
    for (const CornerNumbers& own : corners)
      for (const std::uint32_t corner : own) ++first[corner + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> end(first.begin(), first.end() - 1);
    for (std::uint32_t flat = 0; flat < corners.size(); ++flat)
      for (const std::uint32_t corner : corners[flat]) at_corner[end[corner]++] = flat;
    for (std::uint32_t flat = 0; flat < corners.size(); ++flat)
      add_around(flat, corners, [&](std::uint32_t corner) {
        return std::span(at_corner).subspan(first[corner], first[corner + 1] - first[corner]);
      });
  }

  /// Those that share a corner; of a corner of very many, such as the pole of a ball, those that share
  /// another one, too.
  template <class AtCorner>
  void add_around(std::uint32_t flat, const std::vector<CornerNumbers>& corners,
                  const AtCorner& at_corner) const {
    constexpr std::size_t many = 16;
    const auto begin = static_cast<std::ptrdiff_t>(around_.size());
    for (const std::uint32_t corner : corners[flat])
      for (const std::uint32_t other : at_corner(corner)) {
        const auto shared = std::ranges::count_if(corners[flat], [&](std::uint32_t own) {
          return std::ranges::find(corners[other], own) != corners[other].end();
        });
        if (other != flat && (shared > 1 || at_corner(corner).size() <= many)) around_.push_back(other);
      }
    std::sort(around_.begin() + begin, around_.end());
    around_.erase(std::unique(around_.begin() + begin, around_.end()), around_.end());
    first_.push_back(around_.size());
  }

  /// Or more than `most`.
  double distance_from(std::uint32_t flat, std::span<const Vector<3>> points, double most) const {
    double largest = 0;
    for (const Vector<3>& p : points)
      if (largest <= most) largest = std::max(largest, distance(flat, p));
    return largest;
  }

  Made made_{"true surface"};
  std::vector<PreparedTriangle> all_;
  std::span<const Flat> flats_;
  mutable std::once_flag is_known_;  ///< what is around: few faces need it
  mutable std::vector<std::uint32_t> around_;
  mutable std::vector<std::size_t> first_{0};  ///< in `around_`
};

/// What is found and what is proven of some pieces.
struct Known {
  double found = -1, apart = 0, track = 0;
  Vector<3> where = Vector<3>::Zero();

  void add(const Known& more) {
    if (more.found > found) found = more.found, where = more.where;
    apart = std::max(apart, more.apart);
    track = std::max(track, more.track);
  }
};

/// The pieces of a face and its flat triangles.
struct FacePieces {
  std::span<const TrueSurface::Patch> patches;
  std::span<const Piece> pieces;
  Targets targets;
  std::uint32_t first_flat;
};

/// The largest distance of one piece from flat triangles, by branch and bound. A part is done with when what
/// is proven of it is at most a tenth above what has been found anywhere.
class Branching {
 public:
  Branching(const FacePieces& face, const Piece& piece)
      : face_(face),
        patch_(face.patches[piece.patch]),
        flat_(piece.flat - face.first_flat),
        near_(flat_),
        slack_(piece.slack) {
    for (int k = 0; k < 3; ++k) whole_.corner[k] = corner_at(piece.at[k]);
  }

  /// Looks at few points.
  void look(Known& known) {
    for (const Corner& corner : whole_.corner) note(corner, known);
    const Parameters &a = whole_.corner[0].at, &b = whole_.corner[1].at, &c = whole_.corner[2].at;
    note(corner_at({(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3}), known);
  }

  void prove(Known& known) {
    constexpr double rounding = 4;  // of points and, once more, of the distances that others compute of them
    const ParameterTriangle at = whole_.at();
    const ParameterBox box = box_of(at);
    const DerivativeBounds derivatives = derivative_bounds(patch_, box);
    bending_ = bending_of(at, derivatives);
    slack_ += rounding * rounding_of(patch_, box, derivatives);
    divide(whole_, 0, known);
  }

 private:
  using Parameters = std::array<double, 2>;

  /// `off`: from the flat triangle that the piece belongs to.
  struct Corner {
    Parameters at;
    Vector<3> place;
    double off;
  };

  struct Part {
    std::array<Corner, 3> corner;

    ParameterTriangle at() const { return {corner[0].at, corner[1].at, corner[2].at}; }
    double off() const { return std::max({corner[0].off, corner[1].off, corner[2].off}); }
  };

  Corner corner_at(const Parameters& at) const {
    const Vector<3> place = point_at(patch_, at);
    return {at, place, face_.targets.distance(flat_, place)};
  }

  void note(const Corner& corner, Known& known) {
    if (!(corner.off > known.found)) return;
    const double here = face_.targets.distance({&corner.place, 1}, known.found, near_);
    if (here > known.found) known.found = here, known.where = corner.place;
  }

  /// From one triangle, the piece's own or one that is nearer.
  double off_around(const Part& part, double enough) {
    const std::array<Vector<3>, 3> places{part.corner[0].place, part.corner[1].place, part.corner[2].place};
    return std::min(part.off(), face_.targets.distance(places, enough, near_));
  }

  void divide(const Part& part, int depth, Known& known) {
    constexpr int deepest = 48;
    const ParameterTriangle at = part.at();
    const double bend = bend_of(at, bending_), own = part.off();
    const auto enough = [&] { return 1.1 * known.found - bend; };
    double off = own;
    if (own > known.found) {
      for (const Corner& corner : part.corner) note(corner, known);
      if (own > enough()) off = off_around(part, enough());
    }
    if (off <= enough() || bend <= slack_ || depth == deepest || --left_ < 0) {
      known.apart = std::max(known.apart, off + bend + slack_);
      known.track = std::max(known.track, own + bend + slack_);
      return;
    }
    const int edge = edge_to_halve(at, bending_), next = (edge + 1) % 3;
    const Corner middle = corner_at(middle_of_edge(at, edge));
    Part first = part, second = part;
    first.corner[next] = second.corner[edge] = middle;
    divide(first, depth + 1, known);
    divide(second, depth + 1, known);
  }

  /// A piece takes some ten; one that swirls around the pole of a ball some hundred.
  static constexpr int most_parts = 1 << 16;

  const FacePieces& face_;
  const TrueSurface::Patch& patch_;
  std::uint32_t flat_, near_;  ///< the triangle that was near enough last
  double slack_;
  Bending bending_ = {};
  Part whole_ = {};
  int left_ = most_parts;
};

/// The same for any number of threads: pieces are taken in groups of one size, each of which begins with what
/// a look at all of them has found.
Known known_of(const FacePieces& face) {
  constexpr std::size_t group = 512;
  std::vector<Known> of_groups((face.pieces.size() + group - 1) / group);
  const auto in_groups = [&](const auto& act) {
    parallel_for(of_groups.size(), [&](std::size_t g) {
      for (std::size_t k = g * group; k < std::min(face.pieces.size(), (g + 1) * group); ++k)
        act(Branching(face, face.pieces[k]), of_groups[g]);
    });
    Known all;
    for (const Known& known : of_groups) all.add(known);
    return all;
  };
  const Known seen = in_groups([](Branching branching, Known& known) { branching.look(known); });
  std::ranges::fill(of_groups, seen);
  return in_groups([](Branching branching, Known& known) { branching.prove(known); });
}

/// Where what belongs to each face begins, and where all ends. Precondition: face_of(k) does not decrease.
template <class FaceOf>
std::vector<std::size_t> first_of_faces(std::size_t faces, std::size_t count, const FaceOf& face_of) {
  std::vector<std::size_t> first(faces + 1, count);
  for (std::size_t k = count; k-- > 0;) first[face_of(k)] = k;
  for (std::size_t f = faces; f-- > 0;) first[f] = std::min(first[f], first[f + 1]);
  return first;
}

bool has_area(const CornerNumbers& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

CornerNumbers sorted(CornerNumbers t) {
  std::ranges::sort(t);
  return t;
}

/// Whether b names the corners of a in the opposite sense.
bool is_turned(const CornerNumbers& a, const CornerNumbers& b) {
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
      const Known known = known_of({surface.patches, part(std::as_const(surface.pieces), first_piece),
                                    Targets(part(std::as_const(surface.flats), first_flat)),
                                    static_cast<std::uint32_t>(first_flat[f])});
      face.apart = known.apart;
      face.track = known.track;
      face.worst = known.where;
    }
  });
}

bool restrict_to(TrueSurface& surface, const Mesh& mesh) {
  PointNumbers<Vector<3>> numbers;
  std::vector<std::uint32_t> of_vertex;
  for (const Vector<3>& v : mesh.vertices) of_vertex.push_back(numbers.of(v));
  struct Triangle {
    CornerNumbers key, corners;
    bool found = false;
  };
  std::vector<Triangle> triangles;
  for (const FaceCorners& t : mesh.triangles) {
    const CornerNumbers corners{of_vertex[t[0]], of_vertex[t[1]], of_vertex[t[2]]};
    triangles.push_back({sorted(corners), corners});
  }
  std::ranges::sort(triangles, {}, &Triangle::key);
  std::size_t left = triangles.size();
  enum class Is { unknown, there, absent };
  std::vector<Is> is(surface.faces.size(), Is::unknown);
  for (Flat& flat : surface.flats) {
    CornerNumbers corners;
    for (int k = 0; k < 3; ++k) corners[k] = numbers.of(flat.corners[k]);
    if (!has_area(corners)) continue;
    const CornerNumbers key = sorted(corners);
    const auto found = std::ranges::lower_bound(triangles, key, {}, &Triangle::key);
    const bool is_there = found != triangles.end() && found->key == key && !found->found;
    const Is here = is_there ? Is::there : Is::absent;
    Is& face = is[flat.face];
    if (face != Is::unknown && face != here) return false;
    face = here;
    if (here == Is::absent) continue;
    if (is_turned(corners, found->corners)) std::swap(flat.corners[1], flat.corners[2]);
    found->found = true;
    --left;
  }
  if (left > 0) return false;

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
