#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "files/descriptor.hpp"

namespace bernal {

/// How the name of a folder begins in which files stand until all of them are written.
inline constexpr std::string_view staging_prefix = ".bernal-staging-";

/// The path that a file of a staging folder will have.
std::filesystem::path as_it_will_be(const std::filesystem::path& path);

/// A new file that is written front to back, every write checked. Nothing is certain before `close` has
/// returned: a full disk may show only there. Throws Error{cannot_write} with the path, where it is on the
/// way to another the one that it will have, and the system's words.
class OutputFile {
 public:
  /// Precondition: the file does not exist. Messages name it as `called`, or as it will be.
  explicit OutputFile(std::filesystem::path path, std::filesystem::path called = {});

  void append(std::string_view bytes);
  /// Hands everything to the disk, so that a rename that follows can never reveal a file without its bytes.
  void close();

 private:
  void flush();
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_, called_;
  std::string buffer_;
  Descriptor file_;
};

}  // namespace bernal
