#include "files/npy_rows.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/npy_file.hpp"

namespace bernal {

NpyRows::NpyRows(const std::filesystem::path& file) : file_(file) {
  const NpyFile table(file);
  const auto begin = table.doubles_from();
  if (!begin)
    table.fail(
        "is no array of doubles, little-endian and in C order, as slabs are read; save it as \"<f8\" in C "
        "order, or take \"slabs\" out of scene.toml, to hold all of it");
  rows_ = table.rows();
  columns_ = table.columns();
  begin_ = *begin;
  stream_.open(file);
}

void NpyRows::read(std::uint64_t first, std::span<double> values) {
  errno = 0;
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(begin_ + first * columns_ * sizeof(double)));
  if (!stream_.read(reinterpret_cast<char*>(values.data()),
                    static_cast<std::streamsize>(values.size_bytes())))
    throw Error(ErrorCode::bad_packing,
                errno != 0 ? fmt::format("cannot be read: {}", std::strerror(errno))
                           : "ends before its header says so: it was cut off",
                {file_.string()});
}

}  // namespace bernal
