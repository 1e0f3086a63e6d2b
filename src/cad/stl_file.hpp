#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// What the bytes of an STL file are. Binary files may begin with the word "solid", so the size decides
/// first: 84 bytes and 50 a triangle.
struct StlFile {
  bool binary = false;
  /// As the readers want it: the file's bytes if binary; else its statements alone, in lower case and one a
  /// line, because assimp and CGAL refuse upper case and words that do not belong, and CGAL takes
  /// "solid<tab>" for a binary file.
  std::string content;
  std::size_t facets = 0;
  std::vector<Solid> solids = {};       ///< of a text file, their names as written
  std::vector<std::string> notes = {};  ///< what was left out
};

/// Reads and checks an STL file. Throws Error{bad_mesh} with the line (text) or the sizes (binary) where it
/// is malformed or truncated: the readers' own answers name neither.
///
/// Text grammar, in any case, white space free: {"solid" [name] {"facet normal" 3 words "outer loop" 3 ×
/// ("vertex" 3 numbers) "endloop" "endfacet"} "endsolid" [name]}, names up to the end of their line. What
/// stands behind a normal, "loop", "endloop" or "endfacet" in the same line is passed over, which a note
/// says, and so are comments, from # or // at the start of a statement on.
///
/// A binary file may go on behind its last triangle, as long as no triangle would fit there exactly.
StlFile read_stl_file(const std::filesystem::path& file);

/// Gives the solids and notes of the file to what a reader made of its content, if that has all facets.
void tell_parts(const StlFile& stl, ReadAttempt& attempt);

}  // namespace bernal::cad
