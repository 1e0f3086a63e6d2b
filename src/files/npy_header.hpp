#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bernal {

/// What the header of an .npy says, a dictionary in Python's syntax.
struct NpyHeader {
  /// The type of a number such as "<f8", without a name; or those of a structure's members, with theirs.
  std::vector<std::pair<std::string, std::string>> members;
  bool is_structure = false;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Nothing where it is none, or says what no table of numbers does.
std::optional<NpyHeader> npy_header_in(std::string_view text);

}  // namespace bernal
