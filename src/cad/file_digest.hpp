#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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

/// The SHA-256 of a file's bytes, 64 hexadecimal digits: what `sha256sum` prints. Throws Error{bad_mesh}
/// where the file cannot be read. Cost: reading it, and about 3 ns a byte.
std::string sha256_of(const std::filesystem::path& file);

/// "a%20b.bin" as "a b.bin".
std::string percent_decoded(std::string_view text);

/// The files that hold a part: the one given, then the buffers beside it that a glTF names, in its order, as
/// they are written or percent-encoded, or the STEP files beside it that a STEP file names, and these again.
std::vector<std::filesystem::path> files_of_part(const std::filesystem::path& file);

/// Of the bytes of these one after another: what `cat part.gltf part.bin | sha256sum` prints.
std::string sha256_of_part(const std::filesystem::path& file);

}  // namespace bernal
