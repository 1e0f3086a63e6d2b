#include "verify/polygon_wall.hpp"

#include <algorithm>
#include <cmath>

#include "verify/least_gap.hpp"
#include "verify/predicates.hpp"
#include "verify/space.hpp"

namespace bernal::verify {

PolygonWall::PolygonWall(const Polygon& polygon) : edges_(edges_of(polygon)) {}

std::vector<PlaneEdge> PolygonWall::edges_of(const Polygon& polygon) {
  std::vector<PlaneEdge> edges;
  for (const auto& loop : polygon.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      require(loop[k].allFinite(), "a polygon needs finite corners");
      edges.push_back({loop[k], loop[(k + 1) % loop.size()]});
    }
  }
  require(!edges.empty(), "a polygon needs corners");
  return edges;
}

WallState PolygonWall::wall_state_of(const Ball<2>& ball, const CertifyOptions& options, double least,
                                     Tally& tally) const {
  const Arithmetic arithmetic = options.arithmetic;
  const Reach reach{ball.r, options.wall_gap};
  bool clear = true;
  double distance = Box<2>::infinity;
  edges_.for_each_touching(widened(ball.box(), wall_distances_known_up_to(options)),
                           [&](const PlaneEdge& edge) {
                             ++tally.walls;
                             clear &= decide(arithmetic, tally.decisions, [&]<class Number>() {
                                        return ball_clears_edge<Number>(ball.c, reach, edge.a, edge.b);
                                      }) == Truth::yes;
                             distance = std::min(distance, distance_from_segment<2>(ball.c, edge.a, edge.b));
                           });

  const bool inside = center_inside(ball, arithmetic, tally);
  const double largest = std::max(largest_coordinate(edges_.box()), largest_coordinate(ball.box()));
  if (inside)
    distance = std::min(distance,
                        distance_from(ball.c, wall_reach(least, ball.r, options.wall_gap, largest), largest));
  else
    distance = -distance_from(ball.c, Box<2>::infinity, largest);
  const bool holds = inside && clear;
  WallState state{.inside = holds};
  if (distance < Box<2>::infinity) state.add(distance, reach, holds);
  return state;
}

double PolygonWall::distance_from(const Vector<2>& p, double below, double largest) const {
  const double nearest = edges_.nearest(
      [&](const Box<2>& box) { return least_distance_from_box(p, box, largest); },
      [&](const PlaneEdge& edge, double) { return distance_from_segment<2>(p, edge.a, edge.b); }, below);
  return nearest < below ? nearest : Box<2>::infinity;
}

bool PolygonWall::center_inside(const Ball<2>& ball, Arithmetic arithmetic, Tally& tally) const {
  const Box<2> to_the_right{{ball.c[0], ball.c[1]}, {Box<2>::infinity, ball.c[1]}};
  bool odd = false;
  Decisions crossings;
  edges_.for_each_touching(to_the_right, [&](const PlaneEdge& edge) {
    odd ^= decide(arithmetic, crossings, [&]<class Number>() {
             return crossing_to_the_right<Number>(ball.c, edge.a, edge.b);
           }) == Truth::yes;
  });
  ++tally.centers;
  const bool by_double = arithmetic == Arithmetic::filtered && crossings.by_exact == 0;
  ++(by_double ? tally.decisions.by_double : tally.decisions.by_exact);
  return odd;
}

}  // namespace bernal::verify
