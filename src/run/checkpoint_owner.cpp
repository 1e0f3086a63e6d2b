#include "run/checkpoint_owner.hpp"

#include <string>
#include <variant>
#include <vector>

#include "bernal/scene/read_scene.hpp"

namespace bernal {

CheckpointOwner checkpoint_owner(const Scene& scene, std::uint64_t seed) {
  CheckpointOwner owner;
  owner.program = this_program();
  owner.seed = seed;
  Scene bare = scene;
  bare.seed = 1;
  bare.outputs.clear();
  const auto note = [&](std::vector<std::string>& digests) {
    for (const std::string& digest : digests) owner.files += digest + "\n";
    digests.clear();
  };
  for (MeshFile* mesh : bare.meshes()) {
    note(mesh->sha256);
    for (std::filesystem::path* file : mesh->files()) *file = file->filename();
  }
  if (bare.start.file) {
    note(bare.start.sha256);
    bare.start.file = bare.start.file->filename();
  }
  owner.scene = scene_as_toml(bare);
  return owner;
}

}  // namespace bernal
