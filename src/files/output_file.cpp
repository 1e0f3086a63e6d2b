#include "files/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {
constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
}

std::filesystem::path as_it_will_be(const std::filesystem::path& path) {
  std::filesystem::path without;
  for (const std::filesystem::path& part : path)
    if (!part.string().starts_with(staging_prefix)) without /= part;
  return without;
}

OutputFile::OutputFile(std::filesystem::path path, std::filesystem::path called)
    : path_(std::move(path)), called_(called.empty() ? as_it_will_be(path_) : std::move(called)) {
  file_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file_.is_open()) fail("cannot be created");
}

void OutputFile::append(std::string_view bytes) {
  buffer_ += bytes;
  if (buffer_.size() >= buffer_bytes) flush();
}

void OutputFile::close() {
  flush();
  if (::fsync(file_.number()) != 0 || !file_.close()) fail("cannot be written");
}

void OutputFile::flush() {
  if (!file_.write(buffer_)) fail("cannot be written");
  buffer_.clear();
}

void OutputFile::fail(const char* what) const {
  throw Error(ErrorCode::cannot_write, std::string(what) + ": " + std::strerror(errno), {called_.string()});
}

}  // namespace bernal
