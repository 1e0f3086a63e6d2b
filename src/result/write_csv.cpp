#include "result/write_csv.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/scene/sphere_classes.hpp"
#include "core/parallel.hpp"

namespace bernal {

std::vector<std::string> csv_columns(int dimension) {
  if (dimension == 3) return {"x", "y", "z", "r"};
  std::vector<std::string> columns;
  for (int k = 0; k < dimension; ++k) columns.push_back(fmt::format("x{}", k));
  columns.push_back("r");
  return columns;
}

std::string csv_header(int dimension) { return fmt::format("{}", fmt::join(csv_columns(dimension), ",")); }

namespace {

/// What ends the line of a sphere of each class: ",sand,quartz".
std::vector<std::string> ends_of_lines(const Scene& scene) {
  std::vector<std::string> ends;
  for (const SphereClass& of : classes_of(scene)) ends.push_back(fmt::format(",{},{}", of.name, of.material));
  return ends;
}

/// Of the spheres from `first` to `last`.
std::string lines_of(const Packing& packing, const std::vector<std::string>& ends, std::size_t first,
                     std::size_t last) {
  const Spheres<dynamic>& spheres = packing.spheres;
  constexpr std::size_t longest_number = 32;  // the longest shortest double has 24 characters
  std::size_t longest_end = 0;
  for (const std::string& text : ends) longest_end = std::max(longest_end, text.size());
  const std::size_t longest_line = (spheres.x.size() + 1) * longest_number + longest_end;
  std::string text((last - first) * longest_line, '\0');
  char* end = text.data();
  const auto add = [&](double value) {
    end = std::to_chars(end, end + longest_number, value).ptr;
    *end++ = ',';
  };
  for (std::size_t i = first; i < last; ++i) {
    for (const auto& column : spheres.x) add(column[i]);
    add(spheres.r[i]);
    if (!packing.classes.empty()) end = std::ranges::copy(ends[packing.classes[i]], end - 1).out + 1;
    end[-1] = '\n';
  }
  text.resize(static_cast<std::size_t>(end - text.data()));
  return text;
}

}  // namespace

void write_csv(OutputFile& file, const Packing& packing) {
  const Spheres<dynamic>& spheres = packing.spheres;
  const bool has_classes = !packing.classes.empty();
  const std::vector<std::string> ends =
      has_classes ? ends_of_lines(packing.scene) : std::vector<std::string>();
  file.append(fmt::format("# unit: {}\n{}{}\n", name_of(packing.scene.unit), csv_header(spheres.dimension()),
                          has_classes ? csv_class_columns : ""));
  constexpr std::size_t lines_a_block = 4096, blocks_at_once = 64;
  std::vector<std::string> blocks(blocks_at_once);
  for (std::size_t begin = 0; begin < spheres.size(); begin += lines_a_block * blocks_at_once) {
    const std::size_t lines = std::min(lines_a_block * blocks_at_once, spheres.size() - begin);
    const std::size_t count = (lines + lines_a_block - 1) / lines_a_block;
    parallel_for(count, [&](std::size_t b) {
      const std::size_t first = begin + b * lines_a_block;
      blocks[b] = lines_of(packing, ends, first, std::min(first + lines_a_block, begin + lines));
    });
    for (std::size_t b = 0; b < count; ++b) file.append(blocks[b]);
  }
}

}  // namespace bernal
