#pragma once
#include <cstddef>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// What a view of a packing is to have.
struct ViewOptions {
  enum class Theme { as_system, light, dark };
  Theme theme = Theme::as_system;  ///< light or dark as the reader's system asks, or always one of them
  /// Of more spheres only so many are in the page: those nearest to the walls, or to the ends of the periods,
  /// which hide the others. The view says so.
  std::size_t most_spheres = 200'000;
  std::size_t most_triangles = 40'000;  ///< of a mesh; a finer one is simplified for the view
};

/// Whether there is a view of spheres of so many dimensions: of two and of three.
constexpr bool has_view(int dimension) { return dimension == 2 || dimension == 3; }

/// A whole HTML document that holds the spheres and a program of WebGL2 that shows them, and fills its frame:
/// to turn, cut, colour and ask. One file, which asks for nothing else; valid UTF-8.
///
/// Centres and radii are there in single precision, relative to the middle of the domain and its size: to
/// 6e-8 of that. Spheres are coloured by radius, contacts, gap to the nearest, distance from the wall, and by
/// what `measured` has of single ones: chambers, local packing fractions. Where it is null, what costs little
/// is measured.
/// Cost: some µs a sphere. Size: about 40 kB, and 45 bytes a sphere; see `most_spheres`.
/// Throws Error{bad_argument} for other dimensions than two and three, and for numbers that are not finite.
std::string view_page(const Packing&, const Measurements* measured = nullptr, const ViewOptions& = {});

}  // namespace bernal
