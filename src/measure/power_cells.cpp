#include "measure/power_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "core/parallel.hpp"
#include "measure/sphere_tree.hpp"
#include "tessellation/power_neighbours.hpp"

namespace bernal {
namespace {

using Tree = SphereTree<3>;

constexpr std::size_t spheres_a_block = 16384, cells_a_piece = 64;
/// What is looked at around a block: so many mean distances of centres, or largest radii.
constexpr double mean_distances = 2.2, largest_radii = 2.4;
/// Of the squared distance of a corner: a power that is less by no more than that is rounding.
constexpr double power_slack = 1e-10;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What a block knows: the spheres in a box around it, and on which sides of that box there are others.
struct KnownSpheres {
  Bounds<3> known;
  std::array<bool, 3> ends_below, ends_above;

  /// Nothing that is not known is nearer to p.
  double depth(const Vector<3>& p) const {
    double least = infinite;
    for (int k = 0; k < 3; ++k) {
      if (ends_below[k]) least = std::min(least, p[k] - known.lower[k]);
      if (ends_above[k]) least = std::min(least, known.upper[k] - p[k]);
    }
    return least;
  }
};

class Diagram {
 public:
  Diagram(const Spheres<3>& spheres, const CellBox& box, const VisitCell& visit)
      : box_(box), visit_(visit), tree_(spheres, box.boundary) {}

  void visit_all() const {
    std::vector<Tree::Node> blocks;
    collect_blocks(0, blocks);
    const double margin = margin_of_blocks();
    const bool alone = blocks.size() == 1;
    parallel_for(blocks.size(), [&](std::size_t k) { visit_block(blocks[k], margin, alone); });
  }

 private:
  void collect_blocks(std::uint32_t at, std::vector<Tree::Node>& blocks) const {
    const Tree::Node& node = tree_.nodes()[at];
    if (node.size() <= spheres_a_block) return blocks.push_back(node);
    collect_blocks(node.children, blocks);
    collect_blocks(node.children + 1, blocks);
  }

  double margin_of_blocks() const {
    const Tree::Node& all = tree_.nodes().front();
    Vector<3> size = all.bounds.size();
    for (int k = 0; k < 3; ++k)
      if (box_.boundary.repeats(k)) size[k] = box_.boundary.edges[k];
    double volume = 1;
    int axes = 0;
    for (const double edge : size) {
      if (!(edge > 1e-9 * size.maxCoeff())) continue;
      volume *= edge;
      ++axes;
    }
    const double distance = axes > 0 ? std::pow(volume / static_cast<double>(tree_.size()), 1.0 / axes) : 0;
    return std::max(mean_distances * distance, largest_radii * all.largest);
  }

  KnownSpheres surroundings_of(const Tree::Node& core, double margin) const {
    const Bounds<3>& all = tree_.nodes().front().bounds;
    KnownSpheres around{core.bounds, {}, {}};
    for (int k = 0; k < 3; ++k) {
      const bool repeats = box_.boundary.repeats(k);
      const double period = box_.boundary.edges[k], reach = repeats ? std::min(margin, period) : margin;
      around.known.lower[k] -= reach;
      around.known.upper[k] += reach;
      around.ends_below[k] = repeats ? reach < period : around.known.lower[k] > all.lower[k];
      around.ends_above[k] = repeats ? reach < period : around.known.upper[k] < all.upper[k];
    }
    return around;
  }

  void visit_block(const Tree::Node& core, double margin, bool alone) const {
    const KnownSpheres around = surroundings_of(core, margin);
    const Vector<3> origin = core.bounds.center();
    std::vector<std::uint32_t> places;
    std::vector<Site> sites;
    const auto add = [&](std::uint32_t place, const Vector<3>& shift) {
      places.push_back(place);
      sites.push_back({tree_.center(place) - origin + shift, tree_.radius(place) * tree_.radius(place)});
    };
    for (std::uint32_t place = core.first; place < core.last; ++place) add(place, Vector<3>::Zero());
    tree_.for_each_in(around.known, [&](std::uint32_t place, const Vector<3>& shift) {
      const bool own = place >= core.first && place < core.last && shift.isZero(0);
      if (!own) add(place, shift);
    });
    const PowerNeighbours neighbours = power_neighbours(sites, core.size());
    const auto visit_some = [&](std::size_t first, std::size_t last) {
      ConvexCell cell;
      std::vector<Plane> planes;
      for (std::size_t k = first; k < last; ++k) {
        begin(cell, places[k]);
        if (neighbours.hidden[k])
          cell.cut(Vector<3>::Zero(), -1, ConvexCell::wall);
        else
          cut(cell, sites, places, k, neighbours.of(k), planes);
        prove(cell, places[k], around);
        visit_(tree_.id(places[k]), tree_.center(places[k]), cell);
      }
    };
    if (alone) return parallel_ranges(core.size(), cells_a_piece, visit_some);
    for (std::size_t k = 0; k < core.size(); k += cells_a_piece) {
      throw_if_interrupted();
      visit_some(k, std::min(k + cells_a_piece, core.size()));
    }
  }

  struct Plane {
    double distance;  ///< from the cell's centre
    Vector<3> normal;
    double offset;
    std::uint32_t place;
  };

  void begin(ConvexCell& cell, std::uint32_t place) const {
    Vector<3> lower = box_.bounds.lower - tree_.center(place),
              upper = box_.bounds.upper - tree_.center(place);
    std::array<ConvexCell::Label, 3> sides;
    for (int k = 0; k < 3; ++k) {
      sides[k] = ConvexCell::wall;
      if (k >= box_.dimension) {
        lower[k] = -0.5;
        upper[k] = 0.5;
      } else if (box_.boundary.repeats(k)) {  // half-way to the cell's own images
        lower[k] = -0.5 * box_.boundary.edges[k];
        upper[k] = 0.5 * box_.boundary.edges[k];
        sides[k] = static_cast<ConvexCell::Label>(place);
      }
    }
    cell.reset(lower, upper, sides);
  }

  void cut(ConvexCell& cell, const std::vector<Site>& sites, const std::vector<std::uint32_t>& places,
           std::size_t site, std::span<const std::uint32_t> neighbours, std::vector<Plane>& planes) const {
    planes.clear();
    for (const std::uint32_t other : neighbours) {
      const Vector<3> normal = sites[other].point - sites[site].point;
      const double offset = 0.5 * (normal.squaredNorm() + sites[site].weight - sites[other].weight);
      planes.push_back({offset / normal.norm(), normal, offset, places[other]});
    }
    // The nearest first, so that the others find little to cut; in the order of the spheres where they are
    // equally near.
    std::ranges::sort(planes, {}, [](const Plane& p) {
      return std::tuple(p.distance, p.place, p.normal[0], p.normal[1], p.normal[2]);
    });
    for (const Plane& p : planes) cell.cut(p.normal, p.offset, static_cast<ConvexCell::Label>(p.place));
  }

  void prove(ConvexCell& cell, std::uint32_t place, const KnownSpheres& around) const {
    const Vector<3>& center = tree_.center(place);
    const double weight = tree_.radius(place) * tree_.radius(place);
    const double largest = tree_.nodes().front().largest;
    for (std::uint32_t k = 0; k < cell.corners().size();) {
      const ConvexCell::Corner& corner = cell.corners()[k];
      Vector<3> away = corner.point;
      if (box_.dimension == 2) away[2] = 0;
      const double squared = away.squaredNorm(), power = squared - weight;
      const double depth = around.depth(center + away);
      if (corner.is_proven || (depth > 0 && depth * depth - largest * largest >= power)) {
        ++k;
        continue;
      }
      const double limit = power - power_slack * squared;
      const Tree::Found other = tree_.nearest<Tree::Power>(center + away, limit);
      if (!(other.value < limit)) {
        cell.prove(k++);
        continue;
      }
      const Vector<3> normal = other.center - center;
      const double r = tree_.radius(other.place), offset = 0.5 * (normal.squaredNorm() + weight - r * r);
      if (corner.point.dot(normal) > offset) {
        cell.cut(normal, offset, static_cast<ConvexCell::Label>(other.place));
        k = 0;
      } else {
        cell.prove(k++);
      }
    }
  }

  const CellBox& box_;
  const VisitCell& visit_;
  Tree tree_;
};

/// Those that are not another one's twin, in their order.
std::vector<std::uint32_t> without_twins(const Spheres<3>& spheres, const Boundary<3>& boundary) {
  std::vector<Vector<3>> centers;
  for (std::size_t i = 0; i < spheres.size(); ++i) centers.push_back(boundary.wrap(spheres.center(i)));
  std::vector<std::uint32_t> ids(spheres.size());
  for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
  const auto key = [&](std::uint32_t i) {
    return std::tuple(centers[i][0], centers[i][1], centers[i][2], spheres.r[i]);
  };
  std::ranges::sort(ids, {}, [&](std::uint32_t i) { return std::tuple_cat(key(i), std::tuple(i)); });
  ids.erase(std::unique(ids.begin(), ids.end(), [&](auto i, auto j) { return key(i) == key(j); }), ids.end());
  std::ranges::sort(ids);
  return ids;
}

}  // namespace

void for_each_power_cell(const Spheres<3>& spheres, const CellBox& box, const VisitCell& visit) {
  if (spheres.empty()) return;
  const std::vector<std::uint32_t> ids = without_twins(spheres, box.boundary);
  if (ids.size() == spheres.size()) return Diagram(spheres, box, visit).visit_all();

  Spheres<3> kept;
  std::vector<bool> has_cell(spheres.size(), false);
  for (const std::uint32_t id : ids) {
    kept.push_back(spheres.center(id), spheres.r[id]);
    has_cell[id] = true;
  }
  const VisitCell visit_kept = [&](std::uint32_t k, const Vector<3>& center, const ConvexCell& cell) {
    visit(ids[k], center, cell);
  };
  Diagram(kept, box, visit_kept).visit_all();
  for (std::uint32_t id = 0; id < spheres.size(); ++id)
    if (!has_cell[id]) visit(id, box.boundary.wrap(spheres.center(id)), ConvexCell());
}

}  // namespace bernal
