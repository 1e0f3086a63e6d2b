#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// A format that other programs read packings from.
struct ExportFormat {
  std::string name;   ///< "lammps"
  std::string what;   ///< the program, and what the file holds for it
  std::string file;   ///< default file name of a scene's output: "lammps.data"
  std::string unit;   ///< default unit of lengths: "m", or "the scene's"
  std::string sizes;  ///< how the file states sizes: "diameter", "radius" or "voxels"
  int least_dimension = 3, most_dimensions = 3;
  std::vector<std::string> keys;  ///< options of the format, see `export_keys`
};
/// All formats, in the order in which they are listed to users.
std::vector<ExportFormat> export_formats();

/// An option of an output, on a command line or in a scene: "unit", "density", …
struct ExportKey {
  std::string name, what;
};
std::vector<ExportKey> export_keys();

/// The output for a format's name and the values of some keys: {{"unit", "mm"}}. Throws Error{bad_argument},
/// with the nearest name, for an unknown format, a key that the format does not have, or a value that the key
/// does not take.
Output output_of(std::string_view format, const std::map<std::string, std::string>& words = {});

/// The result of `write_export`.
struct WrittenExport {
  std::vector<std::filesystem::path> files;  ///< the format's file, then those that go with it
  /// What the file holds, in one line: count, unit, diameters or radii, density, types, and the largest
  /// overlap if numbers were rounded.
  std::string note;
};

/// Writes a packing for other programs to `file`, and for some formats to further files beside it. All appear
/// whole, or none; existing files of these names are replaced. Numbers are the shortest decimals that read
/// back as the packing's doubles; conversion to another unit, and to single precision where the format has
/// it, rounds once more. The note then states the largest overlap of the numbers in the file, by the
/// certificate.
///
/// Throws Error{bad_scene} if the format cannot hold the packing, Error{cannot_write} if a file of the
/// packing's own result or a source of its scene would be overwritten. Throws Cancelled once the monitor says
/// stop; nothing is written then.
///
/// Cost: about 0.2 µs a sphere, up to 0.8 µs more for a certificate; for an image that of `voxelise`, which
/// reports its progress.
WrittenExport write_export(const Packing&, const Output&, const std::filesystem::path& file,
                           const Monitor& monitor = {});

}  // namespace bernal
