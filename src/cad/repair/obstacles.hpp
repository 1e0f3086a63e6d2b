#pragma once
#include <string>

#include "bernal/geometry/mesh.hpp"

namespace bernal::cad {

/// Subtracts an obstacle, which errors call `name`, from a container; its exact corners are dropped.
/// Precondition: both closed, oriented outwards, without self-intersections. Throws OptionError about
/// "obstacles" where the obstacle is outside, where nothing remains, or where the remainder would be joined
/// in edges only or cannot be computed. Cost: one search for crossings, and 50 µs a face if there are any.
void take_out(Mesh& container, const Mesh& obstacle, const std::string& name);

}  // namespace bernal::cad
