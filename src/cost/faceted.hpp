#pragma once
#include <optional>

#include "bernal/domain/domain.hpp"

namespace bernal::cost {

/// A mesh that stands for a curved container, and how far it lies from it at most.
struct Faceted {
  Mesh mesh;
  double deviation;
};

/// A prism in a cylinder, or a polyhedron of rings in a sphere, of about so many faces, flat ones of several
/// triangles counted once, all corners on the curved surface; none of other containers. Precondition:
/// faces >= 8.
std::optional<Faceted> faceted(const Domain& container, int faces);

}  // namespace bernal::cost
