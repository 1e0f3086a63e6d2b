#pragma once
#include <array>
#include <filesystem>
#include <string_view>

namespace bernal {

/// The files that hold the spheres of a result, as text and as an array of NumPy's; a result has one of them.
inline constexpr std::string_view spheres_as_text = "spheres.csv", spheres_as_array = "spheres.npy";

/// That of the result in a folder: the text, unless there is only the array.
inline std::filesystem::path spheres_file_in(const std::filesystem::path& folder) {
  std::error_code unknown;
  const std::filesystem::path text = folder / spheres_as_text, array = folder / spheres_as_array;
  return !std::filesystem::exists(text, unknown) && std::filesystem::exists(array, unknown) ? array : text;
}

}  // namespace bernal
