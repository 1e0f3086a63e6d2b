#include "verify/true_wall.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "geometry/curved_patch.hpp"
#include "verify/space.hpp"

namespace bernal::verify {
namespace {

/// One ball against one piece.
class Search {
 public:
  Search(const TrueSurface::Patch& patch, const Bending& bending, const Ball<3>& ball,
         const CertifyOptions& options, double slack)
      : patch_(patch),
        bending_(bending),
        center_(ball.c),
        reach_(rounded_up(ball.r + options.wall_gap)),
        slack_(slack + 0x1p-43 * ball.c.cwiseAbs().maxCoeff()) {}

  bool is_clear(const ParameterTriangle& at) {
    Part part{at, {}};
    for (int k = 0; k < 3; ++k) part.corners[k] = point_at(patch_, at[k]);
    return is_clear(part);
  }

  /// To within what the piece bends where it was decided.
  double distance() const { return distance_; }

 private:
  struct Part {
    ParameterTriangle at;
    Corners corners;
  };

  bool is_clear(const Part& part) {
    const double bend = bend_of(part.at, bending_);
    const double distance = distance_from_triangle(center_, part.corners);
    if (distance - bend - slack_ >= reach_) {
      distance_ = std::min(distance_, distance);
      return true;
    }
    for (const Vector<3>& corner : part.corners) {
      const double to_corner = (corner - center_).norm();
      if (to_corner < reach_) {
        distance_ = std::min(distance_, to_corner);
        return false;
      }
    }
    if (bend <= 0.01 * slack_ || --budget_ < 0) {
      distance_ = std::min(distance_, distance);
      return false;
    }
    const int edge = edge_to_halve(part.at, bending_), other = (edge + 1) % 3;
    const std::array<double, 2> at = middle_of_edge(part.at, edge);
    Part first = part, second = part;
    first.at[other] = second.at[edge] = at;
    first.corners[other] = second.corners[edge] = point_at(patch_, at);
    return is_clear(first) && is_clear(second);
  }

  const TrueSurface::Patch& patch_;
  Bending bending_;
  Vector<3> center_;
  double reach_, slack_;
  double distance_ = Box<3>::infinity;
  /// Divisions: a ball as large as a spherical cap that it touches to 1e-8 of its radius takes about a
  /// million.
  std::int64_t budget_ = 10'000'000;
};

}  // namespace

TrueWall::TrueWall(const Mesh& mesh)
    : surface_(*mesh.surface), triangles_(mesh), pieces_(pieces_of(*mesh.surface)) {
  for (const TrueSurface::Face& face : surface_.faces)
    require(face.without_bound.empty(), "nothing is proven of a face of the surface");
  track_ = surface_.largest(&TrueSurface::Face::track);
}

std::vector<TrueWall::Piece> TrueWall::pieces_of(const TrueSurface& surface) {
  std::vector<Piece> pieces(surface.pieces.size());
  parallel_ranges(pieces.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const TrueSurface::Piece& given = surface.pieces[k];
      const TrueSurface::Patch& patch = surface.patches[given.patch];
      const ParameterBox box = box_of(given.at);
      const DerivativeBounds derivatives = derivative_bounds(patch, box);
      Piece& piece = pieces[k];
      piece.number = static_cast<std::uint32_t>(k);
      piece.bending = bending_of(given.at, derivatives);
      piece.slack = given.slack + rounding_of(patch, box, derivatives);
      for (const auto& at : given.at) {
        const Vector<3> p = point_at(patch, at);
        piece.extent.include({{p[0], p[1], p[2]}, {p[0], p[1], p[2]}});
      }
      piece.extent = widened(piece.extent, bend_of(given.at, piece.bending) + piece.slack);
    }
  });
  return pieces;
}

WallState TrueWall::wall_state_of(const Ball<3>& ball, const CertifyOptions& options, Tally& tally) const {
  bool clear = true;
  double distance = Box<3>::infinity;
  const double known = std::max(wall_distances_known_up_to(options), 0x1p-40 * ball.r);
  pieces_.for_each_touching(widened(ball.box(), known), [&](const Piece& piece) {
    ++tally.walls;
    ++tally.decisions.by_double;
    const TrueSurface::Piece& given = surface_.pieces[piece.number];
    Search search(surface_.patches[given.patch], piece.bending, ball, options, piece.slack);
    clear &= search.is_clear(given.at);
    distance = std::min(distance, search.distance());
  });
  const bool inside = triangles_.center_inside(ball, options.arithmetic, tally);
  if (!inside) distance = -triangles_.distance_from(ball.c);
  const bool holds = clear && inside && triangles_.is_farther_than(ball.c, track_);
  WallState state{.inside = holds};
  if (distance < Box<3>::infinity) state.add(distance, {ball.r, options.wall_gap}, holds);
  return state;
}

}  // namespace bernal::verify
