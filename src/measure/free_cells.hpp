#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "measure/free_space.hpp"

namespace bernal {

/// The connected components of a free space, by a grid of cubes.
///
/// An octree over the bounds: a cube whose clearance shows that it consists of places only, or has none, is
/// not refined; each of the other smallest cubes keeps one place, the nearest to its centre, if it has one.
/// Touching whole cubes are connected; every other place is joined to the neighbour of largest clearance
/// among the 26, and then to every neighbour not yet connected to it. Cost: a few clearances for every
/// smallest cube on the boundary of the places. Memory: 4 bytes a smallest cube, 48 a place.
class FreeCells {
 public:
  /// Uses the fewest cubes of edge `edge` that cover the bounds.
  FreeCells(const FreeSpace& space, double edge);

  std::size_t components() const { return deepest_.size(); }
  /// The place of largest clearance in a component.
  const Place& deepest(std::size_t component) const { return deepest_[component]; }

  struct Found {
    std::uint32_t component;
    bool joined;  ///< false: only the nearest component; no chain of places was found
  };
  /// The component of a place; absent if its cell and the 26 around it have no places.
  std::optional<Found> find(const Place&) const;

  /// Length of the steps in a chain of places, see FreeSpace.
  double step() const { return step_; }
  /// The same for chains that would have too many steps.
  double coarse_step() const { return edge_ / steps_per_cell; }

 private:
  static constexpr double steps_per_cell = 16;  // in a chain of places
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  using Cell = std::array<int, 3>;
  struct Node {
    Place place;
    Cell cell;   // the lowest
    int size;    // in cells
    bool whole;  // consists of places only
  };

  void refine(const Cell&, int size, std::vector<Node>& out) const;
  void collect_nodes();
  void connect();
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * count_[1] + c[1]) * count_[0] + c[0];
  }
  std::uint32_t node_at(const Cell&) const;
  Place place_in(const Cell&, const Node&) const;
  Vector<3> center_of(const Cell&, int size) const;
  /// Calls visit(cell, node) for those of the 26 neighbours with a node.
  template <class Visit>
  void for_each_neighbour(const Cell&, Visit&& visit) const;
  const FreeSpace& space_;
  double edge_, step_;
  Vector<3> lower_;
  Cell count_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> node_of_cell_;
  std::vector<std::uint32_t> component_;  // of each node
  std::vector<Place> deepest_;
};

}  // namespace bernal
