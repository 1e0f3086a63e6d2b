#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace bernal {

inline constexpr std::string_view numpy_magic = "\x93NUMPY";

/// An array of numbers of one or two dimensions: rows × columns, row by row.
struct NumpyArray {
  std::uint64_t rows = 0, columns = 1;
  bool is_list = false;  ///< of one dimension
  std::vector<double> values;

  double at(std::uint64_t row, std::uint64_t column) const { return values[row * columns + column]; }
};

/// Reads a .npy of version 1 to 3: floating point of 4 or 8 bytes or integers of 4 or 8, in either order of
/// bytes, in C or Fortran order. Throws Error{bad_packing} for others and where bytes are missing or left.
/// Source: numpy.lib.format.
NumpyArray read_numpy_array(const std::filesystem::path& file);

}  // namespace bernal
