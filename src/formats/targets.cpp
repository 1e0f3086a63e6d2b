#include "formats/targets.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "io/result_folder.hpp"
#include "io/seal.hpp"
#include "io/staged_folder.hpp"
#include "scene/output_table.hpp"
#include "scene/scene_sources.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

[[noreturn]] void refuse_target(const fs::path& file, const std::string& why) {
  throw Error(ErrorCode::cannot_write, why, {file.string()});
}

/// What the packing was made from, or is.
std::vector<fs::path> sources_of(const Packing& packing) {
  const Scene& scene = packing.scene;
  std::vector<fs::path> files = sources_of_scene(scene.file);
  if (!scene.file.empty()) {
    const fs::path folder = scene.file.parent_path();
    for (const std::string_view name : names_of_result) files.push_back(folder / name);
    for (const std::string& source : sources_of_result(folder)) files.push_back(folder / source);
  }
  const auto add_part = [&](const fs::path& part) {
    std::error_code unknown;
    if (!fs::is_regular_file(part, unknown)) return;
    for (const fs::path& file : files_of_part_beside(part)) files.push_back(file);
  };
  if (const auto* mesh = std::get_if<MeshFile>(&scene.container)) {
    add_part(mesh->file);
    for (const fs::path& obstacle : mesh->obstacles) add_part(obstacle);
  }
  if (scene.start.file) files.push_back(*scene.start.file);
  return files;
}

}  // namespace

fs::path file_meant_by(const fs::path& named) {
  fs::path file = named;
  std::error_code unknown;
  constexpr int most_links = 40;  // as the system has it
  for (int k = 0; fs::is_symlink(file, unknown); ++k) {
    if (k == most_links) refuse_target(named, "is a link that leads to itself; give the name of a file");
    const fs::path target = fs::read_symlink(file, unknown);
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  const fs::path name = file.filename();
  if (name == "." || name == ".." || fs::is_directory(file, unknown))
    refuse_target(named, "is a folder; give the name of a file in it");
  if (stands(file) && !fs::is_regular_file(file, unknown))
    refuse_target(named, "is a device or a pipe, which no file takes the place of; give the name of a file");
  return file;
}

void require_free_places(const Packing& packing, const Output& output, const fs::path& folder) {
  const std::vector<std::string> names = files_of(output);
  const std::vector<fs::path> sources = sources_of(packing);
  const Manifest of_result = manifest_of(folder);
  std::vector<fs::path> files, of_others;
  for (const std::string& name : names) files.push_back(folder / name);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const fs::path& file = files[k];
    if (!stands(file)) continue;
    std::error_code unknown;
    for (const fs::path& source : sources)
      if (fs::equivalent(file, source, unknown))
        refuse_target(file, "is what the packing is read from, or was made from; give another name with -o");
    if (of_result.contains(names[k]))
      refuse_target(file, "belongs to the result in that folder; give another name with -o");
    if (k > 0 && !(fs::is_regular_file(fs::symlink_status(file, unknown)) && is_as_bernal_wrote(file, files)))
      of_others.push_back(file);
  }
  if (of_others.empty()) return;
  // A script that was changed no longer answers for those that go with it.
  std::ranges::stable_partition(of_others, [](const fs::path& file) { return has_seal(file); });
  refuse_target(of_others[0],
                fmt::format("goes with {}, and what stands there bernal did not write, or somebody "
                            "has changed it; give another name with -o, or move it away",
                            names[0]));
}

}  // namespace bernal
