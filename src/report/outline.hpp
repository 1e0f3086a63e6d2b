#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "viewer/view.hpp"

namespace bernal {

/// The domain, or one period, as triangles for drawing: exact for boxes and meshes, a fine prism for a
/// cylinder; a sphere becomes two cones base to base along the line of sight, whose rim is its outline.
/// Precondition: three dimensions.
Mesh drawable_mesh(const Domain& domain);

/// A straight piece of the outline, entirely visible or entirely hidden behind the container's surface.
struct Stroke {
  CanvasPoint from;
  CanvasPoint to;
  bool hidden = false;
};

/// The lines that show a container's shape: edges that bend by more than 30 degrees, open edges and the
/// silhouette. Cost: O(T log T) for T triangles.
std::vector<Stroke> outline_of(const Mesh& mesh, const View& view);

}  // namespace bernal
