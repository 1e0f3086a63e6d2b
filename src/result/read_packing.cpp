#include "bernal/result/read_packing.hpp"

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "files/put_in_place.hpp"
#include "scene/read_npy_spheres.hpp"
#include "scene/read_spheres.hpp"
#include "scene/spheres_file.hpp"
#include "scene/unpublished.hpp"

namespace bernal {

namespace {

/// Throws where spheres and scene do not go together.
Spheres<dynamic> of_the_scene(const Scene& scene, const std::filesystem::path& file, SpheresFile read) {
  if (!read.unit.empty() && read.unit != name_of(scene.unit))
    throw Error(ErrorCode::bad_packing,
                fmt::format("the spheres are in {}, but the scene is in {}; both must have one unit",
                            read.unit, name_of(scene.unit)),
                {file.string()});
  if (read.spheres.dimension() != scene.dimension())
    throw Error(
        ErrorCode::bad_packing,
        fmt::format("the spheres have {} dimension{}, but the scene has {}; is it the scene "
                    "of another packing?",
                    read.spheres.dimension(), read.spheres.dimension() == 1 ? "" : "s", scene.dimension()),
        {file.string()});
  return std::move(read).spheres;
}

}  // namespace

bool is_unpublished(const std::filesystem::path& folder) { return is_begun(FolderTree(folder)); }

Spheres<dynamic> read_csv_of(const Scene& scene, const std::filesystem::path& file) {
  return of_the_scene(scene, file, read_csv(file));
}

Spheres<dynamic> read_columns_of(const Scene& scene, const std::filesystem::path& file) {
  NamedColumns read = read_spheres(file);
  return of_the_scene(scene, file, {std::move(read.spheres), std::move(read.unit)});
}

std::filesystem::path spheres_of_result(const std::filesystem::path& folder) {
  return where_it_stands(spheres_file_in(folder));
}

Scene scene_of_result(const std::filesystem::path& folder) { return scene_in(folder); }

Spheres<dynamic> read_spheres_of(const Scene& scene, const std::filesystem::path& folder) {
  const std::filesystem::path file = where_it_stands(only_spheres_file_in(folder));
  if (file.filename() == spheres_as_array) return of_the_scene(scene, file, {read_npy_spheres(file), {}});
  return read_csv_of(scene, file);
}

Packing read_packing(const std::filesystem::path& folder) {
  std::error_code unknown;
  if (!std::filesystem::is_directory(folder, unknown)) {
    throw Error(ErrorCode::bad_packing, "is no folder; give the one that bernal pack wrote",
                {folder.string()});
  }
  Packing packing;
  packing.scene = scene_in(folder);
  packing.spheres = read_spheres_of(packing.scene, folder);  // before another result replaces both
  packing.domain = packed_domain_of(packing.scene);
  packing.volume = volume_of(packing.domain);
  packing.seed = packing.scene.seed;
  if (const auto& start = packing.scene.start.file;
      start && std::filesystem::equivalent(where_it_stands(*start), spheres_of_result(folder), unknown))
    packing.outcome = Outcome::imported;  // only such a result begins from itself
  return packing;
}

}  // namespace bernal
