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
  std::string what;                  ///< of which program, and what of it
  std::string unit;                  ///< of its lengths: "cm", or from where, "‹unit›"; see `with_options`
  std::vector<std::string> options;  ///< that it alone, or with some others, has: "columns", "frame"
};
/// All of them, in the order in which files are held against them.
std::vector<ImportFormat> import_formats();

/// What a file does not say, or is not believed. Lengths are in the file's unit.
struct ImportOptions {
  std::string format = {};  ///< of `import_formats`; empty: by the file's name and its first bytes
  /// Where the centre and the size stand: "x,y,z,d" in the order of the columns, `-` for another one, or
  /// "x=3,y=4,z=5,d=rad" by number, from 1, or by name. Radius is r, diameter d.
  std::string columns = {};
  std::optional<double> diameter = {}, radius = {};     ///< of all spheres, where the file has no sizes
  std::optional<std::filesystem::path> radii = {};   ///< a .npy of as many numbers as there are centres
  std::optional<Unit> unit = {};                     ///< where the file does not say it
  std::vector<double> box = {};                      ///< edges of the box [0, a) that is meant
  std::string periodic = {};                         ///< axes along which it repeats itself: "xy", "none"
  std::optional<Scene> container = {};               ///< whose container is meant
  std::vector<double> shift = {};                    ///< added to every centre
  std::optional<int> frame = {};                     ///< of a trajectory, from 1; else the last
  std::optional<int> dimension = {};                 ///< 2: discs, whose third coordinates are all equal
};

/// What has been understood of a file: "domain" and "a periodic box 3 x 4 x 5.3 mm, as the file says".
struct ImportNote {
  std::string about, text;
};

struct ImportedPacking {
  Packing packing;  ///< with the outcome `imported`; in one period, the corner of a periodic box at zero
  std::vector<ImportNote> notes;
};

/// Reads a packing that another program made. Its domain is the scene's container if one is named, else the
/// box that the options give, else that of the file, else the bounds of the spheres as walls; where a file
/// gives a box and does not say how its axes end, they repeat themselves. Spheres that have numbers come in
/// their order. Nothing is asked of them but to be spheres: whether they overlap says the certificate.
///
/// Throws Error{bad_packing} with file and line for what cannot be read, has no size, no unit or a skewed
/// box, and where the spheres have more than `most_filled` times the volume of their domain; Error{
/// bad_argument} for options that contradict the file or each other; Cancelled once the monitor says stop.
/// A count that a file claims is believed once its bytes are there.
///
/// Cost: 0.25 to 0.5 µs a sphere of text, which trajectories are read twice for, 0.06 µs of GSD and .npy.
ImportedPacking import_packing(const std::filesystem::path& file, const ImportOptions& options = {},
                               const Monitor& monitor = {});
inline constexpr double most_filled = 20;

/// The same of spheres that a program has already, in the unit that `options` says. Throws
/// Error{bad_argument} for columns of different lengths and for numbers that are no lengths.
ImportedPacking import_spheres(Spheres<dynamic> spheres, const ImportOptions& options,
                               const Monitor& monitor = {});

/// `write_packing` of what was imported: its scene names the spheres that are written as its start, so that
/// `bernal pack` goes on from there. `file` is the one that it came from, empty where that is none. Throws as
/// that does, and where this file would be overwritten; Cancelled, with nothing written, once the monitor
/// says stop, since the file is there still.
WrittenPacking write_imported(Packing packing, const std::filesystem::path& file,
                              const std::filesystem::path& folder, WriteOptions options = {});
/// Throws what that would throw for the folder, before a large file is read.
void check_importable(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace bernal
