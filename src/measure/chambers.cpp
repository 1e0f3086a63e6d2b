#include "bernal/measure/chambers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "domain/places.hpp"
#include "geometry/topology.hpp"
#include "measure/even_points.hpp"
#include "measure/free_cells.hpp"
#include "measure/localised.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

constexpr double cells_per_radius = 4;
constexpr double near_gap = 0.3;        ///< between spheres whose centres a chain of places may join
constexpr std::size_t most_known = 16;  ///< known places tried for every point
constexpr std::uint32_t none = Chambers::none;

/// The deepest places found on a coarse grid.
std::vector<Place> deepest_of_coarse_cells(const FreeSpace& space, double size) {
  constexpr double cells = 16;
  const FreeCells coarse(space, size / cells);
  std::vector<Place> deepest;
  for (std::size_t k = 0; k < coarse.components(); ++k)
    if (deepest.empty() || coarse.deepest(k).clearance > deepest.front().clearance)
      deepest = {coarse.deepest(k)};
  return deepest;
}

/// The components of the places in a container; at most one if it is convex.
class Components {
 public:
  Components(const Domain& shape, const FreeSpace& space, int cells) {
    const Bounds<3> bounds = space.container().bounds();
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (mesh && is_convex(*mesh)) deepest_ = deepest_of_coarse_cells(space, bounds.size().maxCoeff());
    const bool is_faceted_or_bent = mesh || std::holds_alternative<Revolved>(shape);
    if (is_faceted_or_bent && deepest_.empty()) {
      edge_ = std::max(space.radius() / cells_per_radius, bounds.size().maxCoeff() / cells);
      edge_ = std::min(edge_, bounds.size().maxCoeff());
      cells_.emplace(space, edge_);
      for (std::size_t k = 0; k < cells_->components(); ++k) deepest_.push_back(cells_->deepest(k));
    } else if (!is_faceted_or_bent) {
      const Place center = {bounds.center(), space.container().clearance(bounds.center())};
      if (space.is_place(center.clearance)) deepest_.push_back(center);
    }
  }

  double edge() const { return edge_; }
  double step() const { return cells_ ? cells_->step() : 0; }
  double coarse_step() const { return cells_ ? cells_->coarse_step() : 0; }
  /// A place well inside each component.
  const std::vector<Place>& deepest() const { return deepest_; }

  /// See FreeCells::find.
  std::optional<FreeCells::Found> find(const Place& place) const {
    if (deepest_.empty()) return {};
    if (!cells_) return FreeCells::Found{0, true};
    return cells_->find(place);
  }

 private:
  std::optional<FreeCells> cells_;
  double edge_ = 0;
  std::vector<Place> deepest_;
};

/// A sphere's centre as a place; absent if it is none.
std::vector<std::optional<Place>> centers_of(const FreeSpace& space, const Spheres<3>& spheres) {
  std::vector<std::optional<Place>> centers(spheres.size());
  parallel_for(spheres.size(), [&](std::size_t i) {
    const Vector<3> c = spheres.center(i);
    const double clearance = space.container().clearance_within(c, 2 * space.radius());
    if (space.is_place(clearance)) centers[i] = Place{c, clearance};
  });
  return centers;
}

/// Merges components that spheres connect, and adds places that only a sphere found. Returns the sets of the
/// components, then those of the spheres.
std::vector<std::uint32_t> linked(const Components& components, const FreeSpace& space,
                                  const Spheres<dynamic>& spheres, const Domain& domain,
                                  const std::vector<std::optional<Place>>& centers) {
  const std::size_t n = components.deepest().size();
  std::vector<std::uint32_t> found(centers.size(), none);
  parallel_for(centers.size(), [&](std::size_t i) {
    if (!centers[i]) return;
    const std::optional<FreeCells::Found> component = components.find(*centers[i]);
    if (component && component->joined) found[i] = component->component;
  });
  DisjointSets sets(n + centers.size());
  for (std::uint32_t i = 0; i < found.size(); ++i)
    if (found[i] != none) sets.unite(found[i], static_cast<std::uint32_t>(n + i));

  std::vector<NearBond> open;
  if (n > 1 || std::ranges::find(found, none) != found.end()) open = near_bonds(spheres, domain, near_gap);
  std::erase_if(open, [&](const NearBond& bond) {
    return !centers[bond.first] || !centers[bond.second] ||
           (found[bond.first] == found[bond.second] && found[bond.first] != none);
  });
  std::vector<std::uint8_t> joined(open.size());
  parallel_for(open.size(), [&](std::size_t k) {
    joined[k] = space.joined(*centers[open[k].first], *centers[open[k].second], components.step(),
                             components.coarse_step());
  });
  for (std::size_t k = 0; k < open.size(); ++k)
    if (joined[k])
      sets.unite(static_cast<std::uint32_t>(n + open[k].first),
                 static_cast<std::uint32_t>(n + open[k].second));
  return sets.numbered();
}

/// Counts of points that fill the container evenly.
struct Sampled {
  std::size_t inside = 0;
  std::vector<std::size_t> covered;  ///< by chamber
  std::size_t uncovered = 0;

  double share(std::size_t points) const {
    return inside > 0 ? static_cast<double>(points) / static_cast<double>(inside) : 0;
  }
  double error(std::size_t points) const {
    const double s = share(points);
    return inside > 0 ? std::sqrt(s * (1 - s) / static_cast<double>(inside)) : 0;
  }
};

/// `chamber_of(place)` is called for the place nearest to a point, if a sphere there covers the point.
/// `known` places are tried first: spheres nearly as large as a round part of a mesh cover most of it from
/// there, and the search for the nearest wall is slow.
template <class ChamberOf>
Sampled sample(const FreeSpace& space, std::span<const Place> known, std::size_t chambers,
               std::uint32_t points, ChamberOf&& chamber_of) {
  enum : std::uint32_t { outside = none, uncovered = none - 1, elsewhere = none - 2 };
  const Bounds<3> bounds = space.container().bounds();
  const bool fills = fills_its_bounds(space.container());
  std::vector<Vector<3>> inside;  // if even points in the bounds would hardly ever be inside
  if (!fills) inside = points_inside(space.container(), points, 1, {});
  const double waste = std::max(1.0, bounds.volume() / space.container().volume());
  std::vector<std::uint32_t> kinds(fills ? static_cast<std::size_t>(waste * points) : inside.size());
  parallel_for(kinds.size(), [&](std::size_t k) {
    const Vector<3> p = fills ? bounds.lower + bounds.size().cwiseProduct(even_point(k)) : inside[k];
    kinds[k] = outside;
    if (fills && !space.container().contains(p, 0)) return;
    std::optional<Place> place;
    const auto near =
        std::ranges::find_if(known, [&](const Place& at) { return (at.point - p).norm() <= space.radius(); });
    if (near != known.end()) place = *near;
    if (!place) place = space.nearest(p, space.radius());
    kinds[k] = place ? std::min<std::uint32_t>(chamber_of(*place), elsewhere) : uncovered;
  });
  Sampled sampled;
  sampled.covered.resize(chambers);
  for (const std::uint32_t kind : kinds) {
    sampled.inside += kind != outside;
    sampled.uncovered += kind == uncovered;
    if (kind < chambers) ++sampled.covered[kind];
  }
  return sampled;
}

Chambers::Uncovered uncovered_of(const Sampled& sampled, double radius) {
  return {radius, sampled.share(sampled.uncovered), sampled.error(sampled.uncovered)};
}

/// Sorts the chambers by decreasing share, then by decreasing number of spheres.
void sort(Chambers& found) {
  std::vector<std::uint32_t> order(found.chambers.size()), place(found.chambers.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](std::uint32_t i, std::uint32_t j) {
    const Chambers::Chamber &a = found.chambers[i], &b = found.chambers[j];
    return a.share != b.share ? a.share > b.share : a.spheres > b.spheres;
  });
  std::vector<Chambers::Chamber> sorted;
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    sorted.push_back(found.chambers[order[k]]);
    place[order[k]] = k;
  }
  found.chambers = std::move(sorted);
  for (std::uint32_t& chamber : found.of_sphere)
    if (chamber != none) chamber = place[chamber];
}

/// `packed` may be null: then only chambers for spheres of that radius.
Chambers chambers_in(const Domain& shape, const Spheres<dynamic>* packed, double radius, double mean_radius,
                     const ChamberOptions& options, const std::shared_ptr<const Container>& made) {
  const Frame frame = frame_of(shape);
  const auto container = local_container(shape, made);
  const FreeSpace space(*container, radius / frame.scale);
  const Components components(shape, space, options.cells);
  const Spheres<3> spheres = packed ? localised(*packed, frame) : Spheres<3>{};
  const std::vector<std::optional<Place>> centers = centers_of(space, spheres);
  const std::size_t n = components.deepest().size();
  const std::vector<std::uint32_t> sets =
      packed ? linked(components, space, *packed, shape, centers) : DisjointSets(n).numbered();

  Chambers found;
  found.radius = radius;
  found.resolution = frame.scale * components.edge();
  std::vector<std::uint32_t> chamber_of_set(sets.size(), none);
  const auto chamber_at = [&](std::uint32_t set, const Vector<3>& position) {
    std::uint32_t& chamber = chamber_of_set[set];
    if (chamber == none) {
      chamber = static_cast<std::uint32_t>(found.chambers.size());
      found.chambers.push_back(
          {frame.to_scene(position), frame.scale * container->clearance(position), 0, 0, 0, 0});
    }
    return chamber;
  };
  for (std::size_t k = 0; k < n; ++k) chamber_at(sets[k], components.deepest()[k].point);
  std::vector<double> solid;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    found.of_sphere.push_back(centers[i] ? chamber_at(sets[n + i], centers[i]->point) : none);
    solid.resize(found.chambers.size());
    if (!centers[i]) {
      ++found.misplaced;
      continue;
    }
    ++found.chambers[found.of_sphere[i]].spheres;
    solid[found.of_sphere[i]] += ball_volume(3, spheres.r[i]);
  }

  std::vector<Place> known = components.deepest();
  known.resize(std::min(known.size(), most_known));
  const Sampled sampled = sample(space, known, found.chambers.size(), options.points, [&](const Place& at) {
    if (found.chambers.size() == 1) return 0u;
    const std::optional<FreeCells::Found> component = components.find(at);
    return component ? chamber_of_set[sets[component->component]] : none;
  });
  for (std::size_t k = 0; k < found.chambers.size(); ++k) {
    Chambers::Chamber& chamber = found.chambers[k];
    chamber.share = sampled.share(sampled.covered[k]);
    chamber.share_error = sampled.error(sampled.covered[k]);
    if (packed && chamber.share > 0)
      chamber.packing_fraction = solid[k] / (chamber.share * container->volume());
  }
  found.by_smallest = found.by_mean = uncovered_of(sampled, radius);
  if (mean_radius > radius) {
    const FreeSpace of_mean(*container, mean_radius / frame.scale);
    std::erase_if(known, [&](const Place& at) { return !of_mean.is_place(at.clearance); });
    found.by_mean = uncovered_of(sample(of_mean, known, 0, options.points, [](const Place&) { return none; }),
                                 mean_radius);
  }
  sort(found);
  return found;
}

}  // namespace

std::optional<Chambers> chambers(const Spheres<dynamic>& spheres, const Domain& domain,
                                 const ChamberOptions& options,
                                 const std::shared_ptr<const Container>& made) {
  if (!has_walls(domain) || dimension_of(domain) != 3 || spheres.empty()) return {};
  if (is_repeated_mesh(domain)) return {};  // whose chambers go on from period to period
  const std::vector<double>& radii = spheres.r;
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
  return chambers_in(domain, &spheres, *std::ranges::min_element(radii), mean, options, made);
}

Chambers chambers_for(const Domain& shape, double radius, const ChamberOptions& options) {
  require_closed_walls(shape, "what chambers there are");
  return chambers_in(shape, nullptr, radius, radius, options, {});
}

}  // namespace bernal
