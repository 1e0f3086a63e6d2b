#include "verify/true_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"
#include "geometry/curved_patch.hpp"
#include "verify/least_gap.hpp"
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
        radius_(ball.r),
        reach_(rounded_up(ball.r + options.wall_gap)),
        slack_(slack + 0x1p-43 * ball.c.cwiseAbs().maxCoeff()) {}

  bool is_clear(const ParameterTriangle& at) { return is_clear(whole(at)); }

  /// In double; any number that is not below `below` where the distance is not. Parts are halved until they
  /// bend by less than the error allowed, which at most a million parts of a piece do; none is left out that
  /// could be the nearest by less than that error, so that the distance does not depend on `below`.
  double distance(const ParameterTriangle& at, double below) {
    const double error = std::max(1e-8 * radius_, 0x1p-20 * bend_of(at, bending_));
    approach(whole(at), error, below);
    return below;
  }

 private:
  struct Part {
    ParameterTriangle at;
    Corners corners;
  };

  Part whole(const ParameterTriangle& at) const {
    Part part{at, {}};
    for (int k = 0; k < 3; ++k) part.corners[k] = point_at(patch_, at[k]);
    return part;
  }

  std::array<Part, 2> halves(const Part& part) const {
    const int edge = edge_to_halve(part.at, bending_), other = (edge + 1) % 3;
    const std::array<double, 2> at = middle_of_edge(part.at, edge);
    Part first = part, second = part;
    first.at[other] = second.at[edge] = at;
    first.corners[other] = second.corners[edge] = point_at(patch_, at);
    return {first, second};
  }

  bool is_clear(const Part& part) {
    const double bend = bend_of(part.at, bending_);
    if (distance_from_triangle(center_, part.corners) - bend - slack_ >= reach_) return true;
    for (const Vector<3>& corner : part.corners)
      if ((corner - center_).norm() < reach_) return false;
    if (bend <= 0.01 * slack_ || --budget_ < 0) return false;
    const auto [first, second] = halves(part);
    return is_clear(first) && is_clear(second);
  }

  void approach(const Part& part, double error, double& best) const {
    const double bend = bend_of(part.at, bending_);
    const double flat = distance_from_triangle(center_, part.corners);
    if (flat - bend - slack_ - 2 * error >= best) return;
    if (bend <= error) {
      best = std::min(best, flat);
      return;
    }
    auto [first, second] = halves(part);
    if (distance_from_triangle(center_, second.corners) < distance_from_triangle(center_, first.corners))
      std::swap(first, second);
    approach(first, error, best);
    approach(second, error, best);
  }

  const TrueSurface::Patch& patch_;
  Bending bending_;
  Vector<3> center_;
  double radius_, reach_, slack_;
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

WallState TrueWall::wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double least,
                                  Tally& tally) const {
  bool clear = true;
  const double known = std::max(wall_distances_known_up_to(options), 0x1p-40 * ball.r);
  const auto search = [&](const Piece& piece) {
    const TrueSurface::Piece& given = surface_.pieces[piece.number];
    return Search(surface_.patches[given.patch], piece.bending, ball, options, piece.slack);
  };
  pieces_.for_each_touching(widened(ball.box(), known), [&](const Piece& piece) {
    ++tally.walls;
    ++tally.decisions.by_double;
    clear &= search(piece).is_clear(surface_.pieces[piece.number].at);
  });
  const bool inside = triangles_.center_inside(ball, options.arithmetic, tally);
  const bool holds = clear && inside && triangles_.is_farther_than(ball.c, track_);
  double distance = Box<3>::infinity;
  if (inside) {
    const double largest = std::max(largest_coordinate(pieces_.box()), largest_coordinate(ball.box()));
    const double below = holds
                             ? std::max(ball.r + known, wall_reach(least, ball.r, options.wall_gap, largest))
                             : Box<3>::infinity;
    const double nearest =
        pieces_.nearest([&](const Box<3>& box) { return least_distance_from_box(ball.c, box, largest); },
                        [&](const Piece& piece, double best) {
                          return search(piece).distance(surface_.pieces[piece.number].at, best);
                        },
                        below);
    if (nearest < below) distance = nearest;
  } else {
    distance = -triangles_.distance_from(ball.c);
  }
  WallState state{.inside = holds};
  if (distance < Box<3>::infinity) state.add(distance, {ball.r, options.wall_gap}, holds);
  return state;
}

}  // namespace bernal::verify
