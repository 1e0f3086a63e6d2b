#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// Spheres as another program wrote them.
struct NamedColumns {
  Spheres<dynamic> spheres;
  std::string unit;    ///< of a line "# unit: mm" or of the header, "" if there is none
  int first_line = 0;  ///< that of the first sphere, or its row; the others follow without a gap
};

/// Reads a text of numbers whose header names its columns, in any order: x, y, z or x0, x1, …, as many as
/// there are dimensions, and r or radius, or d or diameter; case and quotation marks do not matter, others
/// are ignored. All of these may say the unit, one and the same: "x [mm]" or "x (mm)". Commas, semicolons,
/// tabs or blanks part the columns, whichever the header has; lines before it begin with #. Where there is no
/// header, the last of these lines is one that names as many columns as the spheres have. Numbers may have a
/// plus or quotation marks, and empty lines may follow the last. `see` is told all bytes of the file, as they
/// are read. Throws Error{bad_packing} with file and line for a header that names no size, two, or a column
/// twice; units that contradict each other; text that is no number; radii that are not positive; coordinates
/// and radii that are no lengths of a scene, 1e-30 to 1e30. Cost: about 0.1 µs a number.
///
/// A file that begins as NumPy's .npy does is read as one, see `read_npy_spheres`.
NamedColumns read_spheres(const std::filesystem::path& file,
                          const std::function<void(std::string_view bytes)>& see = {});

}  // namespace bernal
