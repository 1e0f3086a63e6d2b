#include <utility>

#include <fmt/format.h>

#include "formats/foreign_lines.hpp"

namespace bernal {
namespace {

constexpr std::string_view ball_mark = "sphere{<", swap_mark = "y and z have changed places";

/// Of scenes that bernal wrote: a sphere of the packing has a line, and no blank after its word.
FileContents read_povray(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  bool is_swapped = false;
  const SphereColumns columns{.x = {0, 1, 2}, .size = 3, .names = {"x", "y", "z", "radius"}};
  std::vector<std::string_view> parts;
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.starts_with("//")) {
      is_swapped = is_swapped || line.find(swap_mark) != line.npos;
      lines.take_unit_remark(contents.unit);
    }
    if (!line.starts_with(ball_mark)) continue;
    split_at(line.substr(ball_mark.size()), "<,> ", parts);
    add_row(lines, columns, parts, contents.spheres);
  }
  if (contents.size() == 0)
    lines.fail("there is no sphere of a packing in it; only scenes that bernal wrote are read");
  if (is_swapped) std::swap(contents.spheres.x[1], contents.spheres.x[2]);
  return contents;
}

}  // namespace

const PackingReader& povray_reader() {
  static const PackingReader reader{
      .about = {"povray", "POV-Ray scenes that bernal wrote", "\"lengths in mm\" in its first line", {}},
      .recognises =
          [](const FileBeginning& file) { return file.begins("// bernal ") && file.has(swap_mark); },
      .read = read_povray};
  return reader;
}

}  // namespace bernal
