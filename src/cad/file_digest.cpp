#include "cad/file_digest.hpp"

#include <sys/types.h>

#include <sha2.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "bernal/core/error.hpp"
#include "cad/known_formats.hpp"
#include "core/file_kind.hpp"
#include "core/input_file.hpp"

namespace bernal {

namespace fs = std::filesystem;

struct Sha256::State {
  SHA2_CTX context;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { SHA256Init(&state_->context); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  SHA256Update(&state_->context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::string Sha256::digits() {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digits;
  SHA256End(&state_->context, digits.data());
  return digits.data();
}

namespace {

std::string sha256_of_all(std::span<const fs::path> files) {
  Sha256 hash;
  std::vector<char> block(1 << 16);
  for (const fs::path& file : files) {
    errno = 0;
    InputFile in(file);
    while (in.read(block.data(), std::ssize(block)) || in.gcount() > 0)
      hash.add({block.data(), static_cast<std::size_t>(in.gcount())});
    if (!in.eof())
      throw Error(ErrorCode::bad_mesh, std::string("cannot be read: ") + std::strerror(errno),
                  {file.string()});
  }
  return hash.digits();
}

}  // namespace

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

std::string sha256_of(const fs::path& file) { return sha256_of_all(std::array{file}); }

std::vector<fs::path> files_of_part(const fs::path& file) {
  std::vector<fs::path> files{file};
  if (cad::extension_of(file) != ".gltf" || kind_of_file(file) != FileKind::regular) return files;
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

std::string sha256_of_part(const fs::path& file) { return sha256_of_all(files_of_part(file)); }

}  // namespace bernal
