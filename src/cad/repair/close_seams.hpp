#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Seams closed in a surface: places where faces should be joined but are not, because common corners were
/// rounded apart, because a corner of one lies within an edge of the other, or because a face without area is
/// between them.
struct Seams {
  std::uint64_t collinear = 0;  ///< faces without area, dropped
  std::uint64_t doubled = 0;    ///< faces that coincide with another of opposite orientation, dropped
  std::uint64_t welded = 0;     ///< corners merged into another
  double widest = 0;            ///< largest distance between merged corners
  std::uint64_t split = 0;      ///< edges split at a corner of a neighbour

  bool any() const { return collinear + doubled + welded + split > 0; }
  std::vector<std::string> in_words() const;
};

/// How far apart two copies of one corner may be, inferred from the coordinates: a few units in the last
/// place of single precision if all are such numbers, else of as many decimals as the longest has. Never 0.
double rounding_of_coordinates(const Mesh& mesh);

/// Closes seams up to `tolerance` wide. Only corners of open edges move, by at most that much; a surface
/// without open edges and collinear faces does not change. Cost: O(n log n).
Seams close_seams(Mesh& mesh, double tolerance);

/// The narrowest tolerance up to `widest` with which `close_seams` leaves no edge open, to a factor of 2; 0
/// if there is none.
double closing_tolerance(const Mesh& mesh, double from, double widest);

}  // namespace bernal::cad
