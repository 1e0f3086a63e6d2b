#include "solids/pieces.hpp"

#include <algorithm>

namespace bernal {
namespace {

/// The extent of one of three axes.
struct Period {
  double lower, upper, length;
};

/// Whether the open ball reaches into the open period along all axes: its centre is nearer than its radius to
/// a point of the period.
bool reaches_in(const Piece& piece, const std::array<Period, 3>& periods) {
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(periods[k].length > 0)) continue;
    const double x = piece.center[static_cast<int>(k)];
    const double beyond = std::max({0.0, periods[k].lower - x, x - periods[k].upper});
    squared += beyond * beyond;
  }
  return squared < piece.radius * piece.radius;
}

void cut_at_ends(Piece& piece, const std::array<Period, 3>& periods) {
  for (int k = 0; k < 3; ++k) {
    const Period& period = periods[static_cast<std::size_t>(k)];
    if (!(period.length > 0)) continue;
    const double x = piece.center[k];
    if (x - piece.radius < period.lower) piece.cuts.push_back({{-Vector<3>::Unit(k), -period.lower}, 2 * k});
    if (x + piece.radius > period.upper)
      piece.cuts.push_back({{Vector<3>::Unit(k), period.upper}, 2 * k + 1});
  }
}

}  // namespace

std::vector<Piece> pieces_of(const Spheres<dynamic>& spheres, const Domain& domain) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  std::array<Period, 3> periods{};
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k))
      periods[static_cast<std::size_t>(k)] = {boundary.origin[k], boundary.origin[k] + boundary.edges[k],
                                              boundary.edges[k]};
  // The image in the period first, then its neighbours.
  constexpr std::array<int, 3> moves = {0, 1, -1};
  const auto moves_along = [&](std::size_t axis) { return periods[axis].length > 0 ? 3u : 1u; };

  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> center(spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]);
    for (std::size_t a = 0; a < moves_along(0); ++a)
      for (std::size_t b = 0; b < moves_along(1); ++b)
        for (std::size_t c = 0; c < moves_along(2); ++c) {
          Piece piece{.sphere = static_cast<std::uint32_t>(i),
                      .image = {moves[a], moves[b], moves[c]},
                      .center = center,
                      .radius = spheres.r[i]};
          for (int k = 0; k < 3; ++k)
            piece.center[k] += piece.image[static_cast<std::size_t>(k)] * boundary.edges[k];
          if (!reaches_in(piece, periods)) continue;
          cut_at_ends(piece, periods);
          pieces.push_back(std::move(piece));
        }
  }
  return pieces;
}

}  // namespace bernal
