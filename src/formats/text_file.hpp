#pragma once
#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <cstring>
#include <span>
#include <string_view>

#include "core/parallel.hpp"
#include "files/output_file.hpp"

namespace bernal {

/// A file of numbers and words. Doubles are the shortest decimals that read back as the same. Cost: about 50
/// ns a number. As with OutputFile, nothing is certain before `close` has returned. Throws Cancelled if an
/// Interruptible says stop.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path) : file_(path) {}

  /// Appends the values one after the other.
  template <class... T>
  void add(const T&... values) {
    (put(values), ...);
  }
  void close() {
    flush();
    file_.close();
  }

 private:
  static constexpr std::size_t longest_number = 32;  // a shortest double has up to 24 characters

  void put(std::string_view text) {
    if (text.size() > room()) flush();
    if (text.size() > room()) return file_.append(text);
    std::memcpy(end_, text.data(), text.size());
    end_ += text.size();
  }
  void put(char c) { put(std::string_view(&c, 1)); }
  template <class T>
  requires(std::floating_point<T> || (std::integral<T> && !std::same_as<T, char>)) void put(T value) {
    if (room() < longest_number) flush();
    end_ = std::to_chars(end_, buffer_.data() + buffer_.size(), value).ptr;
  }

  std::size_t room() const { return static_cast<std::size_t>(buffer_.data() + buffer_.size() - end_); }
  void flush() {
    throw_if_interrupted();
    file_.append({buffer_.data(), static_cast<std::size_t>(end_ - buffer_.data())});
    end_ = buffer_.data();
  }

  OutputFile file_;
  std::array<char, 1 << 14> buffer_;
  char* end_ = buffer_.data();
};

static_assert(std::endian::native == std::endian::little,
              "binary files are written as numbers lie in memory");

/// Numbers as in memory.
template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <class T>
void append_bytes(OutputFile& out, const T& value) {
  out.append(bytes_of(std::span(&value, 1)));
}
template <class T>
void append_bytes(OutputFile& out, std::span<const T> values) {
  out.append(bytes_of(values));
}

}  // namespace bernal
