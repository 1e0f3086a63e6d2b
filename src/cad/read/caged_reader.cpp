#include "cad/read/caged_reader.hpp"

#include <new>
#include <string>
#include <utility>

#include "geometry/archive_surface.hpp"

namespace bernal::cad {

void archive(Archive& a, Solid& solid) { a(solid.name, solid.first); }
void archive(Archive& a, PolygonSoup& soup) { a(soup.points, soup.polygons, soup.solids); }
void archive(Archive& a, FileFacts::Length& length) { a(length.metres, length.name); }
void archive(Archive& a, SurfaceDeviation& deviation) { a(deviation.outside, deviation.inside); }
void archive(Archive& a, FileFacts& facts) {
  a(facts.unit, facts.written_in, facts.up, facts.deviation, facts.deflection, facts.notes);
}
CageLimits cage_limits(std::uint64_t file_size) {
  const auto size = static_cast<double>(file_size);
  return {(std::uint64_t{1} << 30U) + 100 * file_size, 5 + size / 1e6};
}

ReadAttempt read_in_cage(std::string_view reader, const CageLimits& limits,
                         const std::function<ReadAttempt()>& read) {
  ReadAttempt attempt;
  std::string befell = run_in_cage(
      reader, limits,
      [&] {
        attempt = read();
        if (attempt.failure.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
      },
      [&](Archive& a) {
        a(attempt.soup, attempt.failure, attempt.facts, attempt.failed_option, attempt.surface);
      });
  if (!befell.empty()) return {.failure = std::move(befell)};
  return attempt;
}

}  // namespace bernal::cad
