#pragma once
#include <variant>

#include "bernal/domain/shape.hpp"

namespace bernal {

/// The box [0, edges[k]) on every axis k, repeated without end in all directions. It has no wall; spheres
/// have images in every box, and a sphere may be its own neighbour.
struct PeriodicBox {
  Vector<dynamic> edges;

  int dimension() const { return static_cast<int>(edges.size()); }
};

/// What spheres are packed into: a container of three dimensions, or a periodic box of any.
using Domain = std::variant<Shape, PeriodicBox>;

/// "box", "cylinder", "sphere", "mesh" or "periodic".
std::string_view kind_of(const Domain&);
int dimension_of(const Domain&);
/// Enclosed volume, or that of one box, to rounding; an area in two dimensions, and so on.
double volume_of(const Domain&);
/// Edges of the smallest axis-aligned bounds, or of the periodic box.
Vector<dynamic> extent_of(const Domain&);

}  // namespace bernal
