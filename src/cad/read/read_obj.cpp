#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "cad/read/file_facts.hpp"
#include "cad/read/known_formats.hpp"
#include "cad/read/polygon_soup.hpp"
#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

class ObjText {
 public:
  ReadAttempt read(std::string text) && {
    std::istringstream in(std::move(text));
    for (std::string line; read_.ok() && std::getline(in, line);) {
      ++line_;
      for (std::string more; trimmed(line).ends_with('\\') && std::getline(in, more);) {
        line.resize(line.rfind('\\'));
        line += ' ' + more;
      }
      constexpr std::size_t lines_between_looks = 1 << 16;
      if (line_ % lines_between_looks == 0) throw_if_interrupted();
      take(trimmed(line));
    }
    if (read_.ok() && largest_ >= static_cast<std::int64_t>(read_.soup.points.size()))
      read_.failure = "a face names a vertex that does not exist";
    read_.soup.solids = filled(objects_.empty() ? groups_ : objects_);
    return std::move(read_);
  }

 private:
  void take(std::string_view line) {
    const std::string_view word = next_of(line);
    if (word == "v") return take_vertex(line);
    if (word == "f") return take_face(line);
    if (word == "o") objects_.push_back({std::string(line), read_.soup.polygons.size()});
    if (word == "g") groups_.push_back({std::string(line), read_.soup.polygons.size()});
  }

  void take_vertex(std::string_view line) {
    Vector<3>& p = read_.soup.points.emplace_back();
    for (double& coordinate : p) {
      const std::string_view word = next_of(line);
      const std::optional<double> number = finite_number(word);
      if (!number) return refuse("coordinate", word, "no finite number");
      coordinate = *number;
    }
  }

  /// Corners such as "7", "7/1", "7//3", and "-1" for the last vertex so far.
  void take_face(std::string_view line) {
    constexpr std::size_t most_digits = 100;
    const auto known = static_cast<std::int64_t>(read_.soup.points.size());
    std::vector<std::uint32_t> corners;
    while (!line.empty()) {
      const std::string_view word = next_of(line);
      std::int64_t number = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      const bool whole = end == word.data() + word.size() || *end == '/';
      if (word.size() > most_digits || error == std::errc::invalid_argument || !whole)
        return refuse("corner of a face", word, "no index");
      const std::int64_t vertex = number > 0 ? number - 1 : known + number;
      if (error != std::errc() || number == 0 || vertex < 0 || vertex > most_vertices)
        return refuse("corner of a face", word, "no vertex that exists");
      largest_ = std::max(largest_, vertex);
      corners.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (corners.size() >= 3) read_.soup.polygons.push_back(std::move(corners));
  }

  static std::string_view next_of(std::string_view& line) {
    const std::string_view word = line.substr(0, std::min(line.find_first_of(" \t"), line.size()));
    line = trimmed(line.substr(word.size()));
    return word;
  }

  void refuse(std::string_view what, std::string_view word, std::string_view why) {
    read_.failure = fmt::format("a {} is \"{:.40}{}\", {} (line {})", what, word,
                                word.size() > 40 ? "..." : "", why, line_);
  }

  /// The parts with faces; faces before the first part form a part without a name.
  std::vector<Solid> filled(std::vector<Solid>& parts) const {
    if (parts.empty()) return {};
    if (parts.front().first > 0) parts.insert(parts.begin(), {"", 0});
    std::vector<Solid> some;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].first < (i + 1 < parts.size() ? parts[i + 1].first : read_.soup.polygons.size()))
        some.push_back(std::move(parts[i]));
    return some;
  }

  static constexpr std::int64_t most_vertices = 3'000'000'000;

  ReadAttempt read_{.reader = "bernal, double precision"};
  std::size_t line_ = 0;
  std::int64_t largest_ = -1;  ///< largest vertex index used
  std::vector<Solid> objects_, groups_;
};

}  // namespace

ReadAttempt read_obj(const std::filesystem::path& file) { return ObjText().read(text_without_mark(file)); }

}  // namespace bernal::cad
