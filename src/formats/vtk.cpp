#include "formats/vtk.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "files/bytes_of_file.hpp"
#include "files/csv_lines.hpp"
#include "formats/foreign_lines.hpp"

namespace bernal {
namespace {

constexpr std::string_view legacy_mark = "# vtk DataFile", xml_mark = "<VTKFile";

/// The coordinates of the points are named x, y, z, other columns keep their names.
NumberTable columns_of(const VtkPoints& points) {
  NumberTable all;
  all.add(points.places, 3, "");
  all.names = {"x", "y", "z"};
  for (const VtkArray& array : points.arrays) {
    const bool is_place = axis_named(array.name).value_or(3) < 3;
    all.add(array.values, array.components, is_place ? fmt::format("array {}", array.name) : array.name);
  }
  return all;
}

/// Sorts by the array "id", if that numbers the spheres.
void sort_by_number(const NumberTable& all, const Reading& reading, Spheres<dynamic>& spheres) {
  const auto found = std::ranges::find_if(
      all.names, [](const std::string& name) { return name == "id" || name == "ID" || name == "Id"; });
  if (found == all.names.end()) return;
  const NumberTable::Column& column = all.columns[static_cast<std::size_t>(found - all.names.begin())];
  constexpr double largest_whole = 9007199254740992;
  Identities identities;
  for (std::uint64_t i = 0; i < spheres.size(); ++i) {
    const double id = column.at(i);
    if (!(id >= 0 && id <= largest_whole && id == std::floor(id))) return;
    identities.id.push_back(static_cast<std::uint64_t>(id));
  }
  identities.what = "point";
  for (std::size_t i = 1; i <= identities.id.size(); ++i) identities.line.push_back(static_cast<int>(i));
  identities.sort(spheres, reading);
}

FileContents read_vtk(const Reading& reading) {
  const std::string text = bytes_of_file(reading.file);
  if (reading.monitor.stop()) throw Cancelled();
  const bool is_legacy = text.find(legacy_mark) < 64;
  const VtkPoints points = is_legacy ? read_vtk_legacy(text, reading.file) : read_vtk_xml(text, reading.file);
  const CsvLines file(reading.file);
  if (points.size() == 0) file.fail("there are no points in it");
  const NumberTable all = columns_of(points);
  SphereColumns columns = sphere_columns(reading.options.columns, all.names, file);
  if (!columns.size && !reading.has_size()) {
    const std::vector<std::string> arrays(all.names.begin() + 3, all.names.end());
    file.fail(arrays.empty()
                  ? "has points without data, and so no sizes; give ‹diameter› or ‹radius›"
                  : fmt::format(
                        "has for its points {}, none of which is called radius or diameter; say which is the "
                        "size, such as ‹columns=x,y,z,r={}›, or give ‹diameter› or ‹radius›",
                        bernal::quoted(fmt::format("{}", fmt::join(arrays, " "))), arrays.front()));
  }
  FileContents contents{.spheres = all.spheres(columns, points.size(), "point", 0, reading)};
  sort_by_number(all, reading, contents.spheres);
  take_unit_of_remark(points.remarks, contents.unit, {reading.file.string(), 2});
  for (const std::string_view clause : clauses_of(points.remarks))
    contents.is_flat |= clause == "dimension 2";
  contents.note = columns.size
                      ? fmt::format("{}, {} {}", points.kind, columns.is_diameter ? "diameter" : "radius",
                                    bernal::quoted(columns.names.back()))
                      : points.kind;
  return contents;
}

}  // namespace

std::optional<double> number_in_text(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [stop, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (stop != word.data() + word.size() || problem == std::errc::invalid_argument) return {};
  if (problem == std::errc{}) return value;
  return word.find("e-") != word.npos || word.find("E-") != word.npos
             ? 0
             : std::numeric_limits<double>::infinity();
}

std::string faces_error(std::uint64_t count) {
  return fmt::format(
      "the points are the corners of {} faces or solids, and no centres of spheres; save the particles as "
      "points, before a filter such as Glyph makes surfaces of them",
      count);
}

std::string type_error(std::string_view type) {
  return fmt::format("numbers of the type {} are not known; save float or double", bernal::quoted(type));
}

Format vtk_format() {
  return {
      .name = "vtk",
      .reads =
          "VTK's points with radii, .vtk, .vtp and .vtu: ParaView, LIGGGHTS, YADE, MFiX, bernal's "
          "spheres.vtp; "
          "arrays called radius, radii or r, diameter or d, or another by ‹columns=x,y,z,r=NAME›",
      .unit_from = "\"lengths in mm\" in its title or a comment, or ‹unit›",
      .options = {"columns"},
      .recognises = [](const FileBeginning& file) { return file.begins(legacy_mark) || file.has(xml_mark); },
      .read = read_vtk};
}

}  // namespace bernal
