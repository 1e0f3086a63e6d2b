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
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be created");
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::append(std::string_view bytes) {
  buffer_ += bytes;
  if (buffer_.size() >= buffer_bytes) flush();
}

void OutputFile::close() {
  flush();
  if (::fsync(descriptor_) != 0) fail("cannot be written");
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail("cannot be written");
}

void OutputFile::flush() {
  const char* next = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0) {
    const ssize_t written = ::write(descriptor_, next, left);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    next += written;
    left -= static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void OutputFile::fail(const char* what) const {
  throw Error(ErrorCode::cannot_write, std::string(what) + ": " + std::strerror(errno), {called_.string()});
}

}  // namespace bernal
