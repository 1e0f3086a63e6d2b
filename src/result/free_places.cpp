#include "result/free_places.hpp"

#include <system_error>

#include "bernal/core/error.hpp"
#include "files/staged_folder.hpp"
#include "result/result_folder.hpp"

namespace fs = std::filesystem;

namespace bernal {

fs::path folder_of(const fs::path& file) {
  const fs::path name = file.filename();
  if (name.empty() || name == "." || name == "..")
    throw Error(ErrorCode::cannot_write, "is a folder; give the name of a file in it", {file.string()});
  return file.parent_path().empty() ? "." : file.parent_path();
}

void require_free(const fs::path& folder, const std::vector<std::string>& names) {
  const Manifest of_result = manifest_of(folder);
  for (const std::string& name : names) {
    const fs::path file = folder / name;
    if (of_result.contains(name) || is_in_place_of_result(file, folder))
      throw Error(ErrorCode::cannot_write, "belongs to the result in that folder; give another ‹file›",
                  {file.string()});
    std::error_code unknown;
    if (stands(file) && !fs::is_regular_file(fs::symlink_status(file, unknown)))
      throw Error(ErrorCode::cannot_write, "is a folder, a link or a device; give the name of a file",
                  {file.string()});
  }
}

}  // namespace bernal
