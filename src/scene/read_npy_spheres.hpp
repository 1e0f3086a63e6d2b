#pragma once
#include <filesystem>
#include <functional>
#include <limits>
#include <string_view>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// What coordinates and sizes may be.
struct Lengths {
  double smallest_size = std::numeric_limits<double>::denorm_min();
  double farthest = std::numeric_limits<double>::max();
};

/// Reads a table of NumPy's, see `NpyFile`: a row x, y, z, radius for each sphere, of other dimensions as
/// many coordinates; or structures whose members are named x, y, z or x0, x1, …, and r, radius, d or
/// diameter, in any order, among others that are ignored. Doubles are read to the bit. `see` is told all
/// bytes. Throws Error{bad_packing} with file and row. Cost: what the disk costs; memory for the spheres and
/// a megabyte.
Spheres<dynamic> read_npy_spheres(const std::filesystem::path& file, const Lengths& lengths = {},
                                  const std::function<void(std::string_view bytes)>& see = {});

}  // namespace bernal
