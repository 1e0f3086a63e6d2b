#pragma once
#include <TopoDS_Shape.hxx>

#include <string>
#include <string_view>

namespace bernal::cad {

/// The edge or corner with the largest tolerance, in one line, where a sphere of that radius could slip
/// through; empty if it could not. Faces are counted from 1.
std::string known_too_loosely(const TopoDS_Shape& shape, double smallest_radius, std::string_view unit);

}  // namespace bernal::cad
