#pragma once
#include <filesystem>
#include <string>

#include "bernal/core/spheres.hpp"
#include "bernal/run/packing.hpp"

namespace bernal {

struct SpheresFile {
  Spheres<dynamic> spheres;
  std::string unit;  ///< of the "# unit: mm" line, "" if there is none
};

/// Reads `x,y,z,r` lines (`x0,x1,…,r` in other dimensions than three). Throws Error{bad_packing} with file,
/// line and what is wrong: header, number of fields, text that is no number, not finite, radius not positive,
/// truncated last line.
SpheresFile read_csv(const std::filesystem::path& file);

/// What stands in scene.toml and spheres.csv of a folder that `write_packing` made, or that has files of that
/// form. How the run went is not among it: effects, history, seconds and version are empty. Throws as
/// `read_scene`, `domain_of` and `read_csv` do, and Error{bad_packing} where unit or dimension of the spheres
/// are not those of the scene.
Packing read_packing(const std::filesystem::path& folder);

}  // namespace bernal
