#include <algorithm>

#include <fmt/format.h>

#include "files/csv_lines.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

void write_pfc(const Exported& file, TextFile& out) {
  const int dimension = file.dimension();
  const Bounds<3> box = file.box();
  const auto periodic = file.periods();
  out.add("; ", file.title(), "; lengths in ", name_of(file.unit()), "\n; PFC", dimension,
          "D 6 or later: model new, then program call '", file.name(), "'\n");
  out.add("model domain extent");
  for (int k = 0; k < dimension; ++k) out.add(' ', box.lower[k], ' ', box.upper[k]);
  out.add(" condition");
  for (int k = 0; k < dimension; ++k) out.add(periodic[static_cast<std::size_t>(k)] ? " periodic" : " stop");
  out.add('\n');
  for (std::size_t i = 0; i < file.size(); ++i) {
    out.add("ball create id ", i + 1, " radius ", file.spheres.r[i], " position");
    for (int k = 0; k < dimension; ++k) out.add(' ', file.coordinate(k, i));
    if (file.type_count > 1) out.add(" group 'type_", file.types[i], "'");
    out.add('\n');
  }
  out.add("ball attribute density ", file.density(), '\n');
  for (std::uint32_t type = 1; type <= file.type_densities.size() && file.type_count > 1; ++type)
    out.add("ball attribute density ", file.density_of(type), " range group 'type_", type, "'\n");
}

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
  if (at == words.size()) return box;
  if (words[at] != "condition")
    lines.fail(fmt::format("{} is not understood; condition is expected behind the extent, or nothing",
                           bernal::quoted(words[at])));
  const std::size_t said = words.size() - at - 1;
  if (said != 1 && said != box.ends.size())
    lines.fail("one condition is expected, for all axes, or one for each");
  for (std::size_t k = 0; k < box.ends.size(); ++k) {
    const std::string_view word = words[at + 1 + (said == 1 ? 0 : k)];
    if (word == "periodic") {
      box.ends[k] = AxisEnd::period;
    } else if (word != "stop" && word != "reflect" && word != "destroy") {
      lines.fail(fmt::format("{} is no condition; stop, reflect, destroy and periodic are known",
                             bernal::quoted(word)));
    }
  }
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
      lines.take_unit_remark(contents.unit);
      continue;
    }
    split_at(line.substr(0, line.find(';')), " \t(),", words);
    if (words.size() > 1 && words[0] == "model" && words[1] == "domain") {
      if (words.size() < 4 || words[2] != "extent")
        lines.fail("\"model domain extent\" with two numbers for each axis is expected, then the condition");
      if (contents.box) lines.fail("a second \"model domain\"; leave one of them in the file");
      contents.box = domain_extent(words, lines);
      dimension = contents.box->lower.size();
      if (contents.size() == 0) contents.spheres = Spheres<dynamic>(static_cast<int>(dimension));
    }
    if (words.empty() || words[0] != "ball") continue;
    for (const std::string_view other : {"generate", "distribute", "delete", "import"})
      if (words.size() > 1 && words[1] == other)
        lines.fail(
            fmt::format("\"ball {}\" makes or takes balls in a way that only PFC knows; save them from it as "
                        "\"ball create\", or as a table",
                        other));
    if (words.size() < 2 || words[1] != "create") continue;
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

Format pfc_format() {
  return {
      .name = "pfc",
      .writes = "Itasca PFC 6 or later, commands for program call",
      .keys = {"material_density", "density", "types"},
      .file = "pfc.dat",
      .least_dimension = 2,
      .unit = Unit::m,
      .write_text = write_pfc,
      .reads = "Itasca PFC: commands \"ball create\" and \"model domain\"",
      .unit_from = "\"lengths in m\" in a comment, or ‹unit›",
      .recognises =
          [](const FileBeginning& file) { return file.has("\nball create ") || file.begins("ball create "); },
      .read = read_pfc};
}

}  // namespace bernal
