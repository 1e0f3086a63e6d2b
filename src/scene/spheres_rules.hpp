#pragma once
#include <string>

#include "scene/entry.hpp"

namespace bernal::schema {

/// What amounts in [spheres], and its start, demand of the rest of the scene.
void amounts_rule(const Scene& scene, const Section& section);
void start_rule(const Scene& scene, const Section& section);

/// Whether it has 64 hexadecimal digits.
bool is_sha256(const std::string& digest);

}  // namespace bernal::schema
