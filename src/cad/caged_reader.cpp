#include "cad/caged_reader.hpp"

#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bernal::cad {
namespace {

void put(PlainWriter& out, const std::optional<FileFacts::Length>& length) {
  out.real(length ? length->metres : 0);
  out.text(length ? length->name : "");
}
std::optional<FileFacts::Length> read_length(PlainReader& in) {
  const double metres = in.real();
  std::string name = in.text();
  if (metres == 0) return {};
  return FileFacts::Length{metres, std::move(name)};
}

void put(PlainWriter& out, const ReadAttempt& attempt) {
  out.text(attempt.failure);
  const PolygonSoup& soup = attempt.soup;
  out.points(soup.points);
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
}

ReadAttempt read_attempt(PlainReader& in) {
  ReadAttempt attempt;
  attempt.failure = in.text();
  PolygonSoup& soup = attempt.soup;
  soup.points = in.points();
  const auto corners = in.array<std::vector<std::uint32_t>>();
  const auto indices = in.array<std::vector<std::uint32_t>>();
  soup.polygons.reserve(corners.size());
  auto at = indices.begin();
  for (const std::uint32_t count : corners) {
    if (indices.end() - at < static_cast<std::ptrdiff_t>(count)) throw PlainReader::Cut();
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
  return attempt;
}

}  // namespace

CageLimits cage_limits(std::uint64_t file_size) {
  const auto size = static_cast<double>(file_size);
  return {(std::uint64_t{1} << 30U) + 100 * file_size, 5 + size / 1e6};
}

ReadAttempt read_in_cage(std::string_view reader, const CageLimits& limits,
                         const std::function<ReadAttempt()>& read) {
  const auto attempt_of = [&] {
    ReadAttempt made = read();
    if (made.failure.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    return made;
  };
  ReadAttempt attempt;
  std::string befell = run_in_cage(
      reader, limits, [&](PlainWriter& out) { put(out, attempt_of()); },
      [&](PlainReader& in) { attempt = read_attempt(in); });
  if (!befell.empty()) return {.failure = std::move(befell)};
  return attempt;
}

}  // namespace bernal::cad
