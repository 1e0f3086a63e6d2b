#include <fmt/format.h>

#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// Readers of this format accept no comments, so the file does not state the unit.
void write_esys(const Exported& file, TextFile& out) {
  const Bounds<3> box = file.box();
  out.add("LSMGeometry 1.2\nBoundingBox ", row_of(box.lower), ' ', row_of(box.upper), "\nPeriodicBoundaries ",
          file.periods_as("1", "0"), "\nDimension ", file.dimension(), "D\nBeginParticles\nSimple\n",
          file.size(), '\n');
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(file.coordinate(0, i), ' ', file.coordinate(1, i), ' ', file.coordinate(2, i), ' ',
            file.spheres.r[i], ' ', i, ' ', file.types[i], '\n');
  out.add("EndParticles\nBeginConnect\n0\nEndConnect\n");
}

/// The words of the file, across lines.
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
  const SphereColumns columns = columns_xyzr();
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
    lines.refuse_more("the file", claimed, "below \"Simple\"");
  }
  contents.box = std::move(box);
  return contents;
}

}  // namespace

Format esys_format() {
  return {.name = "esys",
          .writes = "ESyS-Particle geometry, LSMGeometry 1.2, for readGeometry",
          .keys = {"unit", "types"},
          .file = "esys.geo",
          .least_dimension = 2,
          .write_text = write_esys,
          .reads = "ESyS-Particle and GenGeo geometry, LSMGeometry",
          .unit_from = "‹unit›",
          .recognises = [](const FileBeginning& file) { return file.begins("LSMGeometry"); },
          .read = read_esys};
}

}  // namespace bernal
