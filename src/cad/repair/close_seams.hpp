#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// What became of the seams of a surface: places where faces should hang together and do not, because their
/// common corners were rounded apart, because a corner of one lies within an edge of the other, or because a
/// face without area stands between them.
struct Seams {
  std::uint64_t collinear = 0;  ///< faces without area, dropped
  std::uint64_t doubled = 0;    ///< faces that lie on another one, turned against it, dropped
  std::uint64_t welded = 0;     ///< corners that became one with another
  double widest = 0;            ///< how far apart two of them were, at most
  std::uint64_t split = 0;      ///< edges that got a corner of a neighbour

  bool any() const { return collinear + doubled + welded + split > 0; }
  std::vector<std::string> in_words() const;
};

/// How far two readings of one corner may be apart, as the coordinates themselves tell: a few units in the
/// last place of single precision where all of them are such numbers, else of as many decimals as the longest
/// of them has. Never 0.
double rounding_of_coordinates(const Mesh& mesh);

/// Closes seams up to `tolerance` wide. Only corners of open edges move, by at most that much; a surface
/// without open edges and collinear faces stays as it is, bit for bit. Cost: O(n log n).
Seams close_seams(Mesh& mesh, double tolerance);

/// The narrowest tolerance up to `widest` with which `close_seams` leaves no edge open, to a factor of 2; 0
/// if there is none.
double closing_tolerance(const Mesh& mesh, double from, double widest);

}  // namespace bernal::cad
