#pragma once
#include <functional>
#include <unordered_map>
#include <vector>

#include "meshes/surface_draft.hpp"

namespace bernal {

/// A part of a wall or of a plane whose boundary is made of vertices that exist already.
class PlanarPart {
 public:
  /// `flat`: a point of the scene in the plane, with z = 0; `back` the way back, of any number of dimensions.
  using Map = std::function<Vector<3>(const Vector<3>&)>;
  PlanarPart(SurfaceDraft& draft, Map flat, Map back);

  void add_chain(const std::vector<std::uint32_t>& chain, bool is_closed);
  /// A closed chain within which nothing is meshed: for strips, which know no boundary.
  void add_hole(const std::vector<std::uint32_t>& chain);
  /// Makes the triangles, counterclockwise in the plane or turned. `size`: at a point of the scene. The
  /// strip: its period along x, or 0.
  void mesh(std::uint32_t patch, bool turned, const std::function<double(const Vector<3>&)>& size,
            double period = 0, double margin = 0);
  bool empty() const { return patch_.edges.empty(); }

  const std::vector<FaceCorners>& triangles() const { return triangles_; }

 private:
  std::uint32_t number(std::uint32_t id);

  SurfaceDraft& draft_;
  Map flat_, back_;
  BoundedPart patch_{.surface = Delaunay::Surface::plane};
  std::vector<std::uint32_t> ids_;
  std::unordered_map<std::uint32_t, std::uint32_t> number_;
  std::vector<FaceCorners> triangles_;  ///< of vertices
};

}  // namespace bernal
