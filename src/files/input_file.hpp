#pragma once
#include <filesystem>
#include <fstream>
#include <istream>

namespace bernal {

/// Opens a regular file to be read, through links. Nothing else is opened, and nothing is waited for: a pipe
/// that nobody writes into, or one that takes the place of a file meanwhile, is refused. Returns whether it
/// is open; where not, errno says why.
bool open_to_read(std::filebuf& bytes, const std::filesystem::path& file);

/// A regular file as a stream, opened so; one that cannot be opened is a stream that has failed.
class InputFile : public std::istream {
 public:
  InputFile() : std::istream(nullptr) {}
  explicit InputFile(const std::filesystem::path& file) : InputFile() { open(file); }

  void open(const std::filesystem::path& file) {
    open_to_read(bytes_, file) ? rdbuf(&bytes_) : rdbuf(nullptr);  // which clears the state, or sets it
  }

 private:
  std::filebuf bytes_;
};

}  // namespace bernal
