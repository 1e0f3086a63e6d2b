#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace bernal::cad {

/// What the bytes of an STL file are. Binary files may begin with the word "solid", so the size decides
/// first: 84 bytes and 50 a triangle.
struct StlFile {
  bool binary = false;
  /// As the readers want it: the file's bytes if binary; else in lower case and without tabs, because upper
  /// case is refused by assimp and CGAL, and CGAL takes "solid<tab>" for a binary file.
  std::string content;
};

/// Reads and checks an STL file. Throws Error{bad_mesh} with the line (text) or the sizes (binary) where it
/// is malformed or truncated: the readers' own answers name neither.
///
/// Text grammar, white space free: {"solid" [name] {"facet normal" 3 words "outer loop" 3 × ("vertex" 3
/// numbers) "endloop" "endfacet"} "endsolid" [name]}, names up to the end of their line.
StlFile read_stl_file(const std::filesystem::path& file);

}  // namespace bernal::cad
