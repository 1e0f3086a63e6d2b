#pragma once
#include <array>
#include <cstddef>
#include <istream>
#include <string>

namespace bernal {

/// Of text files that hold numbers: a longer one is no such file, and is not read to its end.
inline constexpr std::size_t longest_line = 4000;

enum class NextLine { read, too_long, none };

/// Reads the next line without its end. At the end of the file, and where reading fails, there is none.
inline NextLine next_line(std::istream& in, std::string& line) {
  std::array<char, longest_line + 2> buffer;  // the end of the line and that of the text
  in.getline(buffer.data(), buffer.size());
  const auto taken = static_cast<std::size_t>(in.gcount());
  if (in.bad() || (in.eof() && taken == 0)) return NextLine::none;
  if (in.fail() && !in.eof()) return NextLine::too_long;
  line.assign(buffer.data(), in.eof() ? taken : taken - 1);
  return line.size() > longest_line ? NextLine::too_long : NextLine::read;
}

}  // namespace bernal
