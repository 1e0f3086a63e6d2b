#include <array>

#include <fmt/format.h>

#include "core/csv_headings.hpp"
#include "formats/foreign_lines.hpp"

namespace bernal {
namespace {

/// The words of the file, one line after the other.
class EsysWords {
 public:
  explicit EsysWords(ForeignLines& lines) : lines_(lines) {}

  std::string next(std::string_view what) {
    while (at_ == words_.size()) {
      lines_.require_next(what);
      const auto found = lines_.words();
      words_.assign(found.begin(), found.end());
      at_ = 0;
    }
    return words_[at_++];
  }
  double number(std::string_view what) {
    const std::string word = next(what);
    return lines_.number(word, what);
  }
  void expect(std::string_view word) {
    if (const std::string found = next(word); found != word)
      lines_.fail(fmt::format("expected {}, found {}", word, bernal::quoted(found)));
  }

 private:
  ForeignLines& lines_;
  std::vector<std::string> words_;
  std::size_t at_ = 0;
};

FileContents read_esys(const Reading& reading) {
  ForeignLines lines(reading);
  EsysWords words(lines);
  FileContents contents;
  FileBox box;
  words.expect("LSMGeometry");
  words.next("the version");
  words.expect("BoundingBox");
  for (std::vector<double>* bound : {&box.lower, &box.upper})
    for (int k = 0; k < 3; ++k) bound->push_back(words.number("BoundingBox"));
  words.expect("PeriodicBoundaries");
  for (int k = 0; k < 3; ++k) {
    const double repeats = words.number("PeriodicBoundaries");
    if (repeats != 0 && repeats != 1) lines.fail("PeriodicBoundaries are three of 0 and 1");
    box.ends.push_back(repeats == 1 ? AxisEnd::period : AxisEnd::wall);
  }
  words.expect("Dimension");
  const std::string dimension = words.next("Dimension");
  if (dimension != "2D" && dimension != "3D")
    lines.fail(fmt::format("Dimension is {}; 2D and 3D are known", bernal::quoted(dimension)));
  contents.is_flat = dimension == "2D";
  words.expect("BeginParticles");
  words.expect("Simple");
  const std::string count = words.next("the number of particles");
  const std::uint64_t claimed = lines.whole(count, "the number of particles");
  const SphereColumns columns{.x = {0, 1, 2}, .size = 3, .names = {"x", "y", "z", "radius"}};
  for (std::uint64_t i = 0; i < claimed; ++i) {
    lines.require_next("a particle");
    const auto row = lines.words();
    if (!row.empty() && row[0] == "EndParticles") lines.expect_rows(claimed, i);
    add_row(lines, columns, row, contents.spheres);
  }
  for (bool is_past_end = false; lines.next();) {
    const auto row = lines.words();
    if (row.empty()) continue;
    if (row[0] == "BeginParticles")
      lines.fail("a second section BeginParticles; only one is read, so take one of them out");
    is_past_end = is_past_end || row[0] == "EndParticles";
    if (is_past_end) continue;
    lines.fail(
        fmt::format("the file says that it has {} spheres, and here is more; if it is a sphere, correct "
                    "the number below \"Simple\", else take the line out",
                    claimed));
  }
  contents.box = std::move(box);
  return contents;
}

}  // namespace

const PackingReader& esys_reader() {
  static const PackingReader reader{
      .about = {"esys", "ESyS-Particle and GenGeo geometry, LSMGeometry", "--unit", {}},
      .recognises = [](const FileBeginning& file) { return file.begins("LSMGeometry"); },
      .read = read_esys};
  return reader;
}

}  // namespace bernal
