#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/csv_lines.hpp"
#include "core/file_kind.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/numpy_array.hpp"
#include "formats/sphere_size.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse_array(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorCode::bad_packing, why, {file.string()});
}

/// "centers_radii.npy" beside "centers.npy", as bernal and scripts for OpenMC call it.
std::filesystem::path radii_beside(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + "_radii.npy");
}

void add_length(const std::filesystem::path& file, std::uint64_t row, double length, bool is_diameter,
                Spheres<dynamic>& spheres) {
  if (!is_size(length))
    refuse_array(file, fmt::format("row {}: {}", row + 1, complaint_of_size(length, is_diameter)));
  spheres.r.push_back(is_diameter ? 0.5 * length : length);
}

/// x, y, z, r or x, y, z, unless the words say another.
SphereColumns array_columns(const Reading& reading, const NumpyArray& array) {
  if (array.is_list)
    refuse_array(reading.file, "has one dimension; rows of x, y, z or x, y, z, r are expected");
  if (!reading.options.columns.empty()) {
    std::vector<std::string> names;
    for (std::uint64_t k = 0; k < array.columns; ++k) names.push_back(fmt::format("column {}", k + 1));
    return sphere_columns(reading.options.columns, names, CsvLines(reading.file));
  }
  if (array.columns != 3 && array.columns != 4)
    refuse_array(reading.file, fmt::format("has {} columns; say what they are, such as --columns {}",
                                           array.columns, array.columns == 2 ? "x,y" : "x0,x1,x2,x3,r"));
  SphereColumns columns{.x = {0, 1, 2}, .names = {"column 1", "column 2", "column 3"}};
  if (array.columns == 4) {
    columns.size = 3;
    columns.names.emplace_back("column 4");
  }
  return columns;
}

void read_radii(const std::filesystem::path& file, std::uint64_t rows, Spheres<dynamic>& spheres) {
  const NumpyArray array = read_numpy_array(file);
  if (array.columns != 1)
    refuse_array(file, fmt::format("has {} columns; one radius a row is expected", array.columns));
  if (array.rows != rows)
    refuse_array(file, fmt::format("has {} radii, and there are {} centres", array.rows, rows));
  for (std::uint64_t i = 0; i < rows; ++i) add_length(file, i, array.at(i, 0), false, spheres);
}

FileContents read_npy(const Reading& reading) {
  const NumpyArray array = read_numpy_array(reading.file);
  const SphereColumns columns = array_columns(reading, array);
  FileContents contents{.spheres = columns.no_spheres()};
  for (std::uint64_t i = 0; i < array.rows; ++i) {
    for (std::size_t k = 0; k < columns.x.size(); ++k) {
      const double x = array.at(i, columns.x[k]);
      if (!(std::abs(x) <= farthest_place))
        refuse_array(reading.file, fmt::format("row {}: {} = {} is not finite or beyond {}", i + 1,
                                               columns.names[k], x, farthest_place));
      contents.spheres.x[k].push_back(x);
    }
    if (columns.size)
      add_length(reading.file, i, array.at(i, *columns.size), columns.is_diameter, contents.spheres);
  }
  contents.note = columns.in_words();
  const bool has_own = reading.options.diameter || reading.options.radius;
  const std::filesystem::path beside = reading.options.radii.value_or(radii_beside(reading.file));
  if (reading.options.radii && columns.size)
    throw Error(ErrorCode::bad_argument, "the file has sizes of its own; leave --radii out");
  if (reading.options.radii || (!columns.size && !has_own && kind_of_file(beside) == FileKind::regular)) {
    read_radii(beside, array.rows, contents.spheres);
    contents.note += fmt::format(", radii of {}", bernal::quoted(beside.filename().string()));
  }
  return contents;
}

FileContents read_openmc(const Reading& reading) {
  FileContents contents = read_npy(reading);
  contents.unit = reading.options.unit.value_or(Unit::cm);
  return contents;
}

bool is_npy(const FileBeginning& file) { return file.begins(numpy_magic); }

}  // namespace

const PackingReader& openmc_reader() {
  static const PackingReader reader{
      .about = {"openmc",
                "OpenMC centres, .npy of N x 3, with FILE_radii.npy beside them, --radii or --radius",
                "cm",
                {"columns", "radii"}},
      .recognises =
          [](const FileBeginning& file) {
            return is_npy(file) && kind_of_file(radii_beside(file.file)) == FileKind::regular;
          },
      .read = read_openmc};
  return reader;
}

const PackingReader& npy_reader() {
  static const PackingReader reader{.about = {"npy",
                                              "NumPy array, a row x, y, z, r for each sphere, or x, y, z",
                                              "--unit",
                                              {"columns", "radii"}},
                                    .recognises = is_npy,
                                    .read = read_npy};
  return reader;
}

}  // namespace bernal
