#include "scene/keys_from_columns.hpp"

#include <algorithm>
#include <string_view>

#include "scene/read_columns.hpp"

namespace bernal {
namespace {

using schema::Key;
using schema::Type;

/// So many sizes a run holds in memory, and so many corners the scene of a result, which is read again.
constexpr std::size_t most_listed = 20'000'000, most_corners = 20'000;

/// The corners of a line from two columns.
std::vector<const Key*> points_from_columns(const std::filesystem::path& file, const schema::Entry& entry,
                                            Unit unit, void* options) {
  static const Key x{.name = "x", .type = Type::coordinates}, y{.name = "y", .type = Type::coordinates};
  WantedColumns wanted{
      {&x, &y}, unit, most_corners, "leave out corners that are finer than discs or spheres can feel"};
  const auto columns = read_columns(file, wanted);
  Polygon polygon{{{}}};
  for (std::size_t k = 0; k < columns[0].size(); ++k)
    polygon.loops.front().emplace_back(columns[0][k], columns[1][k]);
  const auto key = std::ranges::find(entry.keys, Type::points, &Key::type);
  key->member.set(options, polygon);
  return {&*key};
}

}  // namespace

bool comes_from_file(const schema::Entry& entry, const Key& key) {
  return entry.columns.empty() ? key.type == Type::points
                               : std::ranges::find(entry.columns, key.name) != entry.columns.end();
}

std::vector<const Key*> keys_from_columns(const std::filesystem::path& file, const schema::Entry& entry,
                                          Unit unit, void* options) {
  if (entry.columns.empty()) return points_from_columns(file, entry, unit, options);
  std::vector<const Key*> keys;
  for (const std::string_view column : entry.columns) keys.push_back(entry.find(column));
  const bool is_list = keys.size() == 1;
  // More points are measurements, not a distribution; and a scene has to hold them.
  WantedColumns wanted{keys, unit, is_list ? most_listed : 4096,
                       is_list ? "take a histogram of them" : "sum them up in fewer", entry.find("retained")};
  const auto columns = read_columns(file, wanted);
  for (std::size_t k = 0; k < wanted.keys.size(); ++k) wanted.keys[k]->member.set(options, columns[k]);
  return wanted.keys;
}

}  // namespace bernal
