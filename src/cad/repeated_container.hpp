#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// How many periods more on either side of one, along each axis, hold every wall that is as near to a point
/// of that period as its clearance, and of a mesh that repeats itself along one axis or two twice as near.
/// With the least extent e across the axes that repeat, a clearance is at most e / 2; where all do, half the
/// diagonal of a period. Throws Error{bad_argument} above `most_images`.
std::array<int, 3> images_around(const Mesh&);
inline constexpr int most_images = 32;

/// The container of a mesh that repeats itself, made of one of the period with its images around it.
///
/// A point is asked about at its image in the period, exactly where it lies there already, else off by a
/// roundoff; facets are given where they are near the point that asked. What reaches beyond the images is
/// asked for window by window of images; an endless reach up to the next windows. A way that is longer than
/// the images reach is walked in pieces, whose ends are rounded by a roundoff each; it ends after
/// `most_pieces`, as if there were a wall, unless it runs along an axis and has met none in a whole period:
/// then it has no end.
///
/// Precondition: `around` is that of `repeated(mesh, images)`, whose first triangles are so many of walls.
std::unique_ptr<Container> make_repeated_container(std::unique_ptr<const Container> around, const Mesh& mesh,
                                                   const std::array<int, 3>& images, std::size_t walls);
inline constexpr int most_pieces = 10'000;

}  // namespace bernal::cad
