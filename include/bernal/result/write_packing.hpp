#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

struct WrittenPacking {
  std::vector<std::filesystem::path> files;  ///< final paths, in the order of the contract
  Certificate certificate;                   ///< of the spheres as they were written and read back
  std::vector<std::string> notes;            ///< of each of the scene's outputs, what its file holds
};

struct WriteOptions {
  /// Copies the CAD files, and the file of the start, beside the spheres, under names that end in the
  /// beginning of their SHA-256, and lets scene.toml name the copies.
  bool with_mesh = false;
  bool view = true;  ///< report.html has the spheres and a view to turn, see `view_page`; else a picture only
  /// spheres.npy takes the place of spheres.csv and spheres.vtp: an array of NumPy's, a row x, y, z, r of
  /// doubles for each sphere, in the scene's unit. So it does for more than `most_as_text` spheres.
  bool as_array = false;
  std::size_t most_as_text = 5'000'000;
  std::size_t list = 0;  ///< so many overlapping pairs and protruding spheres are listed: the worst
  Monitor monitor = {};
  bool all_or_nothing = false;  ///< once the monitor says stop, Cancelled is thrown and nothing is written
  std::string cell = {};        ///< of a sweep whose result this is: its hash, which report.json then names
};

/// Writes spheres.csv and spheres.vtp, or spheres.npy, scene.toml, report.json, report.html, in two and three
/// dimensions packing.svg and in three section.svg, that of `middle_plane`, and what the scene's outputs ask
/// for, into `folder`, which is made if it does not exist.
///
/// Of each packing inside of spheres, of which there may be one for each, the folder has what it takes to
/// read, certify and measure it: its spheres, layers and scene, a report.json without measurements, and its
/// own outputs.
///
/// Everything is written whole under temporary names, the spheres are read back and certified against the
/// packing's container, and only then do they take the place of all files of an earlier result: a failure
/// throws Error{cannot_write} and leaves earlier output untouched. Once the monitor says stop, measurements
/// that may be absent are left out, unless `all_or_nothing` says that all is.
WrittenPacking write_packing(const Packing& packing, const std::filesystem::path& folder,
                             const WriteOptions& options = {});

/// Which of the two files holds the spheres: "spheres.csv" or "spheres.npy".
std::string spheres_file_of(const Packing& packing, const WriteOptions& options = {});

/// Throws Error{cannot_write} now rather than after a long run, if `folder` can be neither used nor made.
/// Leaves nothing behind.
void check_writable(const std::filesystem::path& folder);

/// The same for the result of a scene: also if a file has the name of one of the result's that no earlier
/// result left there, or that a user changed since, if a CAD file has a name that scene.toml cannot hold, or
/// if what would be copied beside the result is not whole by itself.
void check_writable(const std::filesystem::path& folder, const Scene& scene,
                    const WriteOptions& options = {});

/// What a certificate's statement adds about the walls, where they are not simply the file's surface: " The
/// walls are …", or nothing.
std::string certified_walls(const Scene& scene, const Domain& domain);

}  // namespace bernal
