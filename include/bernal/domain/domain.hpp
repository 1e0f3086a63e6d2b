#pragma once
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "bernal/domain/boundary.hpp"
#include "bernal/domain/shape.hpp"

namespace bernal {

/// The box [0, edges[k]) on every axis k, repeated without end along each axis that has no walls: there
/// spheres have images in every box, and a sphere may be its own neighbour. An axis with walls ends at 0 and
/// at its edge, and holds whole spheres: r <= c <= edge - r.
struct PeriodicBox {
  Vector<dynamic> edges;
  std::vector<bool> walls = {};  ///< whether each axis has them; empty: none

  int dimension() const { return static_cast<int>(edges.size()); }
  bool has_wall(int axis) const { return !walls.empty() && walls[static_cast<std::size_t>(axis)]; }
  bool has_walls() const { return std::find(walls.begin(), walls.end(), true) != walls.end(); }
  /// Its metric: open along the axes that have walls.
  template <int D>
  Boundary<D> boundary() const {
    Boundary<D> metric{edges};
    for (int k = 0; k < D; ++k)
      if (has_wall(k)) metric.edges[k] = 0;
    return metric;
  }
};

/// What spheres are packed into: a container of three dimensions, or a periodic box of any.
using Domain = std::variant<Shape, PeriodicBox>;

/// "box", "cylinder", "sphere", "mesh" or "periodic".
std::string_view kind_of(const Domain&);
/// What to call it in a sentence: "cylinder", "periodic box", "box periodic but along axis 2".
std::string name_of(const Domain&);
int dimension_of(const Domain&);
/// Enclosed volume, or that of one box, to rounding; an area in two dimensions, and so on.
double volume_of(const Domain&);
/// Edges of the smallest axis-aligned bounds, or of the periodic box.
Vector<dynamic> extent_of(const Domain&);

}  // namespace bernal
