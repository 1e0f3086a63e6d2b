#include "scene/unpublished.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "files/bytes_of_file.hpp"
#include "files/put_in_place.hpp"
#include "scene/spheres_file.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

fs::path folder_of(const fs::path& file) { return file.parent_path().empty() ? "." : file.parent_path(); }

}  // namespace

fs::path where_it_stands(const fs::path& file) {
  const FolderTree tree(folder_of(file));
  if (!is_begun(tree)) return file;
  {
    const Lock turn = turn_in(tree.path());  // a process that is at it is done within milliseconds
  }
  const std::string name = file.filename();
  for (const fs::path left : {complete_name, placing_name}) {
    if (!is_begun(tree, left.c_str())) continue;
    const fs::path there = tree.path() / left / name;
    if (tree.kind_of(left / name) == FolderTree::Kind::regular) return there;
    const auto replaced = names_of_replaced(tree.text_of(left / replaced_name).value_or(""));
    if (left == complete_name && std::ranges::find(replaced, name) != replaced.end()) return there;
  }
  return file;
}

namespace {

bool can_be_read(const fs::path& file) {
  std::error_code unknown;
  return fs::exists(where_it_stands(file), unknown);
}

}  // namespace

fs::path spheres_file_in(const fs::path& folder) {
  const fs::path text = folder / spheres_as_text, array = folder / spheres_as_array;
  return !can_be_read(text) && can_be_read(array) ? array : text;
}

fs::path only_spheres_file_in(const fs::path& folder) {
  if (can_be_read(folder / spheres_as_text) && can_be_read(folder / spheres_as_array))
    throw Error(ErrorCode::bad_packing,
                fmt::format("holds {} and {}, and a result has one of them; remove the one that is not meant",
                            spheres_as_text, spheres_as_array),
                {folder.string()});
  return spheres_file_in(folder);
}

Scene scene_in(const fs::path& folder) {
  const fs::path file = folder / "scene.toml", there = where_it_stands(file);
  Scene scene = there == file ? read_scene(file) : parse_scene(bytes_of_file(there), file);
  for (MeshFile* mesh : scene.meshes())
    for (fs::path* part : mesh->files())
      if (part->lexically_normal() == (folder / part->filename()).lexically_normal())
        *part = where_it_stands(*part);
  return scene;
}

}  // namespace bernal
