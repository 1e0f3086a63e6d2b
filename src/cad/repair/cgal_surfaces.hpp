#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "bernal/core/monitor.hpp"
#include "bernal/geometry/mesh.hpp"

// What CGAL does with whole surfaces; its heaviest headers are compiled for these alone.

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

/// Of points; nothing if they lie in a plane.
std::optional<Mesh> convex_hull_of(std::span<const Vector<3>>);

/// Why a wrap came to nothing: it would have more points than are allowed, or what began inside went out.
enum class StoppedWrap { by_monitor, too_many, outside };

/// CGAL's alpha wrap of a surface, turned outward: from these points inside of it, or from outside if there
/// are none. Throws StoppedWrap.
Mesh alpha_wrap(const Mesh&, double alpha, double offset, std::span<const Vector<3>> seeds,
                std::size_t most_points, const Monitor&);

}  // namespace bernal::cad
