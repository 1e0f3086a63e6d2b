#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

struct SpheresFile {
  Spheres<dynamic> spheres;
  std::string unit;  ///< of the "# unit: mm" line, "" if there is none
  /// Where there is a column "class": of each sphere its number among the names, which stand in the order in
  /// which the file has them.
  std::vector<std::uint32_t> classes = {};
  std::vector<std::string> class_names = {};
};

/// Reads `x,y,z,r` lines (`x0,x1,…,r` in other dimensions than three), with or without `,class,material`.
/// Throws Error{bad_packing} with file, line and what is wrong: header, number of fields, text that is no
/// number, not finite, radius not positive, truncated last line.
SpheresFile read_csv(const std::filesystem::path& file);

/// The classes of a file's spheres as the scene counts them, see `Packing::classes`; empty where the file or
/// the scene has none. Throws Error{bad_packing} for one that the scene does not have.
std::vector<std::uint32_t> classes_in(const Scene& scene, const SpheresFile& file);

/// The spheres of a file that are to lie in the scene's domain. Throws as `read_csv`, and Error{bad_packing}
/// where their unit or dimension is not the scene's.
Spheres<dynamic> read_csv_of(const Scene& scene, const std::filesystem::path& file);

/// Which file of a result's folder holds its spheres: spheres.csv, or spheres.npy where only that is there;
/// where it can be read, see `is_unpublished`.
std::filesystem::path spheres_of_result(const std::filesystem::path& folder);
/// Those spheres, and if asked for their classes, see `classes_in`. Throws as `read_csv_of`. Memory: for the
/// spheres once.
Spheres<dynamic> read_spheres_of(const Scene& scene, const std::filesystem::path& folder,
                                 std::vector<std::uint32_t>* classes = nullptr);

/// The same of a file of another program, whose header names its columns in any order: what a scene may start
/// from; or an array of NumPy's. Throws Error{bad_packing} for a header that does not, as the others for the
/// rest.
Spheres<dynamic> read_columns_of(const Scene& scene, const std::filesystem::path& file);

/// Its scene. Throws as `read_scene`.
Scene scene_of_result(const std::filesystem::path& folder);

/// Whether a run was killed over putting its result into the folder. All that is read here is read from where
/// that run left it, and nothing is changed; the next run that writes there puts it into its place.
bool is_unpublished(const std::filesystem::path& folder);

/// What stands in scene.toml and spheres.csv, or spheres.npy, of a folder that `write_packing` made, or that
/// has files of that form. How the run went is not among it: effects, history, seconds and program are empty;
/// the outcome says whether another program made it. Throws as `read_scene`, `packed_domain_of` and
/// `read_csv_of` do.
Packing read_packing(const std::filesystem::path& folder);

/// How the run that wrote a result fell short of what its scene asks, as report.json says: "full: 9 of 50
/// spheres are placed". Empty where it did not, or where there is no such report.
std::string shortfall_of_result(const std::filesystem::path& folder);

}  // namespace bernal
