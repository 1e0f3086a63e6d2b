#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/OFF/File_header_OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

#include "cad/caged_reader.hpp"
#include "cad/file_facts.hpp"
#include "cad/known_formats.hpp"
#include "cad/polygon_soup.hpp"

namespace bernal::cad {
namespace {

using SoupPoint = CGAL::Simple_cartesian<double>::Point_3;
using Points = std::vector<SoupPoint>;
using Polygons = std::vector<std::vector<std::size_t>>;

template <typename Read>
ReadAttempt attempt(const Read& read) {
  Points points;
  Polygons polygons;
  ReadAttempt result;
  try {
    if (!read(points, polygons)) result.failure = "malformed or truncated";
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  if (!result.ok()) return result;

  for (const SoupPoint& p : points) {
    result.soup.points.emplace_back(p.x(), p.y(), p.z());
    if (!result.soup.points.back().allFinite()) result.failure = "a coordinate is not finite";
  }
  for (const auto& polygon : polygons) {
    if (polygon.size() < 3) continue;
    if (*std::max_element(polygon.begin(), polygon.end()) >= points.size())
      result.failure = "a face names a vertex that does not exist";
    result.soup.polygons.emplace_back(polygon.begin(), polygon.end());
  }
  return result;
}

/// The same in a child process, for a text of so many bytes.
template <typename Read>
ReadAttempt attempt_in_cage(std::size_t size, const Read& read) {
  return read_in_cage("CGAL", cage_limits(size), [&] { return attempt(read); });
}

/// CGAL casts whatever stands in a face of an OFF text to indices, so that 1e300 may become the first vertex,
/// and makes room for as many corners as the face claims. So the faces are looked through before; empty if
/// they are good, or if CGAL will see by itself what is wrong.
std::string wrong_face_of_off(const std::string& text) {
  std::istringstream in(text);
  CGAL::File_header_OFF header;
  in >> header;
  if (!in || header.binary()) return {};
  const std::size_t vertices = header.size_of_vertices(), lines = vertices + header.size_of_facets();
  std::string line;
  for (std::size_t k = 0; k < lines && std::getline(in, line);) {  // a vertex or face, or but a comment
    const char *at = line.data(), *const end = at + std::min(line.find('#'), line.size());
    const auto skip_blanks = [&] {
      at = std::find_if(at, end, [](char c) { return c != ' ' && c != '\t' && c != '\r'; });
    };
    const auto next_below = [&](std::size_t bound) {
      skip_blanks();
      double number = -1;
      at = std::from_chars(at, end, number).ptr;
      return number >= 0 && number < static_cast<double>(bound) && number == std::floor(number)
                 ? static_cast<std::size_t>(number)
                 : bound;
    };
    skip_blanks();
    if (at == end || k++ < vertices) continue;
    const std::size_t most = line.size(), corners = next_below(most);  // each takes a character and more
    if (corners == most) return "malformed or truncated";
    for (std::size_t i = 0; i < corners; ++i) {
      skip_blanks();
      if (at == end) return "malformed or truncated";
      if (next_below(vertices) == vertices) return "a face names a vertex that does not exist";
    }
  }
  return {};
}

/// CGAL reads the coordinates of a PLY file as float or double and the corners of its faces as int or uint,
/// and loops as often as the header says. What else this one has them in, or that it cannot hold so many; or
/// empty.
std::string wrong_header_of_ply(const std::string& text) {
  const auto is_one_of = [](const std::string& type, std::initializer_list<std::string_view> known) {
    return std::ranges::find(known, type) != known.end();
  };
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("end_header")) return {};
    std::istringstream words(line);
    std::string word, type, count, name;
    if (!(words >> word >> type)) continue;
    if (word == "element" && words >> count &&
        (count.size() > 15 || std::strtoull(count.c_str(), nullptr, 10) > text.size()))
      return fmt::format("its header promises {} of \"{}\", more than it can hold", count.substr(0, 20),
                         type.substr(0, 20));
    if (word != "property") continue;
    const bool list = type == "list";
    if (list) words >> count >> type;
    words >> name;
    if (list && name.starts_with("vertex_ind") && !is_one_of(type, {"int", "uint", "int32", "uint32"}))
      return fmt::format("its faces give their vertices as {}; write these as int", type);
    if (is_one_of(name, {"x", "y", "z"}) && !is_one_of(type, {"float", "double", "float32", "float64"}))
      return fmt::format("its coordinates are {}; write them as double", type);
  }
  return "its header has no end";
}

/// The objects of an OBJ file, or its groups if it has none. `faces` is what was read: where that is not what
/// the text holds, nothing is told.
std::vector<Solid> obj_parts(std::string_view text, std::size_t faces) {
  std::vector<Solid> objects, groups;
  std::size_t face = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.starts_with("f ") || line.starts_with("f\t")) ++face;
    if (line.starts_with("o ")) objects.push_back({std::string(line.substr(2)), face});
    if (line.starts_with("g ")) groups.push_back({std::string(line.substr(2)), face});
  }
  std::vector<Solid>& parts = objects.empty() ? groups : objects;
  if (face != faces || parts.empty()) return {};
  if (parts.front().first > 0) parts.insert(parts.begin(), {"", 0});
  std::vector<Solid> filled;  // parts that hold no face are none
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].first < (i + 1 < parts.size() ? parts[i + 1].first : faces))
      filled.push_back(std::move(parts[i]));
  return filled;
}

}  // namespace

std::string wrong_number_of_obj(const std::filesystem::path& file) {
  constexpr std::size_t most_digits = 1000, most_of_corner = 100;
  std::istringstream in(text_without_mark(file));
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const bool vertex = line.starts_with("v ") || line.starts_with("v\t");
    if (!vertex && !line.starts_with("f ") && !line.starts_with("f\t")) continue;
    if (trimmed(line).ends_with('\\')) continue;  // it goes on in the next one
    std::string_view rest = trimmed(std::string_view(line).substr(1));
    for (int k = 0; !rest.empty() && (!vertex || k < 3); ++k) {
      const std::string_view word = rest.substr(0, std::min(rest.find_first_of(" \t"), rest.size()));
      rest = trimmed(rest.substr(word.size()));
      std::string_view digits = word;
      if (digits.starts_with('+')) digits.remove_prefix(1);
      double value = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      const bool too_small = error == std::errc::result_out_of_range &&
                             digits.find_first_of("eE") != digits.npos &&
                             std::strtod(std::string(digits).c_str(), nullptr) == 0;
      const bool is_number =
          error == std::errc() && end == digits.data() + digits.size() && std::isfinite(value);
      if (vertex ? digits.size() <= most_digits && (is_number || too_small) : word.size() <= most_of_corner)
        continue;
      return fmt::format("a {} is \"{:.40}{}\", {} (line {})", vertex ? "coordinate" : "corner of a face",
                         word, word.size() > 40 ? "..." : "", vertex ? "no finite number" : "no index",
                         number);
    }
  }
  return {};
}

bool cgal_reads(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".off" || extension == ".obj" || extension == ".ply";
}

ReadAttempt read_with_cgal(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  const std::string text = text_without_mark(file);
  if (extension == ".off")
    if (std::string wrong = wrong_face_of_off(text); !wrong.empty())
      return {.soup = {}, .failure = std::move(wrong)};
  if (extension == ".ply")
    if (std::string wrong = wrong_header_of_ply(text); !wrong.empty())
      return {.soup = {}, .failure = std::move(wrong)};
  ReadAttempt result = attempt_in_cage(text.size(), [&](Points& points, Polygons& polygons) {
    std::istringstream in(text);
    if (extension == ".off") return CGAL::IO::read_OFF(in, points, polygons);
    if (extension == ".obj") return CGAL::IO::read_OBJ(in, points, polygons);
    return CGAL::IO::read_PLY(in, points, polygons);
  });
  if (result.ok() && extension == ".obj") result.soup.solids = obj_parts(text, result.soup.polygons.size());
  return result;
}

ReadAttempt read_stl_with_cgal(const std::string& content) {
  return attempt_in_cage(content.size(), [&](Points& points, Polygons& polygons) {
    std::istringstream in(content);
    return CGAL::IO::read_STL(in, points, polygons);
  });
}

}  // namespace bernal::cad
