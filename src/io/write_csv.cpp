#include "io/write_csv.hpp"

#include <array>
#include <charconv>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bernal {

std::vector<std::string> csv_columns(int dimension) {
  if (dimension == 3) return {"x", "y", "z", "r"};
  std::vector<std::string> columns;
  for (int k = 0; k < dimension; ++k) columns.push_back(fmt::format("x{}", k));
  columns.push_back("r");
  return columns;
}

std::string csv_header(int dimension) { return fmt::format("{}", fmt::join(csv_columns(dimension), ",")); }

void write_csv(OutputFile& file, const Spheres<dynamic>& spheres, std::string_view unit) {
  file.append("# unit: " + std::string(unit) + "\n" + csv_header(spheres.dimension()) + "\n");
  std::array<char, (max_dimension + 1) * 32U> line;  // the longest shortest double has 24 characters
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    char* end = line.data();
    const auto add = [&](double value) {
      end = std::to_chars(end, line.data() + line.size(), value).ptr;
      *end++ = ',';
    };
    for (const auto& column : spheres.x) add(column[i]);
    add(spheres.r[i]);
    end[-1] = '\n';
    file.append({line.data(), static_cast<std::size_t>(end - line.data())});
  }
}

}  // namespace bernal
