#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// A format that packings of other programs are read from.
struct ImportFormat {
  std::string name;                  ///< "lammps"
  std::string what;                  ///< the program, and what the file holds
  std::string unit;                  ///< of its lengths: "cm", or its source, "‹unit›": an option's name
  std::vector<std::string> options;  ///< options of this format alone or of some: "columns", "frame"
};
/// All formats, in the order in which they are tried on a file.
std::vector<ImportFormat> import_formats();

/// What a file does not say, or what overrides it. Lengths are in the file's unit.
struct ImportOptions {
  std::string format = {};  ///< of `import_formats`; empty: chosen by the file's name and first bytes
  /// Columns of the centre and the size: "x,y,z,d" in the order of the columns, `-` for one to skip, or
  /// "x=3,y=4,z=5,d=rad" by number (from 1) or by name; r for a radius, d for a diameter.
  std::string columns = {};
  std::optional<double> diameter = {}, radius = {};  ///< of all spheres, if the file has no sizes
  std::optional<std::filesystem::path> radii = {};   ///< a .npy file with one radius for each centre
  std::optional<Unit> unit = {};                     ///< if the file does not say it
  std::vector<double> box = {};                      ///< edges of the box [0, a)
  std::string periodic = {};                         ///< periodic axes: "xy", "none"
  std::optional<Scene> container = {};               ///< a scene with the container
  std::vector<double> shift = {};                    ///< added to every centre
  std::optional<int> frame = {};                     ///< of a trajectory, from 1; by default the last
  std::string level = {};                            ///< of files with several; by default the outermost
  std::optional<int> dimension = {};                 ///< 2: discs, whose third coordinates are all equal
};

/// What the reader found in a file: "domain" and "a periodic box 3 x 4 x 5.3 mm, as the file says".
struct ImportNote {
  std::string about, text;
};

struct ImportedPacking {
  /// With the outcome `imported`, within one period; the corner of a periodic box is at zero.
  Packing packing;
  std::vector<ImportNote> notes;
};

/// Reads a packing that another program made. Its domain is the named scene's container, else the box in the
/// options, else the file's container or box, else the bounds of the spheres as walls; a box in the file is periodic
/// unless the file says otherwise. Spheres with numbers are sorted by them. Overlaps are accepted: they are
/// for the certificate.
///
/// Throws Error{bad_packing}, with file and line, for what cannot be read, for missing sizes or units, for a
/// skewed box, and for spheres of more than `most_filled` times the volume of their domain;
/// Error{bad_argument} for options that contradict the file or each other; Cancelled once the monitor says
/// stop. Memory for a count in the file is allocated only as its bytes are read.
///
/// Cost: 0.25 to 0.5 µs a sphere of text, twice that for trajectories, which are read twice; 0.06 µs for GSD
/// and .npy.
ImportedPacking import_packing(const std::filesystem::path& file, const ImportOptions& options = {},
                               const Monitor& monitor = {});
inline constexpr double most_filled = 20;

/// The same of spheres that a program has already, in the unit that `options` says. Throws
/// Error{bad_argument} for columns of different lengths and for numbers that are no lengths.
ImportedPacking import_spheres(Spheres<dynamic> spheres, const ImportOptions& options,
                               const Monitor& monitor = {});

/// Writes an imported packing like `write_packing`; its scene names the written spheres as its start, so that
/// `bernal pack` continues from them. `file` is the source, empty for spheres that came from no file. Throws
/// as that does, if `file` would be overwritten, and Cancelled, with nothing written, once the monitor says
/// stop.
WrittenPacking write_imported(Packing packing, const std::filesystem::path& file,
                              const std::filesystem::path& folder, WriteOptions options = {});
/// Throws what `write_imported` would throw for the folder; call it before reading a large file.
void check_importable(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace bernal
