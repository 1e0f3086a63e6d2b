#include "result/write_spheres.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "bernal/core/error.hpp"
#include "bernal/result/read_packing.hpp"
#include "core/parallel.hpp"
#include "files/npy_file.hpp"
#include "files/output_file.hpp"
#include "result/write_csv.hpp"

namespace bernal {
namespace {

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

std::span<const double> column(const Spheres<dynamic>& spheres, std::size_t k) {
  return k < spheres.x.size() ? spheres.x[k] : spheres.r;
}

void write_array(OutputFile& file, const Spheres<dynamic>& spheres) {
  constexpr std::size_t rows_at_once = 1 << 14;
  const std::size_t columns = spheres.x.size() + 1;
  file.append(npy_header(spheres.size(), columns));
  std::vector<double> rows;
  for (std::size_t first = 0; first < spheres.size(); first += rows_at_once) {
    throw_if_interrupted();
    const std::size_t count = std::min(rows_at_once, spheres.size() - first);
    rows.resize(count * columns);
    for (std::size_t k = 0; k < columns; ++k) {
      const auto values = column(spheres, k).subspan(first, count);
      for (std::size_t i = 0; i < count; ++i) rows[i * columns + k] = values[i];
    }
    file.append({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(double)});
  }
}

bool holds_array(const std::filesystem::path& file, const Spheres<dynamic>& spheres) {
  NpyFile table(file);
  if (table.rows() != spheres.size() || table.columns() != spheres.x.size() + 1 || !table.names().empty())
    return false;
  bool same = true;
  table.read([&](std::size_t k, std::size_t first, std::span<const double> values) {
    same = same && same_bits(values, column(spheres, k).subspan(first, values.size()));
  });
  return same;
}

bool holds_text(const std::filesystem::path& file, const Packing& packing) {
  const SpheresFile written = read_csv(file);
  const Spheres<dynamic>& spheres = packing.spheres;
  bool same = written.unit == name_of(packing.scene.unit) &&
              written.spheres.dimension() == spheres.dimension() &&
              classes_in(packing.scene, written) == packing.classes;
  for (std::size_t k = 0; same && k <= spheres.x.size(); ++k)
    same = same_bits(column(written.spheres, k), column(spheres, k));
  return same;
}

}  // namespace

void write_spheres(const std::filesystem::path& file, const Packing& packing, bool as_array) {
  OutputFile out(file);
  as_array ? write_array(out, packing.spheres) : write_csv(out, packing);
  out.close();
}

std::string as_npy(const std::vector<double>& values) {
  std::string bytes = npy_header(values.size(), 0);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  return bytes;
}

std::string as_npy(const std::vector<std::uint32_t>& classes) {
  return as_npy(std::vector<double>(classes.begin(), classes.end()));
}

void require_written(const std::filesystem::path& file, const Packing& packing, bool as_array) {
  if (!(as_array ? holds_array(file, packing.spheres) : holds_text(file, packing)))
    throw Error(ErrorCode::cannot_write, "reads back differently from what was written", {file.string()});
}

}  // namespace bernal
