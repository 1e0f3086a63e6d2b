#pragma once
#include <optional>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

enum class Combine { unite, take_out };

/// The union of what two closed surfaces enclose, or the first without the second; nothing where the result
/// has an edge at which more than two faces meet, or where CGAL gives up.
/// Precondition: each is closed, oriented outwards, without degenerate faces and does not meet itself.
std::optional<Mesh> combine(const Mesh& one, const Mesh& other, Combine how);

/// All that a surface winds around at least once: where a part crosses itself, its outer walls. The surface
/// is cut along its crossings; of the patches between them stay those that have nothing outside. Equal
/// corners of patches are welded. Nothing where it enclosed nothing so, does not close up, or CGAL gives up.
/// Precondition: closed, oriented so that its volume is positive, without degenerate faces.
std::optional<Mesh> unite_with_itself(const Mesh&);

}  // namespace bernal::cad
