#include "measure/power_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "near/sphere_tree.hpp"

namespace bernal {
namespace {

using Tree = SphereTree<3>;

constexpr std::size_t cells_a_piece = 64;
/// Relative to the distance of the farthest corner: smaller cuts are rounding.
constexpr double rounding_of_cuts = 1e-12;

// A label is a sphere's number and the digits of its image in the base of three.
constexpr ConvexCell::Label label_base = 27, own_image = 13;
constexpr std::array<ConvexCell::Label, 3> along_axis = {1, 3, 9};

class Diagram {
 public:
  Diagram(const Spheres<3>& spheres, const CellBox& box, const VisitCell& visit)
      : box_(box), visit_(visit), tree_(spheres, box.boundary) {}

  /// Visits `count` cells, which the order of the tree spreads over the domain.
  void visit_some(std::size_t count) const {
    parallel_ranges(count, cells_a_piece, [&](std::size_t first, std::size_t last) {
      Piece piece;
      for (std::size_t k = first; k < last; ++k) {
        const auto place = static_cast<std::uint32_t>((2 * k + 1) * tree_.size() / (2 * count));
        cut_out(place, piece);
        visit_(tree_.id(place), tree_.center(place), piece.cell);
      }
    });
  }

 private:
  /// The bisector: points p with p·normal > offset belong to the sphere at `place`.
  struct Plane {
    double distance;  ///< from the cell's centre
    Vector<3> normal;
    double offset;
    ConvexCell::Label label;
  };
  /// A leaf moved by `shift`, with a lower bound on the distance of its spheres' planes.
  struct Leaf {
    double least;
    const Tree::Node* node;
    const Vector<3>* shift;
  };
  /// Scratch memory, kept from cell to cell.
  struct Piece {
    ConvexCell cell;
    std::vector<Leaf> leaves;
    std::vector<Plane> planes;
  };

  void begin(ConvexCell& cell, std::uint32_t place) const {
    Vector<3> lower = box_.bounds.lower - tree_.center(place),
              upper = box_.bounds.upper - tree_.center(place);
    std::array<ConvexCell::Label, 6> sides;
    for (int k = 0; k < 3; ++k) {
      sides[2 * k] = ConvexCell::wall - 2 * k;
      sides[2 * k + 1] = sides[2 * k] - 1;
      if (k >= box_.dimension) {
        lower[k] = -0.5;
        upper[k] = 0.5;
        sides[2 * k] = below_plane;
        sides[2 * k + 1] = above_plane;
      } else if (box_.boundary.repeats(k)) {  // half-way to the cell's own images
        lower[k] = -0.5 * box_.boundary.edges[k];
        upper[k] = 0.5 * box_.boundary.edges[k];
        sides[2 * k] = label_of(place, -box_.boundary.edges[k] * Vector<3>::Unit(k));
        sides[2 * k + 1] = label_of(place, box_.boundary.edges[k] * Vector<3>::Unit(k));
      }
    }
    cell.reset(lower, upper, sides);
    if (box_.trim) box_.trim(tree_.center(place), cell);
  }

  ConvexCell::Label label_of(std::uint32_t place, const Vector<3>& shift) const {
    ConvexCell::Label label = label_base * tree_.id(place) + own_image;
    for (std::size_t k = 0; k < 3; ++k)
      label += shift[k] > 0 ? along_axis[k] : shift[k] < 0 ? -along_axis[k] : 0;
    return label;
  }

  /// Distance of its farthest corner; below any plane's if the cell is empty.
  double reach_of(const ConvexCell& cell) const {
    if (cell.empty()) return -infinite;
    double farthest = 0;
    for (const Vector<3>& p : cell.corners())
      farthest = std::max(farthest, box_.dimension == 2 ? p.head<2>().squaredNorm() : p.squaredNorm());
    return std::sqrt(farthest);
  }

  /// Lower bound on the distance of the bisector from a centre with squared radius `weight`, for another
  /// sphere at a squared distance of at least `squared` and a radius of at most r.
  static double nearest_plane(double weight, double squared, double r) {
    const double more = weight - r * r, d = std::sqrt(std::max(squared, more));
    return d > 0 ? 0.5 * (d + more / d) : more < 0 ? -infinite : 0;
  }
  /// Whether that is below `limit`, which is positive, to rounding.
  static bool comes_below(double weight, double squared, double r, double limit) {
    const double more = weight - r * r, far = std::max(squared, more), sum = far + more;
    return sum <= 0 || sum * sum < 4 * limit * limit * far;
  }

  /// A guess of the cell's reach.
  double first_look(std::uint32_t place, double reach) const {
    constexpr double radii = 1.25, least = 1e-3;
    return std::max(radii * tree_.radius(place), least * reach);
  }

  /// Visits what is near in the order of its lower bounds, and what is farther as long as the cell reaches
  /// there.
  void cut_out(std::uint32_t place, Piece& piece) const {
    throw_if_interrupted();
    begin(piece.cell, place);
    const double weight = tree_.radius(place) * tree_.radius(place);
    double reach = reach_of(piece.cell), done = 0;
    for (double look = first_look(place, reach); done < reach; look = std::min(2 * look, reach)) {
      piece.leaves.clear();
      tree_.for_each_leaf(
          tree_.center(place),
          [&](double squared, double r) { return comes_below(weight, squared, r, look); },
          [&](const Tree::Node& leaf, const Vector<3>& shift, double squared) {
            if (!(done > 0 && comes_below(weight, squared, leaf.largest, done)))
              piece.leaves.push_back({nearest_plane(weight, squared, leaf.largest), &leaf, &shift});
          });
      std::ranges::sort(piece.leaves, {}, &Leaf::least);
      for (const Leaf& leaf : piece.leaves) {
        if (!(leaf.least < reach)) break;
        find_planes(place, *leaf.node, *leaf.shift, reach, piece.planes);
        cut_by(piece, reach);
      }
      done = look;
    }
  }

  /// Cuts by the planes in ascending order; a leaf has so few that sorting is not worthwhile.
  void cut_by(Piece& piece, double& reach) const {
    std::vector<Plane>& planes = piece.planes;
    while (!planes.empty()) {
      const auto nearest = std::ranges::min_element(planes, {}, &Plane::distance);
      const Plane plane = *nearest;
      *nearest = planes.back();
      planes.pop_back();
      if (!(plane.distance < reach)) break;
      const double slack = rounding_of_cuts * reach * plane.normal.norm();
      if (piece.cell.cut(plane.normal, plane.offset, plane.label, slack)) reach = reach_of(piece.cell);
    }
  }

  /// Finds the planes with the spheres of a leaf. With equal centres the larger sphere hides the other; of
  /// two equal ones, the first.
  void find_planes(std::uint32_t place, const Tree::Node& leaf, const Vector<3>& shift, double reach,
                   std::vector<Plane>& planes) const {
    const double r = tree_.radius(place);
    planes.clear();
    for (std::uint32_t other = leaf.first; other < leaf.last; ++other) {
      if (other == place && shift.isZero(0)) continue;
      const Vector<3> normal = tree_.center(other) + shift - tree_.center(place);
      const double squared = normal.squaredNorm(), r_other = tree_.radius(other);
      const double offset = 0.5 * (squared + (r - r_other) * (r + r_other));
      if (squared > 0) {
        if (offset > 0 && offset * offset >= reach * reach * squared) continue;  // saves the root
        planes.push_back({offset / std::sqrt(squared), normal, offset, label_of(other, shift)});
      } else if (r_other > r || (r_other == r && tree_.id(other) < tree_.id(place))) {
        planes.push_back({-infinite, normal, -1, label_of(other, shift)});
      }
    }
  }

  static constexpr double infinite = std::numeric_limits<double>::infinity();

  const CellBox& box_;
  const VisitCell& visit_;
  Tree tree_;
};

}  // namespace

CellNeighbour neighbour_of(ConvexCell::Label label) {
  CellNeighbour made{static_cast<std::uint32_t>(label / label_base), {}};
  for (std::size_t k = 0; k < 3; ++k)
    made.image[k] = static_cast<int>(label % label_base / along_axis[k] % 3) - 1;
  return made;
}

ConvexCell::Label label_of(const CellNeighbour& neighbour) {
  ConvexCell::Label label = label_base * neighbour.sphere + own_image;
  for (std::size_t k = 0; k < 3; ++k) label += neighbour.image[k] * along_axis[k];
  return label;
}

void for_each_power_cell(const Spheres<3>& spheres, const CellBox& box, std::size_t most,
                         const VisitCell& visit) {
  Diagram(spheres, box, visit).visit_some(std::min(most, spheres.size()));
}

}  // namespace bernal
