#include "cad/plain_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <new>

namespace bernal::cad {

void PlainWriter::bytes(const void* from, std::size_t size) {
  const char* at = static_cast<const char*>(from);
  while (size > 0) {
    const ssize_t written = ::write(file_, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::bad_alloc();
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

PlainReader::PlainReader(int file)
    : file_(file), left_(static_cast<std::uint64_t>(lseek(file, 0, SEEK_END))) {
  lseek(file, 0, SEEK_SET);
}

void PlainReader::bytes(void* to, std::size_t size) {
  char* at = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t got = ::read(file_, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Cut();
    at += got;
    size -= static_cast<std::size_t>(got);
    left_ -= static_cast<std::uint64_t>(got);
  }
}

}  // namespace bernal::cad
