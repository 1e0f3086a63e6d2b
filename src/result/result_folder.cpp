#include "result/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cad/read/files_of_part.hpp"
#include "files/bytes_of_file.hpp"
#include "files/sha256.hpp"
#include "report/report.hpp"
#include "result/nest_folder.hpp"
#include "result/places_of_result.hpp"
#include "scene/given_files.hpp"
#include "scene/output_table.hpp"
#include "scene/unpublished.hpp"

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

bool is_regular(const fs::path& file) {
  std::error_code unknown;
  return fs::is_regular_file(fs::symlink_status(file, unknown));
}

bool stands_in(const fs::path& file, const fs::path& folder) {
  std::error_code unknown;
  return fs::equivalent(fs::weakly_canonical(fs::absolute(file), unknown).parent_path(), folder, unknown);
}

/// A file that a scene names, and its digest, once the scene has been run.
struct NamedFile {
  fs::path& file;
  std::string sha256;
};
std::vector<NamedFile> files_and_digests(Scene& scene) {
  std::vector<std::string> digests;
  for (const MeshFile* mesh : scene.meshes()) {
    const std::size_t files = digests.size() + 1 + mesh->obstacles.size();
    digests.insert(digests.end(), mesh->sha256.begin(), mesh->sha256.end());
    digests.resize(files);
  }
  if (scene.start.file)
    digests.push_back(scene.start.sha256.empty() ? std::string() : scene.start.sha256.front());
  std::vector<NamedFile> files;
  for (fs::path* const file : files_named_in(scene))
    files.push_back({*file, files.size() < digests.size() ? digests[files.size()]
                                                          : sha256_of_bytes(*content_given(scene, *file))});
  return files;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(ErrorCode::cannot_write, why, {file.string()});
}

}  // namespace

Manifest manifest_of(const fs::path& folder) {
  const fs::path report = where_it_stands(folder / "report.json");
  return is_regular(report) ? manifest_in(bytes_of_file(report)) : Manifest();
}

std::vector<std::string> sources_of_result(const fs::path& folder) {
  const fs::path report = where_it_stands(folder / "report.json");
  return is_regular(report) ? sources_in(bytes_of_file(report)) : std::vector<std::string>();
}

std::vector<fs::path> files_of_part_beside(const fs::path& part) { return files_of_part(part); }

std::vector<std::string> files_of_earlier_result(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& [name, sha256] : manifest_of(folder)) {
    const fs::path file = folder / name;
    if (is_name_in(folder, name) && is_regular(file) && (sha256.empty() || sha256_of(file) == sha256))
      files.push_back(name);
  }
  return files;
}

Scene scene_as_run(const Packing& packing, StagedFolder& staged, const fs::path& folder, bool with_mesh,
                   Manifest& manifest) {
  Scene named = packing.scene;
  put_long_lists_beside(named);
  Scene scene = named;
  scene.seed = packing.seed;
  const Manifest earlier = manifest_of(folder);
  for (auto& [file, sha256] : files_and_digests(scene)) {
    const std::optional<std::string> given = content_given(named, file);
    if (!given && stands_in(file, folder)) {
      const auto copy = earlier.find(file.filename().string());
      if (copy != earlier.end() && copy->second == sha256) manifest.insert(*copy);
      continue;
    }
    if (!given && !with_mesh) continue;
    const std::string name = name_of_copy(file, sha256).string();
    if (given) {
      staged.write(name, *given);
      manifest[name] = sha256;
    } else if (!manifest.contains(name)) {
      const fs::path there = staged.add(name);
      std::error_code problem;
      fs::copy_file(where_it_stands(file), there, problem);
      if (problem) refuse(file, "cannot be copied: " + problem.message());
      if (sha256_of(there) != sha256) refuse(file, "has changed while it was packed into");
      manifest[name] = sha256;
    }
    file = fs::absolute(folder) / name;
  }
  const std::vector<InsideFiles> insides = files_of_insides(packing);
  for (std::size_t k = 0; k < insides.size(); ++k)
    if (!insides[k].scene.empty()) scene.inside[k].scene = fs::absolute(folder) / insides[k].scene;
  return scene;
}

bool is_in_place_of_result(const fs::path& file, const fs::path& folder) {
  std::error_code unknown;
  const std::string name = fs::weakly_canonical(fs::absolute(file), unknown).filename().string();
  return std::ranges::find(names_of_result, name) != std::end(names_of_result) && stands_in(file, folder);
}

void check_writable(const fs::path& folder) {
  StagedFolder staged(folder);
  staged.write("spheres.csv", "x,y,z,r\n");
}

void check_writable(const fs::path& folder, const Scene& scene, const WriteOptions& options) {
  Scene packed = scene;
  const std::vector<NamedFile> named_files = files_and_digests(packed);
  if (options.with_mesh && named_files.empty())
    throw Error(ErrorCode::bad_argument, "‹with_mesh› copies a CAD file, and this container is none");
  std::vector<NamedFile> files;
  std::ranges::remove_copy_if(named_files, std::back_inserter(files),
                              [&](const NamedFile& named) { return is_given(scene, named.file); });
  for (const auto& [file, sha256] : files) {
    if (!is_utf8(file.string()))
      refuse(file, "has a name that is not UTF-8, which scene.toml has to be; rename it");
    if (options.with_mesh && files_of_part(file).size() > 1)
      refuse(file, "names other files, which are not copied with it; export GLB, which holds all of them");
    constexpr std::size_t longest_name = 255 - 1 - digits_in_name;
    if (options.with_mesh && file.filename().string().size() > longest_name)
      refuse(file, "has too long a name for a copy, which ends in its digest; rename it");
  }
  const std::vector<std::string> names = names_of_result_of(scene);
  for (const auto& [named, sha256] : files) {
    const bool is_start = packed.start.file && &named == &*packed.start.file;
    std::error_code unknown;  // of a link that leads to itself
    const fs::path file = fs::is_directory(named, unknown) ? spheres_file_in(named) : named;
    const fs::path meant = fs::weakly_canonical(fs::absolute(file), unknown);
    if (std::ranges::find(names, meant.filename().string()) == names.end() || !stands_in(meant, folder))
      continue;
    refuse(file, fmt::format("is {}{}, and the result would take its place; give another ‹folder›",
                             is_start ? "what the scene starts from" : "the part that the scene packs",
                             file.filename() == meant.filename() ? "" : ", by a link"));
  }
  check_writable(folder);
  require_free_places(folder, scene, files_of_earlier_result(folder));
}

}  // namespace bernal
