#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace bernal {

/// The SHA-256 of bytes that come one after the other.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  /// Of all that came, 64 hexadecimal digits; nothing may come after.
  std::string digits();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256_of_bytes(std::string_view bytes);

/// Of a file's bytes: what `sha256sum` prints. Throws Error{bad_mesh} where the file cannot be read. Cost:
/// reading it, and about 3 ns a byte.
std::string sha256_of(const std::filesystem::path& file);

/// Of the bytes of these one after another: what `cat a b | sha256sum` prints.
std::string sha256_of(std::span<const std::filesystem::path> files);

}  // namespace bernal
