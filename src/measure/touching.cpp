#include "measure/touching.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "core/every_dimension.hpp"
#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "measure/patch.hpp"
#include "near/size_levels.hpp"

namespace bernal {
namespace {

/// Of a pair and its mirror image exactly one counts.
template <int D>
bool counts(std::uint32_t i, std::uint32_t j, const Vector<D>& d) {
  if (i != j) return i < j;
  for (int k = 0; k < D; ++k)
    if (d[k] != 0) return d[k] > 0;
  return false;
}

/// Converts a pair with a gap below the widest, for a `Part` of them.
struct AsPair {
  using Part = std::vector<NearPair>;
  double widest;

  template <int D>
  NearPair operator()(std::uint32_t i, std::uint32_t j, double gap, const Vector<D>&) const {
    return {i, j, gap};
  }
};
template <int D>
struct AsBond {
  using Part = std::vector<BondIn<D>>;
  double widest;

  BondIn<D> operator()(std::uint32_t i, std::uint32_t j, double gap, const Vector<D>& d) const {
    return {i, j, d, gap};
  }
};
struct AsDirection {
  using Part = std::vector<NearDirection>;
  double widest;

  NearDirection operator()(std::uint32_t i, std::uint32_t j, double, const Vector<3>& d) const {
    return {i, j, d.stableNormalized().cast<float>()};
  }
};
struct AsRanked {
  using Part = std::vector<RankedPair>;
  std::span<const double> gaps;
  double widest = gaps.back();

  template <int D>
  RankedPair operator()(std::uint32_t i, std::uint32_t j, double gap, const Vector<D>&) const {
    return {i, j, static_cast<std::uint32_t>(std::ranges::upper_bound(gaps, gap) - gaps.begin())};
  }
};
/// Counts the ends of pairs at once, in any order, and keeps the sum of a part.
template <int D>
struct AsSum {
  class Part {
   public:
    void push_back(const Vector<D>& n) {
      products_ += n * n.transpose();
      ++pairs_;
    }
    std::size_t size() const { return pairs_; }
    void shrink_to_fit() {}
    const Eigen::Matrix<double, D, D>& products() const { return products_; }

   private:
    Eigen::Matrix<double, D, D> products_ = Eigen::Matrix<double, D, D>::Zero();
    std::size_t pairs_ = 0;
  };
  double widest;
  std::uint32_t* ends;

  Vector<D> operator()(std::uint32_t i, std::uint32_t j, double, const Vector<D>& d) const {
    for (const std::uint32_t end : {i, j}) std::atomic_ref(ends[end]).fetch_add(1, std::memory_order_relaxed);
    return d.stableNormalized();
  }
};

/// Appends the pairs of sphere i, at `c`, with spheres of its own level and of larger ones: each pair is
/// found from its smaller sphere, whose search radius is small.
template <int D, class As>
void append_pairs(const std::vector<double>& radii, std::span<const SizeLevel<D>> levels, std::uint32_t i,
                  const Vector<D>& c, const As& as, typename As::Part& out) {
  const double r = radii[i];
  for (const SizeLevel<D>& level : levels) {
    const bool own = &level == &levels.back();
    const double reach = (1 + as.widest) * (r + level.largest);
    level.grid->for_each_near(c, reach, [&](std::uint32_t j, const Vector<D>& d) {
      if (own && !counts<D>(i, j, d)) return;
      const double squared = d.squaredNorm();
      if (!(squared < reach * reach)) return;
      const double sum = r + radii[j], gap = (std::sqrt(squared) - sum) / sum;
      if (gap < as.widest) out.push_back(as(i, j, gap, d));
    });
  }
}

/// A sphere much larger than its box would meet countless images.
template <int D>
void require_countable_images(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary,
                              double widest_gap) {
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

/// If spheres do not overlap much, each has fewer pairs with spheres of its size and larger ones than its
/// possible neighbours, several times over.
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

template <class As>
using Parts = std::vector<typename As::Part>;

/// In consecutive parts.
template <int D, class As>
Parts<As> parts_among(Spheres<D> spheres, const TiltedBoundary<D>& boundary, const As& as) {
  constexpr std::size_t chunk = 4096;
  require_countable_images(spheres, boundary, as.widest);
  const std::size_t most = most_pairs<D>(spheres.size(), as.widest);
  const std::vector<SizeLevel<D>> levels = levels_of(spheres, boundary, as.widest);
  spheres.x = {};  // the grids hold them
  Parts<As> parts;
  std::size_t pairs = 0;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const PointGrid<D>& grid = *levels[l].grid;
    const std::size_t n = grid.ids().size(), before = parts.size();
    parts.resize(before + (n + chunk - 1) / chunk);
    parallel_for(parts.size() - before, [&](std::size_t part) {
      auto& found = parts[before + part];
      for (std::size_t place = part * chunk; place < std::min(n, (part + 1) * chunk); ++place) {
        append_pairs<D>(spheres.r, std::span(levels).first(l + 1), grid.ids()[place], grid.point(place), as,
                        found);
        require_few(found.size(), most);
      }
      found.shrink_to_fit();
    });
    for (std::size_t p = before; p < parts.size(); ++p) require_few(pairs += parts[p].size(), most);
  }
  return parts;
}

template <class Found>
std::vector<Found> joined(std::vector<std::vector<Found>> parts) {
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  std::vector<Found> all;
  all.reserve(count);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    part = {};
  }
  return all;
}

/// Whether to work in the frame of the walls, which keeps digits that are lost far from the origin.
bool has_own_frame(const Domain& domain) { return has_walls(domain) && dimension_of(domain) == 3; }

template <class As>
Parts<As> parts_in_own_frame(const Spheres<dynamic>& spheres, const Domain& domain, const As& as) {
  const Frame frame = frame_of(domain);
  return parts_among<3>(localised(spheres, frame), localised(boundary_of<3>(domain), frame), as);
}

template <class As>
Parts<As> parts_of(const Spheres<dynamic>& spheres, const Domain& domain, const As& as) {
  if (spheres.empty()) return {};
  if (has_own_frame(domain)) return parts_in_own_frame(spheres, domain, as);
  return with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    return parts_among<D>(spheres.in<D>(), tilted_boundary_of<D>(domain), as);
  });
}

/// Precondition: three dimensions.
template <class As>
Parts<As> parts_in_space(const Spheres<dynamic>& spheres, const Domain& domain, const As& as) {
  if (spheres.empty()) return {};
  if (has_own_frame(domain)) return parts_in_own_frame(spheres, domain, as);
  return parts_among<3>(spheres.in<3>(), tilted_boundary_of<3>(domain), as);
}

}  // namespace

std::vector<NearPair> near_pairs(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  return joined(parts_of(spheres, domain, AsPair{widest_gap}));
}

std::vector<std::vector<RankedPair>> ranked_pairs(const Spheres<dynamic>& spheres, const Domain& domain,
                                                  std::span<const double> gaps) {
  return parts_of(spheres, domain, AsRanked{gaps});
}

namespace {

template <int D, class As>
Parts<As> parts_in_dimension(const Spheres<dynamic>& spheres, const Domain& domain, const As& as) {
  if (spheres.empty()) return {};
  if constexpr (D == 3)
    return parts_in_space(spheres, domain, as);
  else
    return parts_among<D>(spheres.in<D>(), tilted_boundary_of<D>(domain), as);
}

}  // namespace

template <int D>
std::vector<BondIn<D>> bonds_in(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  return joined(parts_in_dimension<D>(spheres, domain, AsBond<D>{widest_gap}));
}

std::vector<NearBond> near_bonds(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  return bonds_in<3>(spheres, domain, widest_gap);
}

BondSums bond_sums(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap) {
  BondSums sums;
  const int dimension = spheres.dimension();
  sums.ends.resize(spheres.size());
  sums.products = Eigen::MatrixXd::Zero(dimension, dimension);
  with_dimension(dimension, EveryDimension{}, [&](auto of_space) {
    constexpr int D = of_space;
    for (const auto& part : parts_in_dimension<D>(spheres, domain, AsSum<D>{widest_gap, sums.ends.data()})) {
      sums.products += part.products();
      sums.pairs += part.size();
    }
  });
  return sums;
}

namespace {

/// The largest distance of a neighbour's centre.
double bond_reach(const Spheres<dynamic>& spheres, double widest_gap) {
  return 2 * (1 + widest_gap) * std::ranges::max(spheres.r);
}

template <int D>
Patch<D> middle_patch(const Spheres<dynamic>& spheres, const Domain& domain, std::size_t most,
                      double margin) {
  const Vector<D> middle = bounds_of<dynamic>(domain).center();
  return patch_of<D>(spheres, boundary_of<D>(domain), middle, most, margin);
}

template <int D, class As>
Parts<As> parts_in(Patch<D>&& patch, const Domain& domain, const As& as) {
  if constexpr (D == 3)
    if (has_own_frame(domain)) {
      const Frame frame = frame_of(domain);
      return parts_among<3>(localised(Spheres<dynamic>(std::move(patch.spheres)), frame),
                            localised(patch.boundary, frame), as);
    }
  return parts_among<D>(std::move(patch.spheres), patch.boundary, as);
}

}  // namespace

BondsInside near_directions_inside(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap,
                                   std::size_t most) {
  BondsInside inside;
  if (spheres.size() <= most || is_tilted(domain)) {  // a patch knows upright boxes only
    inside.asked = spheres.size();
    inside.bonds = parts_in_space(spheres, domain, AsDirection{widest_gap});
    return inside;
  }
  Patch<3> patch = middle_patch<3>(spheres, domain, most, 2 * bond_reach(spheres, widest_gap));
  inside.ids = std::move(patch.ids);
  inside.asked = patch.asked;
  inside.bonds = parts_in<3>(std::move(patch), domain, AsDirection{widest_gap});
  return inside;
}

std::vector<NearPair> near_pairs_inside(const Spheres<dynamic>& spheres, const Domain& domain,
                                        double widest_gap, std::size_t most) {
  if (spheres.size() <= most || is_tilted(domain)) return near_pairs(spheres, domain, widest_gap);
  return with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    Patch<D> patch = middle_patch<D>(spheres, domain, most, bond_reach(spheres, widest_gap));
    const std::vector<std::uint32_t> ids = std::move(patch.ids);
    const std::size_t asked = patch.asked;
    std::vector<NearPair> pairs = joined(parts_in<D>(std::move(patch), domain, AsPair{widest_gap}));
    std::erase_if(pairs, [&](const NearPair& pair) { return pair.first >= asked && pair.second >= asked; });
    for (NearPair& pair : pairs) pair = {ids[pair.first], ids[pair.second], pair.gap};
    return pairs;
  });
}

namespace {

/// Calls visit(sphere, gap, direction to the wall) for every wall of a box of any dimension.
template <class Visit>
void visit_faces(const Box& box, const Spheres<dynamic>& spheres, double widest_gap, const Visit& visit) {
  const int dimension = box.dimension();
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i];
    for (int k = 0; k < dimension; ++k) {
      if (!box.has_wall(k)) continue;
      const double c = spheres.x[static_cast<std::size_t>(k)][i];
      for (const auto& [clearance, sign] :
           {std::pair{c - box.corner[k], -1.0}, std::pair{box.corner[k] + box.size[k] - c, 1.0}})
        if (clearance < (1 + widest_gap) * r)
          visit(i, (clearance - r) / r, Vector<dynamic>(sign * Vector<dynamic>::Unit(dimension, k)));
    }
  }
}

template <class Visit>
void visit_walls(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap,
                 const std::shared_ptr<const Container>& made, const Visit& visit) {
  if (spheres.empty() || !has_walls(domain)) return;
  const auto* box = std::get_if<Box>(&domain);
  if (box && !has_own_frame(domain)) return visit_faces(*box, spheres, widest_gap, visit);
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, made);
  const Spheres<3> local = localised(spheres, frame);
  std::vector<WallPoint> points;
  for (std::uint32_t i = 0; i < local.size(); ++i) {
    const double r = local.r[i], reach = (1 + widest_gap) * r;
    points.clear();
    container->walls_near(local.center(i), reach, points);
    for (const WallPoint& p : points)
      if (p.clearance < reach)
        visit(i, (p.clearance - r) / r, Vector<dynamic>(-p.inward.head(spheres.dimension())));
  }
}

}  // namespace

std::vector<NearWall> near_walls(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap,
                                 const std::shared_ptr<const Container>& made) {
  std::vector<NearWall> near;
  const auto add = [&](std::uint32_t i, double gap, const auto&) { near.push_back({i, gap}); };
  visit_walls(spheres, domain, widest_gap, made, add);
  return near;
}

std::vector<WallBond> wall_bonds(const Spheres<dynamic>& spheres, const Domain& domain, double widest_gap,
                                 const std::shared_ptr<const Container>& made) {
  std::vector<WallBond> near;
  visit_walls(spheres, domain, widest_gap, made, [&](std::uint32_t i, double gap, const auto& outward) {
    near.push_back({i, outward, gap});
  });
  return near;
}

#define BERNAL_INSTANTIATE(D) \
  template std::vector<BondIn<D>> bonds_in<D>(const Spheres<dynamic>&, const Domain&, double);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
