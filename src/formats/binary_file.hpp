#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {

/// A file that is read by places, each of which is held against its length before anything is allocated.
class BinaryFile {
 public:
  explicit BinaryFile(const std::filesystem::path& file) : name_(file.string()), in_(file, std::ios::binary) {
    std::error_code problem;
    size_ = std::filesystem::file_size(file, problem);
    if (!in_ || problem) fail("cannot be read");
  }

  std::uint64_t size() const { return size_; }
  /// Whether so many parts of so many bytes stand there.
  bool holds(std::uint64_t at, std::uint64_t parts, std::uint64_t bytes) const {
    return at <= size_ && (bytes == 0 || parts <= (size_ - at) / bytes);
  }
  void read(std::uint64_t at, void* to, std::uint64_t bytes) {
    if (!holds(at, bytes, 1))
      fail(fmt::format("ends after {} bytes, in the middle of what it says it has; was it cut off?", size_));
    if (bytes == 0) return;
    in_.seekg(static_cast<std::streamoff>(at));
    in_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
    if (!in_) fail("cannot be read to its end");
  }
  template <class T>
  T get(std::uint64_t at) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    read(at, &value, sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> many(std::uint64_t at, std::uint64_t count) {
    if (!holds(at, count, sizeof(T)))
      fail(fmt::format("ends after {} bytes, in the middle of what it says it has; was it cut off?", size_));
    std::vector<T> values(count);
    read(at, values.data(), count * sizeof(T));
    return values;
  }
  [[noreturn]] void fail(const std::string& why) const { throw Error(ErrorCode::bad_packing, why, {name_}); }

 private:
  std::string name_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

}  // namespace bernal
