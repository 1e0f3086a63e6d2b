#pragma once
#include <cstddef>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// Options of a view.
struct ViewOptions {
  enum class Theme { as_system, light, dark };
  Theme theme = Theme::as_system;  ///< follows the reader's system, or is fixed
  /// For more spheres than this only those nearest to the walls, or to the ends of the periods, are in the
  /// page: they hide the others. The view says so.
  std::size_t most_spheres = 200'000;
  std::size_t most_triangles = 40'000;  ///< of a mesh; a finer one is simplified
};

/// Whether spheres of this dimension have a view: two and three.
constexpr bool has_view(int dimension) { return dimension == 2 || dimension == 3; }

/// A complete HTML document with the spheres and a WebGL2 program that shows them and fills its frame: to
/// turn, cut, colour and query. One file without external resources; valid UTF-8.
///
/// Centres and radii are in single precision, relative to the middle of the domain and its size, so to 6e-8
/// of it. Spheres are coloured by radius, contacts, gap to the nearest, distance from the wall, and by the
/// per-sphere data in `measured`: chambers, local packing fractions. If it is null, the cheap measurements
/// are made. Cost: some µs a sphere. Size: about 40 kB plus 45 bytes a sphere; see `most_spheres`. Throws
/// Error{bad_argument} in other than two or three dimensions, and for numbers that are not finite.
std::string view_page(const Packing&, const Measurements* measured = nullptr, const ViewOptions& = {});

}  // namespace bernal
