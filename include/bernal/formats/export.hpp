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

/// A format in which other programs read packings.
struct ExportFormat {
  std::string name;   ///< "lammps"
  std::string what;   ///< for which program, and what of it
  std::string file;   ///< the name that a scene's output has if it says none: "lammps.data"
  std::string unit;   ///< of lengths if nothing else is asked for: "m", or "the scene's"
  std::string sizes;  ///< "diameter", "radius" or "voxels": what the file holds
  int least_dimension = 3, most_dimensions = 3;
  std::vector<std::string> keys;  ///< what it can be told, see `export_keys`
};
/// All of them, in the order in which people are told of them.
std::vector<ExportFormat> export_formats();

/// What one may say of an output, on a command line or in a scene: "unit", "density", …
struct ExportKey {
  std::string name, what;
};
std::vector<ExportKey> export_keys();

/// The output that is meant by the name of a format and by words for some of its keys: {{"unit", "mm"}}.
/// Throws Error{bad_argument} with the nearest name for a format that there is not, and for a key that the
/// format has not or a word that the key does not take.
Output output_of(std::string_view format, const std::map<std::string, std::string>& words = {});

/// What has been written.
struct WrittenExport {
  std::vector<std::filesystem::path> files;  ///< that of the format, then those that go with it
  /// What the file holds, in one line: count, unit, whether diameters or radii, density, types, and the
  /// largest overlap where numbers were rounded.
  std::string note;
};

/// Writes a packing as other programs read it, to `file` and, for some formats, to others beside it: all of
/// them appear whole, or none; files of these names go. Numbers are the shortest decimals that read back as
/// the same doubles, and those of the packing; where they are converted to another unit they are rounded once
/// more, and in formats of single precision to that. Then the certificate is asked for the largest overlap of
/// what the file holds, which the note says.
///
/// Throws Error{bad_scene} where the format cannot hold the packing, Error{cannot_write} where a file of the
/// packing's own result would be overwritten, or what its scene was made from. Once the monitor says stop,
/// throws Cancelled, and nothing is written.
///
/// Cost: about 0.2 µs a sphere; the certificate, where it is asked, up to 0.8 µs. Of an image that of
/// `voxelise`, which reports its progress.
WrittenExport write_export(const Packing&, const Output&, const std::filesystem::path& file,
                           const Monitor& monitor = {});

}  // namespace bernal
