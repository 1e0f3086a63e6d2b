#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "bernal/core/monitor.hpp"
#include "bernal/geometry/mesh.hpp"

// Operations of CGAL on whole surfaces; its heaviest headers are compiled for these alone.

namespace bernal::cad {

enum class Combine { unite, take_out };

/// The union of what two closed surfaces enclose, or the first minus the second. Absent if the result has an
/// edge with more than two faces, or if CGAL fails. Precondition: each is closed, oriented outwards, without
/// degenerate faces and self-intersections.
std::optional<Mesh> combine(const Mesh& one, const Mesh& other, Combine how);

/// All that a surface winds around at least once: the outer walls of a part that crosses itself. The surface
/// is cut along its crossings; the patches with nothing outside remain, and their equal corners are welded.
/// Absent if the result encloses nothing or is open, or if CGAL fails. Precondition: closed, oriented so that
/// its volume is positive, without degenerate faces.
std::optional<Mesh> unite_with_itself(const Mesh&);

/// Absent if the points are coplanar.
std::optional<Mesh> convex_hull_of(std::span<const Vector<3>>);

/// Why a wrap was stopped: the monitor, more points than allowed, or a wrap from inside that got out.
enum class StoppedWrap { by_monitor, too_many, outside };

/// CGAL's alpha wrap of a surface, oriented outwards: from the seed points inside it, or from outside if
/// there are none. Throws StoppedWrap.
Mesh alpha_wrap(const Mesh&, double alpha, double offset, std::span<const Vector<3>> seeds,
                std::size_t most_points, const Monitor&);

}  // namespace bernal::cad
