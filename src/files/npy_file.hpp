#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/input_file.hpp"
#include "files/raw_numbers.hpp"

namespace bernal {

/// Whether a file begins as one of NumPy's .npy does. False where it cannot be read.
bool is_npy_file(const std::filesystem::path& file);

/// The header of an .npy of version 1.0, padded to 64 bytes: doubles, little-endian, in C order, of shape
/// (rows, columns) or, where `columns` is 0, (rows,). Source: numpy.lib.format.
std::string npy_header(std::size_t rows, std::size_t columns);
/// The same for numbers of another type, "<u4", and any shape.
std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

inline constexpr std::string_view npy_magic = "\x93NUMPY";

/// A table of numbers in a file of NumPy's: an array of shape (rows, columns), in C or in Fortran order, of
/// doubles or floats of either byte order; or one of shape (rows,) whose entries are structures of such, with
/// names. Versions 1.0 to 3.0. Its errors are Error{bad_packing} with the file and, where one is meant, the
/// row, counted from 1.
class NpyFile {
 public:
  /// What other programs save besides: whole numbers, and lists, which have one dimension.
  enum class Takes { tables, any_numbers };

  /// `see` is told all bytes in order, by the end of `read`. Throws for what is no such table: no regular
  /// file, another type or shape, more or fewer bytes than the header says.
  explicit NpyFile(const std::filesystem::path& file, std::function<void(std::string_view bytes)> see = {},
                   Takes takes = Takes::tables);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return fields_.size(); }
  bool is_list() const { return is_list_; }
  /// Of the structures' members; none where there are none.
  const std::vector<std::string>& names() const { return names_; }
  /// The byte where its numbers begin, if they are doubles as this machine has them, row by row; else
  /// nothing.
  std::optional<std::uintmax_t> doubles_from() const;

  /// Tells all numbers in pieces of columns: `count` of column k from row `first` on. In C order pieces of
  /// all columns follow each other. Once. Memory: about a megabyte.
  using Visit = std::function<void(std::size_t k, std::size_t first, std::span<const double> values)>;
  void read(const Visit& visit);

  /// Of row `row`, counted from 0.
  [[noreturn]] void fail_at(std::size_t row, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  struct Field {
    std::size_t offset = 0;
    RawNumber number;
    std::size_t bytes() const { return static_cast<std::size_t>(number.bytes); }
  };

  void read_header(Takes takes);
  void read_bytes(char* to, std::size_t count);
  void read_rows(const Visit& visit);
  void read_columns(const Visit& visit);

  std::string name_;
  std::function<void(std::string_view)> see_;
  InputFile stream_;
  std::vector<Field> fields_;
  std::vector<std::string> names_;
  std::size_t rows_ = 0, row_bytes_ = 0;
  std::uintmax_t begin_ = 0;
  bool by_columns_ = false, is_list_ = false;
};

}  // namespace bernal
