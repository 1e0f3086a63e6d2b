#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "measure/free_space.hpp"

namespace bernal {

/// The connected components of a free space, by a grid of cubes.
///
/// An octree over the bounds: a cube whose clearance is so large or so small that it has nothing but places
/// or none is left whole; of the smallest cubes the others keep one place each, that nearest to their centre,
/// if they have one. Whole cubes that touch are connected; every other place is joined with the roomiest one
/// of its 26 neighbours, and then with every neighbour that is not yet connected with it. Cost: a few
/// clearances for every smallest cube that the boundary of the places cuts. Memory: 4 bytes a smallest
/// cube, 48 a place.
class FreeCells {
 public:
  /// Cubes of edge `edge`, as few as cover the bounds.
  FreeCells(const FreeSpace& space, double edge);

  std::size_t components() const { return deepest_.size(); }
  /// A place well inside each component.
  const Place& deepest(std::size_t component) const { return deepest_[component]; }

  struct Found {
    std::uint32_t component;
    bool joined;  ///< false: only the nearest, no line of places was found
  };
  /// The component of a place; absent where no place is known in its cell and the 26 about it.
  std::optional<Found> find(const Place&) const;

  /// Two places are joined by pieces so short, see FreeSpace.
  double step() const { return step_; }
  /// Or so short, where that would be pieces without number.
  double coarse_step() const { return edge_ / steps_per_cell; }

 private:
  static constexpr double steps_per_cell = 16;  // in a line of places
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  using Cell = std::array<int, 3>;
  struct Node {
    Place place;
    Cell cell;   // its lowest
    int size;    // in cells
    bool whole;  // nothing but places
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
  /// Calls visit(cell, node) for the 26 neighbours that have a node.
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
