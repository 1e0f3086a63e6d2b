#include "scene/read_npy_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "files/npy_file.hpp"

namespace bernal {
namespace {

/// Which of a table's columns are the coordinates and the size.
struct Places {
  std::vector<std::size_t> x;
  std::size_t size = 0;
  bool is_diameter = false;
};

std::optional<std::size_t> member(const NpyFile& file, const std::string& name) {
  const auto same = [&](const std::string& other) {
    return std::ranges::equal(name, other, {}, {}, [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
  };
  const auto found = std::ranges::find_if(file.names(), same);
  if (found == file.names().end()) return {};
  return static_cast<std::size_t>(found - file.names().begin());
}

Places places_by_name(const NpyFile& file) {
  Places places;
  for (const char* letter : {"x", "y", "z"}) {
    const auto at = member(file, letter);
    if (!at) break;
    places.x.push_back(*at);
  }
  if (places.x.empty())
    while (const auto at = member(file, fmt::format("x{}", places.x.size()))) places.x.push_back(*at);
  int sizes = 0;
  for (const std::string name : {"r", "radius", "d", "diameter"})
    if (const auto at = member(file, name)) {
      ++sizes;
      places.size = *at;
      places.is_diameter = name.front() == 'd';
    }
  if (places.x.empty() || sizes != 1)
    file.fail(
        "its structures need members x, y, z or x0, x1, …, and one size of a sphere: r, radius, d or "
        "diameter");
  return places;
}

Places places_in(const NpyFile& file) {
  Places places;
  if (!file.names().empty()) {
    places = places_by_name(file);
  } else {
    if (file.columns() < 2)
      file.fail(fmt::format("has {} column{}; a row of it is to be x, y, z and the radius of a sphere",
                            file.columns(), file.columns() == 1 ? "" : "s"));
    for (std::size_t k = 0; k + 1 < file.columns(); ++k) places.x.push_back(k);
    places.size = file.columns() - 1;
  }
  if (places.x.size() > max_dimension)
    file.fail(fmt::format("has {} coordinates; there are at most {}", places.x.size(), max_dimension));
  return places;
}

}  // namespace

Spheres<dynamic> read_npy_spheres(const std::filesystem::path& file, const Lengths& lengths,
                                  const std::function<void(std::string_view bytes)>& see) {
  NpyFile table(file, see);
  const Places places = places_in(table);
  Spheres<dynamic> spheres(static_cast<int>(places.x.size()));
  spheres.resize(table.rows());
  table.read([&](std::size_t k, std::size_t first, std::span<const double> values) {
    if (k == places.size) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!(values[i] >= lengths.smallest_size && values[i] <= lengths.farthest))
          table.fail_at(first + i, fmt::format("the {} {} is not a length from {} to {}",
                                               places.is_diameter ? "diameter" : "radius", values[i],
                                               lengths.smallest_size, lengths.farthest));
        spheres.r[first + i] = places.is_diameter ? 0.5 * values[i] : values[i];
      }
      return;
    }
    const auto axis = std::ranges::find(places.x, k);
    if (axis == places.x.end()) return;
    std::vector<double>& column = spheres.x[static_cast<std::size_t>(axis - places.x.begin())];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(std::abs(values[i]) <= lengths.farthest))
        table.fail_at(first + i,
                      fmt::format("the coordinate {} is not one within {}", values[i], lengths.farthest));
      column[first + i] = values[i];
    }
  });
  return spheres;
}

}  // namespace bernal
