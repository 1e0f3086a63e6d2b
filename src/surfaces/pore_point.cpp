#include <algorithm>
#include <cmath>

#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "domain/without_walls.hpp"
#include "surfaces/surfaces.hpp"

namespace bernal {
namespace {

/// The n-th number of the Halton sequence in [0, 1) in that base. Source: Halton, Numer. Math. 2 (1960) 84.
double halton(std::uint32_t n, std::uint32_t base) {
  double value = 0, share = 1;
  for (; n > 0; n /= base) {
    share /= base;
    value += share * (n % base);
  }
  return value;
}

/// The gap to the nearest sphere, and the direction away from its nearest image.
struct Nearest {
  double gap;
  Vector<3> away;
};

class Gaps {
 public:
  Gaps(const Spheres<dynamic>& spheres, const Domain& domain)
      : spheres_(spheres), boundary_(boundary_of<3>(domain)), farthest_(bounds_of(domain).size().norm()) {}

  Nearest at(const Vector<3>& p) const {
    Nearest nearest{farthest_, Vector<3>::Zero()};
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
      const Vector<3> from =
          boundary_.minimum_image(p - Vector<3>(spheres_.x[0][i], spheres_.x[1][i], spheres_.x[2][i]));
      const double gap = from.norm() - spheres_.r[i];
      if (gap < nearest.gap) nearest = {gap, from};
    }
    return nearest;
  }

 private:
  const Spheres<dynamic>& spheres_;
  Boundary<3> boundary_;
  double farthest_;  ///< if there are no spheres
};

/// Whether the ball meets no sphere or image.
bool clears_spheres(const PorePoint& ball, const Spheres<dynamic>& spheres, const Domain& domain) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  const Box box = without_walls(domain);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> c(spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]);
    // Only near spheres and nearest images: the rest is too far to need the certificate.
    if (boundary.minimum_image(ball.place - c).norm() > 2 * (ball.clearance + spheres.r[i])) continue;
    Spheres<3> pair;
    pair.push_back(ball.place, ball.clearance);
    pair.push_back(c, spheres.r[i]);
    if (certify(pair, box, {.threads = 1}).overlapping_pairs > 0) return false;
  }
  return true;
}

/// The balls inside the walls, in order.
std::vector<PorePoint> inside(const Mesh& walls, const std::vector<PorePoint>& balls) {
  if (walls.triangles.empty() || balls.empty()) return balls;
  Spheres<3> all;
  for (const PorePoint& ball : balls) all.push_back(ball.place, ball.clearance);
  std::vector<bool> protrudes(balls.size());
  for (const auto& [sphere, gap] : certify(all, walls, {.list = CertifyOptions::all}).protrusions)
    protrudes[sphere] = true;
  std::vector<PorePoint> kept;
  for (std::size_t n = 0; n < balls.size(); ++n)
    if (!protrudes[n]) kept.push_back(balls[n]);
  return kept;
}

}  // namespace

std::optional<PorePoint> point_in_pores(const Spheres<dynamic>& spheres, const Domain& domain,
                                        const WallSurface& walls) {
  const Bounds<3> bounds = bounds_of(domain);
  const Gaps gaps(spheres, domain);
  const Mesh mesh = walls.extended(boundary_of<3>(domain));
  const auto candidates =
      static_cast<std::uint32_t>(std::clamp(4e7 / static_cast<double>(spheres.size() + 1), 64.0, 4096.0));
  std::vector<PorePoint> found(candidates);
  parallel_for(candidates, [&](std::size_t n) {
    const auto k = static_cast<std::uint32_t>(n + 1);
    const Vector<3> share(halton(k, 2), halton(k, 3), halton(k, 5));
    Vector<3> p = bounds.lower + share.cwiseProduct(bounds.size());
    Nearest nearest = gaps.at(p);
    for (int step = 0; step < 8 && spheres.size() < 20'000; ++step) {
      const double length = nearest.away.norm();
      if (!(length > 0)) break;
      const Vector<3> next = p + std::max(0.3 * std::abs(nearest.gap), 0.02 * length) / length * nearest.away;
      const Nearest there = gaps.at(next);
      const bool stays =
          (next.array() > bounds.lower.array()).all() && (next.array() < bounds.upper.array()).all();
      if (!stays || !(there.gap > nearest.gap)) break;
      p = next;
      nearest = there;
    }
    found[n] = {p, nearest.gap};
  });
  std::ranges::stable_sort(found, std::greater(), &PorePoint::clearance);
  // Walls are judged by the certificate alone: first whether a point is inside, then its distance.
  std::erase_if(found, [](const PorePoint& point) { return !(point.clearance > 0); });
  const double tiny = 1e-6 * bounds.size().minCoeff();
  std::vector<PorePoint> small = found;
  for (PorePoint& point : small) point.clearance = std::min(point.clearance, tiny);
  small = inside(mesh, small);
  std::erase_if(found, [&](const PorePoint& point) {
    return std::ranges::none_of(small, [&](const PorePoint& kept) { return kept.place == point.place; });
  });
  constexpr std::size_t most_judged = 64;
  if (found.size() > most_judged) found.resize(most_judged);
  for (double share = 1 - 1e-9; share > 1e-3 && !found.empty(); share *= 0.9) {
    std::vector<PorePoint> balls = found;
    for (PorePoint& ball : balls) ball.clearance *= share;
    for (const PorePoint& ball : inside(mesh, balls))  // the largest first
      if (clears_spheres(ball, spheres, domain)) return ball;
  }
  return std::nullopt;
}

}  // namespace bernal
