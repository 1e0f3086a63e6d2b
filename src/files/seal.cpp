#include "files/seal.hpp"

#include <iterator>
#include <system_error>

#include "files/bytes_of_file.hpp"
#include "files/input_file.hpp"
#include "files/sha256.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr std::string_view seal_begins = "bernal wrote this (",
                           seal_ends = ") and writes over it while nobody has changed it";
constexpr std::size_t seal_digits = 16;

std::string seal_of(std::string_view text, std::string_view after) {
  Sha256 digest;
  digest.add(text);
  digest.add(after);
  return digest.digits().substr(0, seal_digits);
}

/// "with bed.stl, 0123456789abcdef"
std::string answer_for(const fs::path& file) {
  return "with " + file.filename().string() + ", " + sha256_of(file).substr(0, seal_digits);
}

/// The end of a file, where the seal stands: most large files have none, and need not be read.
std::string end_of(const fs::path& file) {
  constexpr std::uintmax_t end_with_seal = 1024;
  std::error_code unknown;
  const std::uintmax_t size = fs::file_size(file, unknown);
  InputFile in(file);
  if (unknown || !in) return {};
  if (size > end_with_seal) in.seekg(-static_cast<std::streamoff>(end_with_seal), std::ios::end);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Empty where it has no seal that is whole.
std::string sealed_text_of(const fs::path& file) {
  if (!has_seal(file)) return {};
  std::string text = bytes_of_file(file);
  return is_sealed(text) ? text : std::string();
}

}  // namespace

std::string sealed(std::string text, std::string_view before, std::string_view after) {
  text += before;
  const std::string digits = seal_of(text, after);
  return text.append(seal_begins).append(digits).append(seal_ends).append(after);
}

std::string sealed_script(std::string text, const std::vector<fs::path>& with, std::string_view comment) {
  const std::string line = "\n" + std::string(comment);
  for (const fs::path& file : with) text += line + answer_for(file);
  return sealed(std::move(text), line, "\n");
}

bool is_sealed(std::string_view text) {
  const std::size_t at = text.rfind(seal_begins);
  if (at == text.npos) return false;
  const std::string_view seal = text.substr(at + seal_begins.size());
  return seal.size() >= seal_digits && seal.substr(seal_digits).starts_with(seal_ends) &&
         seal.substr(0, seal_digits) ==
             seal_of(text.substr(0, at), seal.substr(seal_digits + seal_ends.size()));
}

bool has_seal(const fs::path& file) { return end_of(file).find(seal_begins) != std::string::npos; }

bool is_as_bernal_wrote(const fs::path& file, const std::vector<fs::path>& others) {
  if (!sealed_text_of(file).empty()) return true;
  for (const fs::path& other : others) {
    if (other == file) continue;
    const std::string text = sealed_text_of(other);
    std::error_code unknown;
    if (!text.empty() && fs::is_regular_file(file, unknown) && text.find(answer_for(file)) != text.npos)
      return true;
  }
  return false;
}

}  // namespace bernal
