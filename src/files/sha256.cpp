#include "files/sha256.hpp"

#include <sys/types.h>

#include <sha2.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "bernal/core/error.hpp"
#include "files/input_file.hpp"

namespace bernal {

namespace fs = std::filesystem;

struct Sha256::State {
  SHA2_CTX context;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { SHA256Init(&state_->context); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  SHA256Update(&state_->context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::string Sha256::digits() {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digits;
  SHA256End(&state_->context, digits.data());
  return digits.data();
}

std::string sha256_of_bytes(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digits();
}

std::string sha256_of(const fs::path& file) { return sha256_of(std::array{file}); }

std::string sha256_of(std::span<const fs::path> files) {
  Sha256 hash;
  std::vector<char> block(1 << 16);
  for (const fs::path& file : files) {
    errno = 0;
    InputFile in(file);
    while (in.read(block.data(), std::ssize(block)) || in.gcount() > 0)
      hash.add({block.data(), static_cast<std::size_t>(in.gcount())});
    if (!in.eof())
      throw Error(ErrorCode::bad_mesh, std::string("cannot be read: ") + std::strerror(errno),
                  {file.string()});
  }
  return hash.digits();
}

}  // namespace bernal
