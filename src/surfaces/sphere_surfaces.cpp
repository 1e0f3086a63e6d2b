#include "surfaces/sphere_surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/point_numbers.hpp"
#include "surfaces/cut_ball.hpp"
#include "verify/bounded.hpp"
#include "verify/exact.hpp"
#include "verify/predicates.hpp"

namespace bernal {
namespace {

/// Whether the point is nearer to center + image·edges than the radius, for exact real arguments.
template <class Number>
verify::Truth within(const FloatPoint& p, const Vector<3>& center, const std::array<int, 3>& image,
                     const Vector<3>& edges, double radius) {
  const auto squared_offset = [&](std::size_t k) {
    const int axis = static_cast<int>(k);
    const Number moved = Number(center[axis]) + Number(image[k]) * Number(edges[axis]);
    return square(Number(static_cast<double>(p[k])) - moved);
  };
  return verify::more_than(square(Number(radius)), squared_offset(0) + squared_offset(1) + squared_offset(2));
}

FloatPoint rounded(const Vector<3>& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

/// Merges corners that rounding made equal, and drops triangles that lose one.
void weld(FloatSurface& surface) {
  PointNumbers<FloatPoint> numbers;
  std::vector<std::uint32_t> number;
  for (const FloatPoint& p : surface.vertices) number.push_back(numbers.of(p));
  surface.vertices = std::move(numbers.points);
  renumber(surface.triangles, [&](std::uint32_t v) { return number[v]; });
  std::size_t kept = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle triangle = surface.triangles[t];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    surface.faces[kept] = surface.faces[t];
    surface.triangles[kept++] = triangle;
  }
  surface.triangles.resize(kept);
  surface.faces.resize(kept);
}

/// A sphere's cuts as planes about its centre, each once, and for every piece its planes.
struct PlanesOfSphere {
  std::vector<BallPlane> planes;
  /// For each piece: plane, and whether it keeps the part below.
  std::vector<std::vector<std::pair<int, bool>>> cuts;
};

PlanesOfSphere planes_of(std::span<const Piece> pieces, const Boundary<3>& boundary, double shift) {
  const Piece& home = pieces.front();
  PlanesOfSphere made;
  for (const Piece& piece : pieces) {
    auto& cuts = made.cuts.emplace_back();
    for (const Cut& cut : piece.cuts) {
      BallPlane plane{cut.keeps.normal, cut.keeps.offset - cut.keeps.normal.dot(piece.center), cut.face};
      bool below = true;
      if (cut.face != Cut::contact) {
        // The image beyond the upper end is cut at the lower end by the plane that cuts the sphere at its
        // upper end: the same index for both.
        const int axis = cut.face / 2, image = piece.image[static_cast<std::size_t>(axis)];
        const bool at_upper = (cut.face % 2 == 1) == (image == 0);
        const double lower = boundary.origin[axis] - home.center[axis];
        const double upper = boundary.origin[axis] + boundary.edges[axis] - home.center[axis];
        plane = {Vector<3>::Unit(axis), at_upper ? upper : lower, 2 * axis + (at_upper ? 1 : 0)};
        below = cut.face % 2 == 1;
      } else {
        plane.offset -= 5 * shift;
      }
      const auto found = std::ranges::find_if(made.planes, [&](const BallPlane& known) {
        return known.face == plane.face && (known.normal - plane.normal).norm() < 1e-9 &&
               std::abs(known.offset - plane.offset) < 1e-9 * home.radius;
      });
      const auto number = static_cast<int>(found - made.planes.begin());
      if (found == made.planes.end()) made.planes.push_back(plane);
      cuts.emplace_back(number, below);
    }
  }
  return made;
}

/// The polygons in which the halves of a cut meet, at the ends of periods: each half must have the other's
/// polygon reversed. Rounding and slivers may prevent this if several planes cut a ball.
class MeetingPolygons {
 public:
  /// Adds a face of a part of the ball; `below` is the side of that plane's cut.
  void add(const CutBall& ball, const CutBall::Face& face, bool below) {
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      Edge edge{face.plane, place_of(ball, face.corners[k]),
                place_of(ball, face.corners[(k + 1) % face.corners.size()])};
      if (edge.from == edge.to) continue;
      if (!below) std::swap(edge.from, edge.to);
      unmatched_[edge] += below ? 1 : -1;
    }
  }
  bool match() const {
    return std::ranges::all_of(unmatched_, [](const auto& edge) { return edge.second == 0; });
  }

 private:
  using Place = std::array<double, 3>;
  struct Edge {
    int plane;
    Place from, to;
    auto operator<=>(const Edge&) const = default;
  };
  static Place place_of(const CutBall& ball, std::uint32_t corner) {
    const Vector<3>& p = ball.corners()[corner].place;
    return {p[0], p[1], p[2]};
  }

  std::map<Edge, int> unmatched_;
};

}  // namespace

double single_precision_shift(double largest) {
  return std::sqrt(3.0) * (0x1p-24 * largest * (1 + 1e-6) + 0x1p-149);
}

bool lies_within(const FloatPoint& p, const Vector<3>& center, double radius) {
  return within<verify::Exact>(p, center, {}, Vector<3>::Zero(), radius) == verify::Truth::yes && radius > 0;
}

SphereSurfaces::SphereSurfaces(std::vector<Piece> pieces, const Domain& domain, double deflection,
                               double shift)
    : pieces_(std::move(pieces)), boundary_(boundary_of<3>(domain)), deflection_(deflection), shift_(shift) {
  first_piece_.assign(1, 0);
  for (std::size_t p = 1; p <= pieces_.size(); ++p)
    if (p == pieces_.size() || pieces_[p].sphere != pieces_[p - 1].sphere) first_piece_.push_back(p);
  double most = 0;
  for (const Piece& piece : pieces_) {
    const double share = 6 * shift / piece.radius;
    most = std::max(most, share);

    if (!(share < 0.25 * deflection))
      throw Error(
          ErrorCode::bad_argument,
          fmt::format("in single precision coordinates are off by up to {:.2g}, too much for a sphere "
                      "of radius {:.6g} and a deflection of {}; move the domain to the origin, or "
                      "allow a larger deflection",
                      shift, piece.radius, deflection));
  }
  frequency_ = frequency_for((deflection - most) / (1 - most));
}

bool SphereSurfaces::is_whole(std::size_t sphere) const {
  return first_piece_[sphere + 1] - first_piece_[sphere] == 1 && first_piece(sphere).cuts.empty();
}

void SphereSurfaces::verify(const Piece& piece, const Vector<3>& home, const FloatSurface& surface) const {
  const double radius = piece.radius - inset();
  for (const FloatPoint& p : surface.vertices) {
    verify::Truth inside = within<verify::Bounded>(p, home, piece.image, boundary_.edges, radius);
    if (inside == verify::Truth::unknown)
      inside = within<verify::Exact>(p, home, piece.image, boundary_.edges, radius);
    if (inside != verify::Truth::yes)
      throw std::logic_error(fmt::format("a vertex of sphere {} lies outside it", piece.sphere));
  }
}

bool SphereSurfaces::make_cut(std::size_t sphere, int frequency, std::vector<FloatSurface>& to,
                              Measured& measured) const {
  const std::span<const Piece> pieces(pieces_.data() + first_piece_[sphere],
                                      first_piece_[sphere + 1] - first_piece_[sphere]);
  const PlanesOfSphere cuts = planes_of(pieces, boundary_, shift_);
  const Vector<3> home = pieces.front().center;
  to.clear();
  measured = {0, pieces.front().radius};
  MeetingPolygons polygons;
  for (std::size_t n = 0; n < pieces.size(); ++n) {
    const Piece& piece = pieces[n];
    CutBall ball(frequency, piece.radius - 5 * shift_, cuts.planes);
    for (const auto& [plane, below] : cuts.cuts[n])
      if (!ball.cut(plane, below)) return false;
    if (ball.empty()) continue;
    FloatSurface made;
    std::vector<std::uint32_t> number(ball.corners().size(), ~0U);
    for (const CutBall::Face& face : ball.faces()) {
      int lies_in = on_sphere;
      if (face.plane >= 0) lies_in = cuts.planes[static_cast<std::size_t>(face.plane)].face;
      if (lies_in >= 0) {
        const auto by = std::ranges::find(cuts.cuts[n], face.plane, &std::pair<int, bool>::first);
        polygons.add(ball, face, by->second);
      }
      for (Triangle triangle : ball.triangles_of(face)) {
        const auto place = [&](std::size_t k) { return ball.corners()[triangle[k]].place; };
        measured.volume += place(0).dot(place(1).cross(place(2))) / 6;
        if (lies_in == on_sphere)
          measured.inner = std::min(measured.inner, distance_from_origin(place(0), place(1), place(2)));
        for (std::uint32_t& v : triangle) {
          if (number[v] == ~0U) {
            number[v] = static_cast<std::uint32_t>(made.vertices.size());
            const CutBall::Corner& corner = ball.corners()[v];
            Vector<3> p = home + corner.place;
            for (int k = 0; k < 3; ++k) p[k] += piece.image[static_cast<std::size_t>(k)] * boundary_.edges[k];
            for (const int on : corner.planes) {
              if (on < 0 || cuts.planes[static_cast<std::size_t>(on)].face < 0) continue;
              const int face_of_home = cuts.planes[static_cast<std::size_t>(on)].face,
                        axis = face_of_home / 2;
              const bool upper =
                  (face_of_home % 2 == 1) == (piece.image[static_cast<std::size_t>(axis)] == 0);
              p[axis] = boundary_.origin[axis] + (upper ? boundary_.edges[axis] : 0.0);
            }
            made.vertices.push_back(rounded(p));
          }
          v = number[v];
        }
        made.triangles.push_back(triangle);
        int face_of_piece = lies_in;
        if (lies_in >= 0 && piece.image[static_cast<std::size_t>(lies_in / 2)] != 0)
          face_of_piece = lies_in ^ 1;
        made.faces.push_back(static_cast<std::int8_t>(face_of_piece));
      }
    }
    weld(made);
    verify(piece, home, made);
    to.push_back(std::move(made));
  }
  return polygons.match();
}

void SphereSurfaces::make(std::size_t sphere,
                          const std::function<void(const FloatSurface&, const Measured&)>& use) const {
  const Piece& first = first_piece(sphere);
  const double radius = first.radius - 5 * shift_;
  if (is_whole(sphere)) {
    const Icosphere& whole = icosphere(frequency_);
    FloatSurface made;
    made.vertices.reserve(whole.vertices.size());
    for (const Vector<3>& v : whole.vertices) made.vertices.push_back(rounded(first.center + radius * v));
    made.triangles = whole.triangles;
    made.faces.assign(made.triangles.size(), on_sphere);
    verify(first, first.center, made);
    use(made, {whole.volume * radius * radius * radius, whole.inradius * radius});
    return;
  }
  std::vector<FloatSurface> made;
  Measured measured;
  for (int frequency = frequency_; frequency < 2 * frequency_ + 8; ++frequency) {
    if (!make_cut(sphere, frequency, made, measured)) continue;
    if (measured.inner - shift_ < (1 - deflection_) * first.radius) continue;
    for (std::size_t p = 0; p < made.size(); ++p)
      use(made[p], p == 0 ? measured : Measured{0, measured.inner});
    return;
  }
  throw Error(
      ErrorCode::bad_argument,
      fmt::format("sphere {} cannot be cut into closed surfaces of triangles in single precision with a "
                  "deflection of {}; give another one",
                  sphere, deflection_));
}

void SphereSurfaces::visit(std::size_t sphere, const std::function<void(const FloatSurface&)>& visit) const {
  make(sphere, [&](const FloatSurface& surface, const Measured&) { visit(surface); });
}

SurfaceMeasures SphereSurfaces::measure() const {
  struct OfSphere {
    std::uint32_t surfaces = 0, vertices = 0, triangles = 0;
    double volume = 0, deflection = 0;
  };
  std::vector<OfSphere> all(spheres());
  FloatPoint lower{}, upper{};
  bool any = false;
  std::mutex mutex;
  parallel_ranges(all.size(), 256, [&](std::size_t first, std::size_t last) {
    FloatPoint low{}, high{};
    bool some = false;
    for (std::size_t i = first; i < last; ++i)
      make(i, [&](const FloatSurface& surface, const Measured& measured) {
        ++all[i].surfaces;
        all[i].vertices += static_cast<std::uint32_t>(surface.vertices.size());
        all[i].triangles += static_cast<std::uint32_t>(surface.triangles.size());
        all[i].volume += measured.volume;
        all[i].deflection = std::max(all[i].deflection, 1 - (measured.inner - shift_) / radius(i));
        for (const FloatPoint& p : surface.vertices) {
          if (!some) low = high = p, some = true;
          for (std::size_t k = 0; k < 3; ++k)
            low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        }
      });
    const std::lock_guard lock(mutex);
    if (!some) return;
    if (!any) lower = low, upper = high, any = true;
    for (std::size_t k = 0; k < 3; ++k)
      lower[k] = std::min(lower[k], low[k]), upper[k] = std::max(upper[k], high[k]);
  });
  SurfaceMeasures sum{.lower = lower, .upper = upper};
  double volume = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum.surfaces += all[i].surfaces;
    sum.vertices += all[i].vertices;
    sum.triangles += all[i].triangles;
    sum.deflection = std::max(sum.deflection, all[i].deflection);
    sum.volume_share += all[i].volume;
    volume += ball_volume(3, radius(i));
  }
  if (volume > 0) sum.volume_share /= volume;
  return sum;
}

}  // namespace bernal
