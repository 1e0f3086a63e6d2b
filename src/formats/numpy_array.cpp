#include "formats/numpy_array.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/csv_headings.hpp"
#include "core/csv_lines.hpp"
#include "formats/binary_file.hpp"
#include "formats/raw_numbers.hpp"

namespace bernal {
namespace {

/// What stands behind a key of the header, a Python dictionary.
std::string_view value_behind(std::string_view header, std::string_view key, const BinaryFile& file) {
  const std::size_t at = header.find(key);
  const std::size_t colon = at == header.npos ? at : header.find(':', at);
  if (colon == header.npos) file.fail(fmt::format("has no {} in its header", key));
  return stripped(header.substr(colon + 1), " ");
}

struct NumpyHeader {
  RawNumber number;
  bool is_fortran = false;
  std::vector<std::uint64_t> shape;
};

NumpyHeader parse_header(std::string_view text, const BinaryFile& file) {
  NumpyHeader header;
  const std::string_view type = value_behind(text, "'descr'", file);
  const std::string_view word = type.substr(0, std::min(type.size(), std::size_t{5}));
  const std::string_view known = "<>=|";
  const bool is_plain = word.size() == 5 && word[0] == '\'' && known.find(word[1]) != known.npos &&
                        (word[2] == 'f' || word[2] == 'i' || word[2] == 'u') &&
                        (word[3] == '4' || word[3] == '8') && word[4] == '\'';
  if (!is_plain)
    file.fail(fmt::format("has elements {}; save plain numbers: np.save(file, a.astype(float))",
                          bernal::quoted(type.substr(0, type.find(", 'fortran")))));
  header.number = {word[2], word[3] - '0', word[1] == '>'};
  const std::string_view order = value_behind(text, "'fortran_order'", file);
  header.is_fortran = order.starts_with("True");
  if (!header.is_fortran && !order.starts_with("False"))
    file.fail(fmt::format("has the fortran_order {}, which is neither True nor False",
                          bernal::quoted(order.substr(0, order.find(',')))));
  std::string_view shape = value_behind(text, "'shape'", file);
  if (!shape.starts_with('(')) file.fail("has no shape in its header");
  shape = shape.substr(1, shape.find(')') - 1);
  std::vector<std::string_view> parts;
  split_fields(shape, ',', parts);
  for (const std::string_view part : parts) {
    if (part.empty()) continue;
    std::uint64_t length = 0;
    const auto [stop, problem] = std::from_chars(part.data(), part.data() + part.size(), length);
    if (problem != std::errc{} || stop != part.data() + part.size())
      file.fail(fmt::format("has the shape {}", bernal::quoted(shape)));
    header.shape.push_back(length);
  }
  return header;
}

std::vector<double> numbers_in(BinaryFile& file, std::uint64_t at, std::uint64_t count, RawNumber how) {
  std::vector<double> values;
  values.reserve(count);
  constexpr std::uint64_t at_once = 1 << 16;
  const auto bytes = static_cast<std::uint64_t>(how.bytes);
  for (std::uint64_t from = 0; from < count; from += at_once) {
    const std::vector<char> part =
        file.many<char>(at + from * bytes, std::min(at_once, count - from) * bytes);
    append_raw_numbers({part.data(), part.size()}, how, values);
  }
  return values;
}

}  // namespace

NumpyArray read_numpy_array(const std::filesystem::path& path) {
  BinaryFile file(path);
  std::string magic(numpy_magic.size(), '\0');
  file.read(0, magic.data(), magic.size());
  if (magic != numpy_magic) file.fail("is no .npy file; save one with np.save");
  const auto version = file.get<std::uint8_t>(6);
  if (version < 1 || version > 3)
    file.fail(fmt::format("is a .npy of version {}, and 1 to 3 are known", version));
  const std::uint64_t from = version == 1 ? 10 : 12;
  const std::uint64_t length = version == 1 ? file.get<std::uint16_t>(8) : file.get<std::uint32_t>(8);
  constexpr std::uint64_t longest_header = 1 << 16;
  if (length > longest_header) file.fail("has too long a header for an array of numbers");
  std::string text(length, '\0');
  file.read(from, text.data(), length);
  const NumpyHeader header = parse_header(text, file);
  if (header.shape.empty() || header.shape.size() > 2)
    file.fail(
        fmt::format("has {} dimensions; an array of rows and columns is expected", header.shape.size()));
  NumpyArray array{.rows = header.shape[0], .is_list = header.shape.size() == 1, .values = {}};
  if (!array.is_list) array.columns = header.shape[1];
  const std::uint64_t begin = from + length,
                      in_row = array.columns * static_cast<std::uint64_t>(header.number.bytes);
  constexpr std::uint64_t most_columns = 4096;
  if (array.columns == 0 || array.columns > most_columns)
    file.fail(fmt::format("has {} columns; x, y, z and perhaps r are expected", array.columns));
  if (!file.holds(begin, array.rows, in_row))
    file.fail(
        fmt::format("ends after {} of {} rows; was it cut off?", (file.size() - begin) / in_row, array.rows));
  if (const std::uint64_t left = file.size() - begin - array.rows * in_row; left > 0)
    file.fail(
        fmt::format("has {} bytes behind its {} rows; save one array alone, with np.save", left, array.rows));
  const std::vector<double> values = numbers_in(file, begin, array.rows * array.columns, header.number);
  if (!header.is_fortran || array.is_list) {
    array.values = values;
    return array;
  }
  array.values.resize(values.size());
  for (std::uint64_t row = 0; row < array.rows; ++row)
    for (std::uint64_t column = 0; column < array.columns; ++column)
      array.values[row * array.columns + column] = values[column * array.rows + row];
  return array;
}

}  // namespace bernal
