#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A closed surface of triangles with corners on the unit sphere, counter-clockwise from outside.
struct Icosphere {
  std::vector<Vector<3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double inradius = 0;  ///< the least distance of a triangle from the centre
  double volume = 0;
};

/// The faces of an icosahedron divided into frequency² triangles each, with corners moved out onto the
/// sphere: 20 frequency² triangles, 10 frequency² + 2 vertices. Cached. Precondition: frequency >= 1.
const Icosphere& icosphere(int frequency);

/// The least frequency with 1 - inradius <= deflection; at most `most_frequent`.
int frequency_for(double deflection);
inline constexpr int most_frequent = 400;

/// The least distance of a triangle from the origin.
double distance_from_origin(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c);

}  // namespace bernal
