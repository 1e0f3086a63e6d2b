#pragma once
#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// What `bernal measure` says of contacts: at the gap that counts, of a sphere, and at several gaps.
void print_contacts(const Packing&, const Measurements&);

}  // namespace bernal
