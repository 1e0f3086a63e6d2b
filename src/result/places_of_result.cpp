#include "result/places_of_result.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "files/bytes_of_file.hpp"
#include "files/staged_folder.hpp"
#include "result/nest_folder.hpp"
#include "scene/given_files.hpp"
#include "scene/insides.hpp"
#include "scene/output_table.hpp"

namespace bernal {
namespace places_of_result {

namespace fs = std::filesystem;

constexpr std::string_view of_templates = "template-";

/// Whether nothing is lost where bernal writes that scene again: whoever wrote it by hand left out defaults,
/// or put in comments.
bool is_as_written(const fs::path& scene) {
  std::error_code unknown;
  if (!fs::is_regular_file(fs::symlink_status(scene, unknown))) return false;
  try {
    Scene written = read_scene(scene);
    put_long_lists_beside(written);
    return scene_as_toml(written, scene.parent_path()) == bytes_of_file(scene);
  } catch (const Error&) {
    return false;
  }
}

bool is_folder(const fs::path& path) {
  std::error_code unknown;
  return fs::is_directory(fs::symlink_status(path, unknown));
}

/// The places of one result, and of those below.
class Places {
 public:
  Places(const fs::path& folder, const std::vector<std::string>& earlier)
      : folder_(folder), earlier_(earlier.begin(), earlier.end()) {}

  void require_free(const Scene& scene, const std::string& below) const {
    for (const std::string& name : names_of_result_of(scene)) require_free(below + name);
    for (const Inside& inside : scene.inside) {
      const std::string within = below + "inside/" + filled_class(scene, inside).folder;
      require_no_file(below + "inside");
      require_no_file(within);
      require_free(within + "/" + table_of_rotations);
      if (!is_folder(folder_ / within)) continue;
      const Scene inner = scene_inside(inside, scene.unit);
      for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / within)) {
        const std::string name = entry.path().filename().string();
        if (!may_be_written(name, inside)) continue;
        require_no_file(within + "/" + name);
        require_free(inner, within + "/" + name + "/");
      }
    }
  }

 private:
  bool is_earlier(const std::string& name) const { return earlier_.contains(name); }

  /// What would be packed inside: the ball is of no matter to the names of files. Of a packing whose scenes
  /// have gone since, files that every result has.
  static Scene scene_inside(const Inside& inside, Unit unit) {
    try {
      return read_scene_inside(inside.scene, {1, unit}).scene;
    } catch (const Error&) {
      return {};
    }
  }

  /// Whether one of the packings inside may go into a folder of that name.
  static bool may_be_written(std::string_view name, const Inside& inside) {
    if (!name.starts_with(of_templates)) return false;
    const std::string_view digits = name.substr(of_templates.size());
    std::size_t number = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, problem] = std::from_chars(digits.data(), end, number);
    if (problem != std::errc{} || stop != end || number == 0) return false;
    if (!inside.templates) return true;  // one for every sphere, however many there will be
    const auto n = static_cast<std::size_t>(*inside.templates);
    return number <= n && name == folder_of_template(number, n);
  }

  /// Whether all files below are those of the earlier result, and there are any.
  bool holds_only_earlier(const fs::path& below) const {
    std::size_t found = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(below)) {
      if (!entry.is_symlink() && entry.is_directory()) continue;
      if (!is_earlier(entry.path().lexically_relative(folder_).generic_string())) return false;
      ++found;
    }
    return found > 0;
  }

  void require_free(const std::string& name) const {
    const fs::path there = folder_ / name;
    if (!stands(there) || is_earlier(name)) return;
    if (std::error_code unknown; fs::is_directory(there, unknown)) {
      if (holds_only_earlier(there)) return;
      throw Error(
          ErrorCode::cannot_write,
          "is a folder with more in it than bernal wrote, or changed since, and the result would take "
          "its place; give another ‹folder›, or move it away",
          {there.string()});
    }
    if (there.filename() == "scene.toml" && is_as_written(there)) return;
    refuse(there);
  }

  /// Where a folder of the result is to be.
  void require_no_file(const std::string& name) const {
    const fs::path there = folder_ / name;
    if (stands(there) && !is_folder(there)) refuse(there);
  }

  [[noreturn]] static void refuse(const fs::path& there) {
    throw Error(ErrorCode::cannot_write,
                "is no result of bernal's, or was changed since, and the result would take its place; give "
                "another ‹folder›, or remove it",
                {there.string()});
  }

  const fs::path& folder_;
  const std::set<std::string> earlier_;
};

}  // namespace places_of_result

std::string folder_of_template(std::size_t number, std::size_t of) {
  constexpr std::size_t least_digits = 3;
  return fmt::format("{}{:0{}}", places_of_result::of_templates, number,
                     std::max(least_digits, fmt::format("{}", of).size()));
}

std::vector<std::string> names_of_result_of(const Scene& scene) {
  std::vector<std::string> names(names_of_result.begin(), names_of_result.end());
  for (Output output : scene.outputs) {
    complete_output(output, scene);
    std::ranges::move(files_of(output), std::back_inserter(names));
  }
  return names;
}

void require_free_places(const std::filesystem::path& folder, const Scene& scene,
                         const std::vector<std::string>& earlier) {
  places_of_result::Places(folder, earlier).require_free(scene, "");
}

}  // namespace bernal
