#pragma once
#include "scene/entry.hpp"

namespace bernal::schema {

/// Of a Layer, and of the Normal that its thickness may be.
const Entry& layer_entry();
const Entry& thickness_entry();

/// What the layers of one sphere demand of each other; `key` is the one that they stand in, `list` what
/// errors call them: "layers in [spheres]". Throws Error{bad_scene}.
void layers_rule(const std::vector<Layer>& layers, std::string_view key, const std::string& list,
                 const Section&);

}  // namespace bernal::schema
