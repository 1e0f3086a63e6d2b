#pragma once
#include <optional>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

enum class Combine { unite, take_out };

/// The union of what two closed surfaces enclose, or the first without the second; nothing where the result
/// has an edge at which more than two faces meet, or where CGAL gives up.
/// Precondition: each is closed, oriented outwards, without degenerate faces and does not meet itself.
std::optional<Mesh> combine(const Mesh& one, const Mesh& other, Combine how);

}  // namespace bernal::cad
