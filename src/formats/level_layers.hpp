#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/format.hpp"

namespace bernal {

/// What a file says that a sphere holds: shells about its centre.
struct ShellsInFile {
  std::vector<double> ends =
      {};  ///< of each, from the centre out, but for the last, whose end is the sphere's
  std::vector<std::string> materials = {};  ///< by name, one a shell
  bool is_filled = false;                   ///< within the innermost lie spheres of another level

  bool operator==(const ShellsInFile&) const = default;
};

/// In kg/m³, of the materials of which a file knows it.
using DensitiesInFile = std::map<std::string, double, std::less<>>;

/// Makes layers of a scene of the shells, where one list of them is true of all spheres to 1e-12 of their
/// radii: by radius, thickness or share of the volume, all but one that takes what is left. The layers
/// are named after their materials. Notes say what is taken over, and what is not: drawn thicknesses, spheres
/// with other shells than others, what lies inside, what somebody has changed. `which` has of each sphere its
/// place in `kinds`.
void take_layers(FileContents&, const std::vector<ShellsInFile>& kinds,
                 const std::vector<std::uint32_t>& which, const DensitiesInFile&);

}  // namespace bernal
