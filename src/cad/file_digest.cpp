
#include "cad/file_digest.hpp"

#include <sys/types.h>

#include <sha2.h>

#include <cerrno>
#include <cstring>

#include "bernal/core/error.hpp"

namespace bernal {

std::string sha256_of(const std::filesystem::path& file) {
  char digits[SHA256_DIGEST_STRING_LENGTH];
  if (SHA256File(file.c_str(), digits) == nullptr)
    throw Error(ErrorCode::bad_mesh, std::string("cannot be read: ") + std::strerror(errno), {file.string()});
  return digits;
}

}  // namespace bernal
