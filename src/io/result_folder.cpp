#include "io/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "bernal/core/error.hpp"
#include "bernal/io/read_packing.hpp"
#include "bernal/io/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cad/file_digest.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// Of the digest, in the names of copies.
constexpr std::size_t digits_in_name = 8;

/// "part-1f3870be.stl" of "part.stl".
fs::path name_of_copy(const fs::path& file, const std::string& sha256) {
  return fmt::format("{}-{}{}", file.stem().string(), std::string_view(sha256).substr(0, digits_in_name),
                     file.extension().string());
}

/// Whether the name ends in the digest of the content, as that of a copy does.
bool is_copy(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (stem.size() < digits_in_name + 2 || stem[stem.size() - digits_in_name - 1] != '-') return false;
  const std::string digits = stem.substr(stem.size() - digits_in_name);
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (!std::ranges::all_of(digits, is_digit)) return false;
  try {
    return sha256_of(file).starts_with(digits);
  } catch (const Error&) {
    return false;
  }
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether nothing is lost where bernal writes that scene again: whoever wrote it by hand left out defaults,
/// or put in comments.
bool is_as_written(const fs::path& scene) {
  try {
    return scene_as_toml(read_scene(scene), scene.parent_path()) == text_of(scene);
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool is_of_earlier_result(const fs::path& file) {
  std::error_code unknown;
  if (!fs::is_regular_file(fs::symlink_status(file, unknown))) return false;
  const fs::path name = file.filename();
  return name == "packing.svg" || name == "container.off" || is_copy(file);
}

Scene scene_as_run(const Packing& packing, StagedFolder& staged, const fs::path& folder, bool with_mesh) {
  Scene scene = packing.scene;
  scene.seed = packing.seed;
  auto* mesh = std::get_if<MeshFile>(&scene.container);
  if (!with_mesh || !mesh) return scene;
  std::vector<std::string> copied;
  const auto copy = [&](fs::path& file, const std::string& packed_into) {
    std::error_code problem;
    if (fs::equivalent(fs::absolute(file).parent_path(), folder, problem) && !is_copy(file)) return;
    const std::string name = name_of_copy(file, packed_into).string();
    if (std::ranges::find(copied, name) == copied.end()) {
      const fs::path there = staged.add(name);
      fs::copy_file(file, there, problem);
      if (problem)
        throw Error(ErrorCode::cannot_write, "cannot be copied: " + problem.message(), {file.string()});
      if (sha256_of(there) != packed_into)
        throw Error(ErrorCode::cannot_write, "has changed while it was packed into", {file.string()});
      copied.push_back(name);
    }
    file = fs::absolute(folder) / name;
  };
  const std::vector<std::string> digests = mesh->sha256;
  copy(mesh->file, digests.at(0));
  for (std::size_t k = 0; k < mesh->obstacles.size(); ++k) copy(mesh->obstacles[k], digests.at(k + 1));
  return scene;
}

void finish_writing(const fs::path& folder) { finish_publishing(folder, is_of_earlier_result); }

void check_writable(const fs::path& folder) {
  StagedFolder staged(folder);
  staged.write("spheres.csv", "x,y,z,r\n");
}

void check_writable(const fs::path& folder, const Scene& scene, const WriteOptions& options) {
  const auto refuse = [](const fs::path& file, const std::string& why) {
    throw Error(ErrorCode::cannot_write, why, {file.string()});
  };
  std::error_code unknown;
  const fs::path there = folder / "scene.toml";
  const bool is_itself = !scene.file.empty() && fs::equivalent(there, scene.file, unknown);
  const bool is_of_result = fs::exists(folder / "report.json", unknown) && !is_itself;
  if (fs::exists(there, unknown) && !is_of_result && !is_as_written(there))
    refuse(there,
           "is your own scene, and the scene as run would take its place; give another folder with -o");
  const auto* mesh = std::get_if<MeshFile>(&scene.container);
  if (options.with_mesh && !mesh)
    throw Error(ErrorCode::bad_argument, "--with-mesh copies a CAD file, and this container is none");
  if (options.with_mesh && (mesh->file.extension() == ".gltf" || mesh->file.extension() == ".GLTF"))
    refuse(mesh->file,
           "may name other files, which are not copied with it; export GLB, which holds all of them");
  check_writable(folder);
}

}  // namespace bernal
