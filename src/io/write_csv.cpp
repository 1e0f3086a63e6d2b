#include "io/write_csv.hpp"

#include <array>
#include <charconv>
#include <string>

namespace bernal {

void write_csv(OutputFile& file, const Spheres<3>& spheres, std::string_view unit) {
  file.append("# unit: " + std::string(unit) + "\nx,y,z,r\n");
  std::array<char, 4 * 32> line;  // the longest shortest double has 24 characters
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    char* end = line.data();
    for (const double value : {spheres.x[0][i], spheres.x[1][i], spheres.x[2][i], spheres.r[i]}) {
      end = std::to_chars(end, line.data() + line.size(), value).ptr;
      *end++ = ',';
    }
    end[-1] = '\n';
    file.append({line.data(), static_cast<std::size_t>(end - line.data())});
  }
}

}  // namespace bernal
