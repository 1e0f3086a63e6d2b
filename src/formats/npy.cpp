#include "formats/npy.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/parallel.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "files/npy_file.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {

void write_npy(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               const std::function<double(std::size_t, std::size_t)>& value) {
  OutputFile out(path);
  out.append(npy_header(rows, columns));
  std::vector<double> row(std::max<std::size_t>(columns, 1));
  for (std::size_t i = 0; i < rows; ++i) {
    throw_if_interrupted();
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = value(i, k);
    append_bytes(out, std::span<const double>(row));
  }
  out.close();
}

namespace {

void write_columns(const Exported& file, StagedFolder& staged) {
  const std::size_t dimension = file.spheres.x.size();
  write_npy(
      staged.add(file.output.file.string()), file.size(), dimension + 1,
      [&](std::size_t i, std::size_t k) { return k < dimension ? file.spheres.x[k][i] : file.spheres.r[i]; });
}

/// A whole array, column by column.
std::vector<std::vector<double>> columns_in(NpyFile& array) {
  std::vector<std::vector<double>> columns(array.columns(), std::vector<double>(array.rows()));
  array.read([&](std::size_t k, std::size_t first, std::span<const double> values) {
    std::ranges::copy(values, columns[k].begin() + static_cast<std::ptrdiff_t>(first));
  });
  return columns;
}

/// x, y, z, r or x, y, z, unless the options say otherwise.
SphereColumns array_columns(const Reading& reading, const NpyFile& array,
                            const std::vector<std::string>& names) {
  if (array.is_list()) array.fail("has one dimension; rows of x, y, z or x, y, z, r are expected");
  if (!reading.options.columns.empty() || !array.names().empty())
    return sphere_columns(reading.options.columns, names, CsvLines(reading.file));
  if (names.size() != 3 && names.size() != 4)
    array.fail(fmt::format("has {} columns; say what they are, such as ‹columns={}›", names.size(),
                           names.size() == 2 ? "x,y" : "x0,x1,x2,x3,r"));
  SphereColumns columns = columns_xyzr();
  columns.names = names;
  if (names.size() == 3) columns.size.reset();
  return columns;
}

std::vector<double> read_radii(const std::filesystem::path& file, std::uint64_t rows) {
  NpyFile array(file, {}, NpyFile::Takes::any_numbers);
  if (array.columns() != 1)
    array.fail(fmt::format("has {} columns; one radius a row is expected", array.columns()));
  if (array.rows() != rows)
    array.fail(fmt::format("has {} radii, and there are {} centres", array.rows(), rows));
  std::vector<double> radii = columns_in(array).front();
  for (std::size_t i = 0; i < rows; ++i)
    if (!is_size(radii[i])) array.fail_at(i, size_error(radii[i], false));
  return radii;
}

}  // namespace

std::filesystem::path radii_beside(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + std::string(radii_ending));
}

bool is_npy(const FileBeginning& file) { return file.begins(npy_magic); }

FileContents read_npy(const Reading& reading) {
  NpyFile array(reading.file, {}, NpyFile::Takes::any_numbers);
  std::vector<std::string> names = array.names();
  for (std::size_t k = names.size(); k < array.columns(); ++k)
    names.push_back(fmt::format("column {}", k + 1));
  const SphereColumns columns = array_columns(reading, array, names);
  const std::vector<std::vector<double>> values = columns_in(array);
  NumberTable table;
  for (std::size_t k = 0; k < values.size(); ++k) table.add(values[k], 1, names[k]);
  FileContents contents{.spheres = table.spheres(columns, array.rows(), "row", 1, reading)};
  contents.note = columns.in_words();
  const std::filesystem::path beside = reading.options.radii.value_or(radii_beside(reading.file));
  if (reading.options.radii && columns.size)
    throw Error(ErrorCode::bad_argument, "the file has sizes of its own; leave ‹radii› out");
  if (reading.options.radii ||
      (!columns.size && !reading.has_size() && kind_of_file(beside) == FileKind::regular)) {
    contents.spheres.r = read_radii(beside, array.rows());
    contents.note += fmt::format(", radii of {}", bernal::quoted(beside.filename().string()));
  }
  return contents;
}

Format npy_format() {
  return {.name = "npy",
          .writes = "NumPy array of doubles, a row x, y, z, r for each sphere",
          .keys = {"unit"},
          .file = "npy.npy",
          .least_dimension = 1,
          .most_dimensions = max_dimension,
          .repeated_mesh = true,
          .wraps = false,
          .write = write_columns,
          .reads = "NumPy array, a row x, y, z, r for each sphere, or x, y, z",
          .unit_from = "‹unit›",
          .options = {"columns", "radii"},
          .recognises = is_npy,
          .read = read_npy};
}

}  // namespace bernal
