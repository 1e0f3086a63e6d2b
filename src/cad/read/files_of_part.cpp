#include "cad/read/files_of_part.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "cad/read/known_formats.hpp"
#include "files/bytes_of_file.hpp"
#include "files/file_kind.hpp"
#include "files/input_file.hpp"
#include "files/sha256.hpp"

namespace bernal {

namespace fs = std::filesystem;

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t k = 0; k < text.size(); ++k) {
    unsigned byte = 0;
    const bool is_code =
        text[k] == '%' && k + 2 < text.size() &&
        std::from_chars(text.data() + k + 1, text.data() + k + 3, byte, 16).ptr == text.data() + k + 3;
    decoded += is_code ? static_cast<char>(byte) : text[k];
    if (is_code) k += 2;
  }
  return decoded;
}

namespace {

/// The files that a STEP file names, as written: the first string of each DOCUMENT_FILE.
std::vector<std::string> documents_in_step(const fs::path& file) {
  const std::string text = bytes_of_file(file);
  constexpr std::string_view entity = "DOCUMENT_FILE";
  std::vector<std::string> names;
  for (std::size_t at = text.find(entity); at != text.npos; at = text.find(entity, at + 1)) {
    const std::size_t open = text.find_first_not_of(" \t\r\n(", at + entity.size());
    if (open == text.npos || text[open] != '\'') continue;
    const std::size_t close = text.find('\'', open + 1);
    if (close != text.npos) names.push_back(text.substr(open + 1, close - open - 1));
  }
  return names;
}

/// With the files beside it that they name, recursively.
std::vector<fs::path> files_of_step(const fs::path& file) {
  std::vector<fs::path> files{file};
  for (std::size_t k = 0; k < files.size(); ++k)
    for (const std::string& name : documents_in_step(files[k])) {
      const fs::path other = files[k].parent_path() / name;
      const bool is_step = cad::extension_of(other) == ".step" || cad::extension_of(other) == ".stp";
      if (is_step && kind_of_file(other) == FileKind::regular &&
          std::ranges::find(files, other) == files.end())
        files.push_back(other);
    }
  return files;
}

}  // namespace

std::vector<fs::path> files_of_part(const fs::path& file) {
  std::vector<fs::path> files{file};
  if (kind_of_file(file) != FileKind::regular) return files;
  const std::string extension = cad::extension_of(file);
  if (extension == ".step" || extension == ".stp") return files_of_step(file);
  if (extension != ".gltf") return files;
  InputFile in(file);
  using Event = nlohmann::json::parse_event_t;
  const auto is_kept = [](int depth, Event event, const nlohmann::json& parsed) {
    return event != Event::key || depth != 1 || parsed == "buffers";  // the rest may be large
  };
  const auto document = nlohmann::json::parse(in, is_kept, false);
  if (!document.is_object() || !document.contains("buffers")) return files;
  for (const auto& buffer : document["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto uri = buffer["uri"].get<std::string>();
    if (uri.starts_with("data:")) continue;
    for (const std::string& name : {uri, percent_decoded(uri)}) {
      if (kind_of_file(file.parent_path() / name) != FileKind::regular) continue;
      files.push_back(file.parent_path() / name);
      break;
    }
  }
  return files;
}

std::string sha256_of_part(const fs::path& file) { return sha256_of(files_of_part(file)); }

}  // namespace bernal
