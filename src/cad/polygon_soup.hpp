#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Polygons as a file lists them: nothing is welded, closed or oriented, every index is valid and every
/// coordinate is finite.
struct PolygonSoup {
  std::vector<Vector<3>> points;
  std::vector<std::vector<std::uint32_t>> polygons;
};

/// What one reader made of a file: a soup, or why there is none.
struct ReadAttempt {
  PolygonSoup soup;
  std::string failure;  ///< one line; empty if the soup is good

  bool ok() const { return failure.empty(); }
};

/// The general door: every format that assimp knows, node transforms applied in double. Coordinates have
/// been through single precision.
ReadAttempt read_with_assimp(const std::filesystem::path& file);

/// The same for an STL that stands in memory.
ReadAttempt read_stl_with_assimp(const std::string& content);

/// ".stl" of "Part.STL".
std::string extension_of(const std::filesystem::path& file);

/// Whether CGAL reads the doubles of this format: OFF, OBJ, PLY (STL goes through `read_stl_with_cgal`).
bool cgal_reads(const std::filesystem::path& file);
ReadAttempt read_with_cgal(const std::filesystem::path& file);
ReadAttempt read_stl_with_cgal(const std::string& content);

}  // namespace bernal::cad
