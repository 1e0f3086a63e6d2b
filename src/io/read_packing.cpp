#include "bernal/io/read_packing.hpp"

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal {

Packing read_packing(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw Error(ErrorCode::bad_packing, "is no folder; give the one that bernal pack wrote",
                {folder.string()});
  }
  Packing packing;
  packing.scene = read_scene(folder / "scene.toml");
  const std::filesystem::path csv = folder / "spheres.csv";
  SpheresFile read = read_csv(csv);
  if (!read.unit.empty() && read.unit != packing.scene.unit) {
    throw Error(ErrorCode::bad_packing,
                fmt::format("the spheres are in {}, but the scene is in {}; both must have one unit",
                            read.unit, packing.scene.unit),
                {csv.string()});
  }
  if (read.spheres.dimension() != packing.scene.dimension()) {
    throw Error(ErrorCode::bad_packing,
                fmt::format("the spheres have {} dimensions, but the scene has {}; both must have as many",
                            read.spheres.dimension(), packing.scene.dimension()),
                {csv.string()});
  }
  packing.spheres = std::move(read.spheres);
  packing.domain = domain_of(packing.scene);
  packing.volume = volume_of(packing.domain);
  packing.seed = packing.scene.seed;
  return packing;
}

}  // namespace bernal
