#include <bit>
#include <cstring>

#include "core/npy_file.hpp"
#include "core/parallel.hpp"
#include "formats/format.hpp"
#include "formats/npy.hpp"
#include "io/output_file.hpp"

namespace bernal {

void write_npy(const std::filesystem::path& path, std::size_t rows, std::size_t columns,
               const std::function<double(std::size_t, std::size_t)>& value) {
  static_assert(std::endian::native == std::endian::little);
  OutputFile out(path);
  out.append(npy_header(rows, columns));
  const std::size_t in_row = std::max<std::size_t>(columns, 1);
  std::string row(in_row * sizeof(double), '\0');
  for (std::size_t i = 0; i < rows; ++i) {
    throw_if_interrupted();
    for (std::size_t k = 0; k < in_row; ++k) {
      const double number = value(i, k);
      std::memcpy(row.data() + k * sizeof number, &number, sizeof number);
    }
    out.append(row);
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

}  // namespace

const Format& npy_format() {
  static const Format format{
      .table = {.keys =
                    output_entry("npy", "NumPy array of doubles, a row x, y, z, r for each sphere", {"unit"}),
                .file = "npy.npy",
                .least_dimension = 1,
                .most_dimensions = max_dimension},
      .wraps = false,
      .write = write_columns};
  return format;
}

}  // namespace bernal
