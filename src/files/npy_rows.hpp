#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

#include "files/input_file.hpp"

namespace bernal {

/// The rows of an array of doubles in a file of NumPy's, little-endian and in C order as bernal writes it, in
/// any order, so that nobody need hold the array. Errors are those of NpyFile.
class NpyRows {
 public:
  explicit NpyRows(const std::filesystem::path& file);

  std::uint64_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// As many whole rows from row `first` on as there is room for.
  void read(std::uint64_t first, std::span<double> values);

 private:
  std::filesystem::path file_;
  std::uint64_t rows_ = 0, begin_ = 0;
  std::size_t columns_ = 0;
  InputFile stream_;
};

}  // namespace bernal
