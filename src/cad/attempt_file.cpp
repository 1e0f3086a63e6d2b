#include "cad/attempt_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::cad {
namespace {

/// Stands at the end of what is whole.
constexpr std::uint64_t end_mark = 0x6265726E616C2121;

/// Plain values and arrays of them, one after the other, into a file in memory and out of it.
class SoupWriter {
 public:
  explicit SoupWriter(int file) : file_(file) {}

  template <class T>
  void array(std::span<const T> values) {
    number(values.size());
    bytes(values.data(), values.size_bytes());
  }
  void number(std::uint64_t n) { bytes(&n, sizeof n); }
  void real(double x) { bytes(&x, sizeof x); }
  void text(std::string_view words) { array(std::span(words.data(), words.size())); }

 private:
  void bytes(const void* from, std::size_t size) {
    const char* at = static_cast<const char*>(from);
    while (size > 0) {
      const ssize_t written = ::write(file_, at, size);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) throw std::bad_alloc();
      at += written;
      size -= static_cast<std::size_t>(written);
    }
  }

  int file_;
};

class SoupReader {
 public:
  explicit SoupReader(int file) : file_(file), left_(static_cast<std::uint64_t>(lseek(file, 0, SEEK_END))) {
    lseek(file, 0, SEEK_SET);
  }

  template <class Array>
  Array array() {
    Array values;
    const std::uint64_t size = number();
    if (size > left_ / sizeof(typename Array::value_type)) throw Cut();
    values.resize(size);
    bytes(values.data(), size * sizeof(typename Array::value_type));
    return values;
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    bytes(&n, sizeof n);
    return n;
  }
  double real() {
    double x = 0;
    bytes(&x, sizeof x);
    return x;
  }
  std::string text() { return array<std::string>(); }

  /// What was written is not whole.
  struct Cut {};

 private:
  void bytes(void* to, std::size_t size) {
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

  int file_;
  std::uint64_t left_;
};

void put(SoupWriter& out, const std::optional<FileFacts::Length>& length) {
  out.real(length ? length->metres : 0);
  out.text(length ? length->name : "");
}
std::optional<FileFacts::Length> read_length(SoupReader& in) {
  const double metres = in.real();
  std::string name = in.text();
  if (metres == 0) return {};
  return FileFacts::Length{metres, std::move(name)};
}

}  // namespace

void write_attempt(const ReadAttempt& attempt, int file) {
  SoupWriter out(file);
  out.text(attempt.failure);
  const PolygonSoup& soup = attempt.soup;
  static_assert(sizeof(Vector<3>) == 3 * sizeof(double));
  out.array(std::span(soup.points));
  std::vector<std::uint32_t> corners, indices;
  for (const auto& polygon : soup.polygons) {
    corners.push_back(static_cast<std::uint32_t>(polygon.size()));
    indices.insert(indices.end(), polygon.begin(), polygon.end());
  }
  out.array(std::span<const std::uint32_t>(corners));
  out.array(std::span<const std::uint32_t>(indices));
  out.number(soup.solids.size());
  for (const Solid& solid : soup.solids) {
    out.text(solid.name);
    out.number(solid.first);
  }
  const FileFacts& facts = attempt.facts;
  put(out, facts.unit);
  put(out, facts.written_in);
  out.number(static_cast<unsigned char>(facts.up));
  out.number(facts.deviation.has_value());
  out.real(facts.deviation ? facts.deviation->outside : 0);
  out.real(facts.deviation ? facts.deviation->inside : 0);
  out.number(facts.deflection.has_value());
  out.real(facts.deflection.value_or(0));
  out.number(facts.notes.size());
  for (const std::string& note : facts.notes) out.text(note);
  out.number(end_mark);
}

std::optional<ReadAttempt> read_attempt(int file) try {
  SoupReader in(file);
  ReadAttempt attempt;
  attempt.failure = in.text();
  PolygonSoup& soup = attempt.soup;
  soup.points = in.array<std::vector<Vector<3>>>();
  const auto corners = in.array<std::vector<std::uint32_t>>();
  const auto indices = in.array<std::vector<std::uint32_t>>();
  soup.polygons.reserve(corners.size());
  auto at = indices.begin();
  for (const std::uint32_t count : corners) {
    if (indices.end() - at < static_cast<std::ptrdiff_t>(count)) throw SoupReader::Cut();
    soup.polygons.emplace_back(at, at + count);
    at += count;
  }
  for (std::uint64_t left = in.number(); left > 0; --left) {
    std::string name = in.text();
    soup.solids.push_back({std::move(name), in.number()});
  }
  FileFacts& facts = attempt.facts;
  facts.unit = read_length(in);
  facts.written_in = read_length(in);
  facts.up = static_cast<char>(in.number());
  const bool has_deviation = in.number() != 0;
  const double outside = in.real(), inside = in.real();
  if (has_deviation) facts.deviation = SurfaceDeviation{outside, inside};
  const bool has_deflection = in.number() != 0;
  const double deflection = in.real();
  if (has_deflection) facts.deflection = deflection;
  for (std::uint64_t left = in.number(); left > 0; --left) facts.notes.push_back(in.text());
  if (in.number() != end_mark) throw SoupReader::Cut();
  return attempt;
} catch (const SoupReader::Cut&) {
  return std::nullopt;
}

}  // namespace bernal::cad
