#pragma once
#include <filesystem>
#include <string>

#include "bernal/core/spheres.hpp"

namespace bernal {

struct SpheresFile {
  Spheres<dynamic> spheres;
  std::string unit;  ///< of the "# unit: mm" line, "" if there is none
};

/// Reads `x,y,z,r` lines (`x0,x1,…,r` in other dimensions than three). Throws Error{bad_packing} with file, line and what is wrong: header, number of
/// fields, text that is no number, not finite, radius not positive, truncated last line.
SpheresFile read_csv(const std::filesystem::path& file);

}  // namespace bernal
