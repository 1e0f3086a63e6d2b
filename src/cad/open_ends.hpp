#pragma once
#include <array>
#include <string>
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal::cad {

/// Corners of both ends that are to match may be so far apart, where nothing else is said: this share of the
/// diagonal of the mesh.
constexpr double match_over_diagonal = 1e-6;

/// Closes a surface that is open in the end planes of these axes, to within the tolerance, by flat openings;
/// openings elsewhere stay. Cost: O(n log n) for n edges of openings.
void close_ends(Mesh&, const std::array<bool, 3>& axes, double tolerance);

/// Makes a closed mesh repeat itself along these axes: its flat faces in the two end planes become openings.
///
/// What moves: along each of these axes all corners, to the nearest multiple of a power of two, by at most
/// 2^-47 of the largest coordinate, so that corners plus up to `most_images` periods are doubles; corners
/// within the tolerance of an end plane into it; and the corners of a rim in the upper plane in that plane
/// onto those of the lower, by at most the tolerance. Returns what was done, in words.
///
/// Throws OptionError of "periodic" where an end has no flat face, or the rims do not match one another
/// corner by corner, with the place and by how much; where rims of one end fall together within the
/// tolerance; and where the period is too short, see `images_around`. Precondition: closed, facing outwards.
std::string open_ends(Mesh&, const std::array<bool, 3>& axes, double tolerance);

}  // namespace bernal::cad
