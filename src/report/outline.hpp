#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "viewer/view.hpp"

namespace bernal {

/// The domain, or one period of it, as triangles that are good enough to draw: exact for boxes and a mesh, a
/// fine prism for a cylinder; a sphere becomes two cones base to base, seen along their axis, whose rim is
/// its outline. Precondition: three dimensions.
Mesh drawable_mesh(const Domain& domain);

/// A straight piece of the outline, wholly visible or wholly hidden behind the container's own surface.
struct Stroke {
  CanvasPoint from;
  CanvasPoint to;
  bool hidden = false;
};

/// The lines that let a container be recognised: edges that bend by more than 30 degrees, open edges and the
/// silhouette. Cost: O(T log T) for T triangles.
std::vector<Stroke> outline_of(const Mesh& mesh, const View& view);

}  // namespace bernal
