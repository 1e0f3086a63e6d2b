#include <algorithm>

#include <fmt/format.h>

#include "import/foreign_lines.hpp"

namespace bernal {
namespace {

/// `model domain extent xl xh yl yh [zl zh] condition periodic …`
FileBox domain_extent(std::span<const std::string_view> words, const ForeignLines& lines) {
  FileBox box;
  std::size_t at = 3;
  while (at + 1 < words.size() && is_number(words[at])) {
    box.lower.push_back(lines.number(words[at], "extent"));
    box.upper.push_back(lines.number(words[at + 1], "extent"));
    at += 2;
  }
  if (box.lower.size() != 2 && box.lower.size() != 3)
    lines.fail("the extent has not two numbers for each axis");
  box.ends.assign(box.lower.size(), AxisEnd::wall);
  if (at < words.size() && words[at] == "condition")
    for (std::size_t k = 0; k < box.ends.size() && ++at < words.size(); ++k)
      if (words[at] == "periodic") box.ends[k] = AxisEnd::period;
  return box;
}

FileContents read_pfc(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  std::size_t dimension = 3;
  std::vector<std::string_view> words;
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.starts_with(';')) {
      if (!contents.unit) contents.unit = unit_in_title(line);
      continue;
    }
    split_at(line.substr(0, line.find(';')), " \t(),", words);
    if (words.size() > 3 && words[0] == "model" && words[1] == "domain" && words[2] == "extent") {
      contents.box = domain_extent(words, lines);
      dimension = contents.box->lower.size();
      if (contents.size() == 0) contents.spheres = Spheres<dynamic>(static_cast<int>(dimension));
    }
    if (words.size() < 3 || words[0] != "ball" || words[1] != "create") continue;
    const auto radius = std::ranges::find(words, "radius"), place = std::ranges::find(words, "position");
    if (words.end() - radius < 2 || words.end() - place < static_cast<std::ptrdiff_t>(dimension) + 1)
      lines.fail(fmt::format("a ball needs \"radius\" with a number and \"position\" with {}", dimension));
    SphereColumns columns{.size = static_cast<std::size_t>(radius - words.begin()) + 1};
    for (std::size_t k = 0; k < contents.spheres.x.size(); ++k) {
      columns.x.push_back(static_cast<std::size_t>(place - words.begin()) + 1 + k);
      columns.names.emplace_back("position");
    }
    columns.names.emplace_back("radius");
    add_row(lines, columns, words, contents.spheres);
  }
  if (contents.size() == 0) lines.fail("there is no \"ball create\" in it");
  return contents;
}

}  // namespace

const PackingReader& pfc_reader() {
  static const PackingReader reader{
      .about = {"pfc",
                "Itasca PFC: commands \"ball create\" and \"model domain\"",
                "\"lengths in m\" in a comment, or --unit",
                {}},
      .recognises =
          [](const FileBeginning& file) { return file.has("\nball create ") || file.begins("ball create "); },
      .read = read_pfc};
  return reader;
}

}  // namespace bernal
