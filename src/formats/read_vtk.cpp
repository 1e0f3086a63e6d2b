#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "core/csv_lines.hpp"
#include "formats/binary_file.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/sphere_size.hpp"
#include "formats/vtk_points.hpp"

namespace bernal {

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

namespace {

constexpr std::string_view legacy_mark = "# vtk DataFile", xml_mark = "<VTKFile";

/// One number a point: where it stands, and what it is called.
struct PointColumn {
  const std::vector<double>* values;
  std::uint64_t components, component;
  double at(std::uint64_t point) const { return (*values)[point * components + component]; }
};

struct PointColumns {
  std::vector<PointColumn> columns;
  std::vector<std::string> names;

  void add(const std::vector<double>& values, std::uint64_t components, const std::string& name) {
    for (std::uint64_t k = 0; k < components; ++k) {
      columns.push_back({&values, components, k});
      names.push_back(components == 1 ? name : fmt::format("{}:{}", name, k));
    }
  }
};

/// The points' places are called x, y, z, and nothing else is.
PointColumns columns_of(const VtkPoints& points) {
  PointColumns all;
  all.add(points.places, 3, "");
  all.names = {"x", "y", "z"};
  for (const VtkArray& array : points.arrays) {
    const bool is_place = axis_named(array.name).value_or(3) < 3;
    all.add(array.values, array.components, is_place ? fmt::format("array {}", array.name) : array.name);
  }
  return all;
}

/// Into the order of the array "id", where that numbers the spheres.
void sort_by_number(const PointColumns& all, const Reading& reading, Spheres<dynamic>& spheres) {
  const auto found = std::ranges::find_if(
      all.names, [](const std::string& name) { return name == "id" || name == "ID" || name == "Id"; });
  if (found == all.names.end()) return;
  const PointColumn& column = all.columns[static_cast<std::size_t>(found - all.names.begin())];
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

Spheres<dynamic> spheres_at(const PointColumns& all, const SphereColumns& columns, std::uint64_t count,
                            const CsvLines& file) {
  Spheres<dynamic> spheres = columns.no_spheres();
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < columns.x.size(); ++k) {
      const double x = all.columns[columns.x[k]].at(i);
      if (!(std::abs(x) <= farthest_place))
        file.fail(fmt::format("point {}: {} = {} is not finite or beyond {}", i, columns.names[k], x,
                              farthest_place));
      spheres.x[k].push_back(x);
    }
    if (!columns.size) continue;
    const double size = all.columns[*columns.size].at(i);
    if (!is_size(size))
      file.fail(fmt::format("point {}: {}", i, complaint_of_size(size, columns.is_diameter)));
    spheres.r.push_back(columns.is_diameter ? 0.5 * size : size);
  }
  return spheres;
}

FileContents read_vtk(const Reading& reading) {
  BinaryFile bytes(reading.file);
  const std::vector<char> all_bytes = bytes.many<char>(0, bytes.size());
  const std::string_view text(all_bytes.data(), all_bytes.size());
  if (reading.monitor.stop()) throw Cancelled();
  const bool is_legacy = text.substr(0, 64).find(legacy_mark) != text.npos;
  const VtkPoints points = is_legacy ? read_vtk_legacy(text, reading.file) : read_vtk_xml(text, reading.file);
  const CsvLines file(reading.file);
  if (points.size() == 0) file.fail("there are no points in it");
  const PointColumns all = columns_of(points);
  SphereColumns columns = sphere_columns(reading.options.columns, all.names, file);
  if (!columns.size && !reading.options.diameter && !reading.options.radius) {
    const std::vector<std::string> arrays(all.names.begin() + 3, all.names.end());
    file.fail(arrays.empty()
                  ? "has points without data, and so no sizes; give --diameter or --radius"
                  : fmt::format(
                        "has for its points {}, none of which is called radius or diameter; say which is the "
                        "size, such as --columns x,y,z,r={}, or give --diameter or --radius",
                        bernal::quoted(fmt::format("{}", fmt::join(arrays, " "))), arrays.front()));
  }
  FileContents contents{.spheres = spheres_at(all, columns, points.size(), file)};
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

const PackingReader& vtk_reader() {
  static const PackingReader reader{
      .about = {"vtk",
                "VTK's points with radii, .vtk, .vtp and .vtu: ParaView, LIGGGHTS, YADE, MFiX, bernal's "
                "spheres.vtp; "
                "arrays called radius, radii or r, diameter or d, or another by --columns x,y,z,r=NAME",
                "\"lengths in mm\" in its title or a comment, or --unit",
                {"columns"}},
      .recognises = [](const FileBeginning& file) { return file.begins(legacy_mark) || file.has(xml_mark); },
      .read = read_vtk};
  return reader;
}

}  // namespace bernal
