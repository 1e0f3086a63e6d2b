#pragma once
#include "scene/entry.hpp"

namespace bernal::schema {

/// The keys of [spheres] that say how large the spheres are: "radius" or "diameter", and "scale".
Key size_key(bool diameters);
Key scale_key();
/// What `largest` demands of the rest of the scene.
void scale_rule(const Scene& scene, const Section& section);

}  // namespace bernal::schema
