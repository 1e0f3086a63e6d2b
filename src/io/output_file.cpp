#include "io/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {
constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
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
  const std::string why = std::strerror(errno);
  std::filesystem::path known_to_users;
  for (const std::filesystem::path& part : path_)
    if (!part.string().starts_with(staging_prefix)) known_to_users /= part;
  throw Error(ErrorCode::cannot_write, std::string(what) + ": " + why, {known_to_users.string()});
}

}  // namespace bernal
