#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

// What a container is, as plain data; a Container answers questions about one, and the certificate decides
// on the same data by itself. The doubles below *are* the shape: nothing else is meant by them.

/// [corner, corner + size] as rounded component by component.
struct BoxShape {
  Vector<3> corner = Vector<3>::Zero();
  Vector<3> size = Vector<3>::Ones();
};

/// Points p with 0 <= (p - base)·a <= height for a = axis / |axis|, at most `radius` from the axis line.
/// `axis` need not be of unit length.
struct CylinderShape {
  Vector<3> base = Vector<3>::Zero();
  Vector<3> axis = Vector<3>::UnitZ();
  double radius = 1;
  double height = 1;
};

struct SphereShape {
  Vector<3> center = Vector<3>::Zero();
  double radius = 1;
};

/// A closed triangle mesh with outward orientation that does not intersect itself.
struct Mesh {
  std::vector<Vector<3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

using Shape = std::variant<BoxShape, CylinderShape, SphereShape, Mesh>;

/// "box", "cylinder", "sphere" or "mesh".
std::string_view kind_of(const Shape&);

/// Smallest axis-aligned bounds, to rounding.
Bounds<3> bounds_of(const Shape&);

/// Enclosed volume, to rounding (for a mesh the sum of signed tetrahedra about its bounds' centre).
double volume_of(const Shape&);

/// Area of the wall.
double area_of(const Shape&);

/// A similarity that takes the scene's coordinates to the packer's: local = (scene - origin) / scale, with
/// `scale` a power of two, so that scaling is exact and the local container has a diagonal in [1, 2).
struct Frame {
  Vector<3> origin = Vector<3>::Zero();
  double scale = 1;
  double resolution = 0;  ///< largest rounding error of a coordinate on the way back, in local lengths

  Vector<3> to_local(const Vector<3>& p) const { return (p - origin) / scale; }
  Vector<3> to_scene(const Vector<3>& p) const { return origin + scale * p; }
};

/// The frame centred on the shape's bounds.
Frame frame_of(const Shape&);

/// The shape in local coordinates; vertices are rounded to within `frame.resolution`.
Shape to_local(const Shape&, const Frame&);

}  // namespace bernal
