#include "measure/touching.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/domain/container.hpp"
#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "measure/size_levels.hpp"

namespace bernal {
namespace {

/// Of a pair and its mirror image, seen from the other end, exactly one is counted.
template <int D>
bool counts(std::uint32_t i, std::uint32_t j, const Vector<D>& d) {
  if (i != j) return i < j;
  for (int k = 0; k < D; ++k)
    if (d[k] != 0) return d[k] > 0;
  return false;
}

template <int D>
void append(std::vector<NearPair>& out, std::uint32_t i, std::uint32_t j, double gap, const Vector<D>&) {
  out.push_back({i, j, gap});
}
void append(std::vector<NearBond>& out, std::uint32_t i, std::uint32_t j, double gap, const Vector<3>& d) {
  out.push_back({i, j, d, gap});
}

/// The pairs of sphere i, at `c`, with spheres of its own level and of larger ones: each pair is met from its
/// smaller end, which need not look far.
template <int D, class Found>
void append_pairs(const Spheres<D>& spheres, std::span<const Level<D>> levels, std::uint32_t i,
                  const Vector<D>& c, double widest_gap, std::vector<Found>& out) {
  const double r = spheres.r[i];
  for (const Level<D>& level : levels) {
    const bool own = &level == &levels.back();
    const double reach = (1 + widest_gap) * (r + level.largest);
    level.grid->for_each_near(c, reach, [&](std::uint32_t j, const Vector<D>& d) {
      if (own && !counts<D>(i, j, d)) return;
      const double squared = d.squaredNorm();
      if (!(squared < reach * reach)) return;
      const double sum = r + spheres.r[j], gap = (std::sqrt(squared) - sum) / sum;
      if (gap < widest_gap) append(out, i, j, gap, d);
    });
  }
}

/// A sphere that is much larger than its box meets images without number.
template <int D>
void require_countable_images(const Spheres<D>& spheres, const Boundary<D>& boundary, double widest_gap) {
  constexpr double most_images = 1e6;  // of a sphere; one as large as its box meets 3^D
  const double largest = spheres.empty() ? 0 : std::ranges::max(spheres.r),
               reach = 2 * (1 + widest_gap) * largest;
  double images = 1;
  for (int k = 0; k < D; ++k)
    if (boundary.repeats(k)) images *= 1 + 2 * reach / boundary.edges[k];
  if (!(images <= most_images))
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("a sphere of radius {:g} is so much larger than its box that it meets {:.0g} of its own "
                    "images: check the units of the spheres and of the box",
                    largest, images));
}

/// Of spheres that do not overlap much, each has fewer such pairs with those of its size and larger ones than
/// a sphere of its size can have neighbours, several times over.
template <int D>
std::size_t most_pairs(std::size_t spheres, double widest_gap) {
  constexpr double few = 1e6, neighbours = 100;
  const double dimensions = std::exp2(std::max(0, D - 3));
  return static_cast<std::size_t>(few + neighbours * dimensions * std::pow(1 + widest_gap, D) *
                                            static_cast<double>(spheres));
}

void require_few(std::size_t pairs, std::size_t most) {
  if (pairs > most)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("more than {} pairs of spheres touch or overlap, which is no packing: bernal verify "
                    "lists them",
                    most));
}

template <class Found, int D>
std::vector<Found> pairs_among(const Spheres<D>& spheres, const Boundary<D>& boundary, double widest_gap) {
  constexpr std::size_t chunk = 4096;
  require_countable_images(spheres, boundary, widest_gap);
  const std::size_t most = most_pairs<D>(spheres.size(), widest_gap);
  const std::vector<Level<D>> levels = levels_of(spheres, boundary, widest_gap);
  std::vector<Found> pairs;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const PointGrid<D>& grid = *levels[l].grid;
    const std::size_t n = grid.ids().size();
    std::vector<std::vector<Found>> found((n + chunk - 1) / chunk);
    parallel_for(found.size(), [&](std::size_t part) {
      for (std::size_t place = part * chunk; place < std::min(n, (part + 1) * chunk); ++place) {
        append_pairs<D>(spheres, std::span(levels).first(l + 1), grid.ids()[place], grid.point(place),
                        widest_gap, found[part]);
        require_few(found[part].size(), most);
      }
    });
    for (const std::vector<Found>& part : found) {
      pairs.insert(pairs.end(), part.begin(), part.end());
      require_few(pairs.size(), most);
    }
  }
  return pairs;
}

/// Whether to work in the frame of the walls, which keeps the digits that far away would be lost.
bool has_own_frame(const Domain& domain) { return has_walls(domain) && dimension_of(domain) == 3; }

template <class Found>
std::vector<Found> pairs_in_own_frame(const Spheres<dynamic>& spheres, const Domain& domain,
                                      double widest_gap) {
  const Frame frame = frame_of(domain);
  return pairs_among<Found, 3>(localised(spheres, frame), localised(boundary_of<3>(domain), frame),
                               widest_gap);
}

}  // namespace

std::vector<NearPair> near_pairs(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  if (spheres.empty()) return {};
  if (has_own_frame(domain)) return pairs_in_own_frame<NearPair>(spheres, domain, widest_gap);
  return with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    return pairs_among<NearPair, D>(spheres.in<D>(), boundary_of<D>(domain), widest_gap);
  });
}

std::vector<NearBond> near_bonds(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  if (spheres.empty()) return {};
  if (has_own_frame(domain)) return pairs_in_own_frame<NearBond>(spheres, domain, widest_gap);
  return pairs_among<NearBond, 3>(spheres.in<3>(), boundary_of<3>(domain), widest_gap);
}

namespace {

/// Those of a box of any dimension.
std::vector<NearWall> near_faces(const Box& box, const Spheres<dynamic>& spheres, double widest_gap) {
  std::vector<NearWall> near;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    for (int k = 0; k < box.dimension(); ++k) {
      if (!box.has_wall(k)) continue;
      const double c = spheres.x[static_cast<std::size_t>(k)][i];
      for (const double clearance : {c - box.corner[k], box.corner[k] + box.size[k] - c})
        if (clearance < (1 + widest_gap) * r) near.push_back({i, (clearance - r) / r});
    }
  }
  return near;
}

}  // namespace

std::vector<NearWall> near_walls(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap,
                                 const std::shared_ptr<const Container>& made) {
  if (spheres.empty() || !has_walls(domain)) return {};
  const auto* box = std::get_if<Box>(&domain);
  if (box && !has_own_frame(domain)) return near_faces(*box, spheres, widest_gap);
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, made);
  const Spheres<3> local = localised(spheres, frame);
  std::vector<NearWall> near;
  std::vector<WallPoint> points;
  for (std::uint32_t i = 0; i < local.size(); ++i) {
    const double r = local.r[i], reach = (1 + widest_gap) * r;
    points.clear();
    container->walls_near(local.center(i), reach, points);
    for (const WallPoint& p : points)
      if (p.clearance < reach) near.push_back({i, (p.clearance - r) / r});
  }
  return near;
}

}  // namespace bernal
