#include "layering.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace bernal::layering {
namespace {

namespace fs = std::filesystem;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : text + separator) {
    if (c != separator) {
      part += c;
    } else {
      parts.push_back(trimmed(part));
      part.clear();
    }
  }
  return parts;
}

/// `above` are the rooms of the rows before, the only ones that the text may name: so no rooms form a cycle.
Rule parse_rule(const std::string& text, const std::set<std::string>& above) {
  Rule rule;
  if (text == "nothing") return rule;
  rule.public_headers_only = text == "public headers";
  if (text == "what stands above") rule.rooms = above;
  if (rule.public_headers_only || !rule.rooms.empty()) return rule;
  static const std::regex item(R"(([a-z_]+)(?: \(([a-z_.]+) only\))?)");
  for (const std::string& part : split(text, ',')) {
    std::smatch match;
    if (!std::regex_match(part, match, item))
      throw std::runtime_error("src/README.md: cannot read \"" + part + "\" in the table of rooms");
    if (!above.contains(match[1]))
      throw std::runtime_error("src/README.md: no room above is called " + match[1].str());
    if (match[2].matched)
      rule.files[match[1]].insert(match[2]);
    else
      rule.rooms.insert(match[1]);
  }
  return rule;
}

struct Include {
  int line;
  bool quoted;
  std::string path;
};

std::vector<Include> includes_of(const fs::path& file) {
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  std::ifstream in(file);
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    std::smatch match;
    if (std::regex_match(text, match, directive)) includes.push_back({line, match[1] == "\"", match[2]});
  }
  return includes;
}

/// Where a file stands, told from its path below the root. Headers of no room, which stand in include/bernal
/// itself, see public headers only, as the command does.
struct Place {
  std::string room;
  bool is_public;  ///< below include/bernal
  bool is_header;
};

Place place_of(const fs::path& below_root) {
  auto part = below_root.begin();
  const bool is_public = *part == "include";
  const bool is_app = *part == "apps";
  std::advance(part, is_public ? 2 : is_app ? 0 : 1);
  if (is_public && part->extension() == ".hpp") return {"apps", true, true};
  // The tree that the searches through walls are compiled into: cad's alone, see below.
  const bool is_tree = below_root == fs::path("src/cad/wall_tree.hpp");
  // And what the files of OpenCASCADE's module share, which is a library of its own.
  const bool is_of_module = below_root.parent_path() == fs::path("src/cad/opencascade");
  return {part->string(), is_public, below_root.extension() == ".hpp" && !is_tree && !is_of_module};
}

/// Why the include is forbidden, or "".
std::string objection(const Include& include, const Place& place, const fs::path& folder, const Rule& rule,
                      const std::map<std::string, Rule>& rules) {
  const bool reads_cad_library = include.path.starts_with("CGAL/") || include.path.starts_with("assimp/") ||
                                 include.path.ends_with(".hxx");
  if (reads_cad_library && (place.room != "cad" || place.is_header))
    return include.path + ": CGAL, assimp and OpenCASCADE belong to src/cad/*.cpp";
  const bool reads_tree = include.path == "cad/wall_tree.hpp" || include.path == "cad/tree_traversals.hpp";
  if (reads_tree && place.room != "cad")
    return include.path + ": brings CGAL along; include cad/triangle_tree.hpp";

  const bool of_public = include.path.starts_with("bernal/");
  if (!of_public && !include.quoted) return "";  // the standard library and third parties
  if (place.room == "apps" && !place.is_public && !of_public)
    return fs::exists(folder / include.path) ? "" : include.path + ": apps see public headers only";
  if (place.is_public && !of_public) return include.path + ": a public header sees public headers only";

  if (place.room == "apps") return "";
  if (include.path == "bernal/version.hpp") return "";  // stands above the rooms
  const std::vector<std::string> parts = split(include.path.substr(of_public ? 7 : 0), '/');
  if (parts.size() < 2 || !rules.contains(parts[0])) return include.path + ": names no room";
  const std::string &room = parts[0], &header = parts.back();
  if (room == place.room || rule.rooms.contains(room)) return "";
  if (rule.public_headers_only)
    return of_public ? "" : include.path + ": " + place.room + " sees public headers only";
  const auto some = rule.files.find(room);
  if (some != rule.files.end() && some->second.contains(header)) return "";
  return include.path + ": " + place.room + " must not see it";
}

/// The string literals of C++, each with its line; comments have none.
std::vector<std::pair<int, std::string>> literals_of(const std::string& text) {
  static const std::regex token(
      R"re(//[^\n]*|/\*[^]*?\*/|R"([^(]*)\([^]*?\)\1"|"(?:\\[^]|[^"\\])*"|'(?:\\.|[^'\\])')re");
  std::vector<std::pair<int, std::string>> literals;
  int line = 1;
  std::size_t counted = 0;
  for (std::sregex_iterator found(text.begin(), text.end(), token), end; found != end; ++found) {
    const auto at = static_cast<std::size_t>(found->position());
    line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(counted),
                                        text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted = at;
    if (const std::string part = found->str(); part[0] == '"' || part[0] == 'R')
      literals.emplace_back(line, part);
  }
  return literals;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_source(const fs::path& file) {
  return file.extension() == ".hpp" || file.extension() == ".cpp" || file.extension() == ".cu";
}

}  // namespace

std::vector<std::string> option_words(const fs::path& root) {
  static const std::regex option(R"((?:^|[" ;]|[^r]\()(--[a-z][a-z-]*|-o)(?![a-z=-]|:[^ ]))");
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    if (!is_source(entry.path())) continue;
    for (const auto& [line, text] : literals_of(bytes_of(entry.path())))
      if (std::smatch match; std::regex_search(text, match, option))
        found.push_back(fs::relative(entry.path(), root).string() + ":" + std::to_string(line) + ": " +
                        match[1].str());
  }
  return found;
}

std::vector<std::string> doubled_classes(const fs::path& root) {
  static const std::regex opens(R"(^(?:inline )?namespace(?: ([\w:]+))? \{$)"),
      closes(R"(^\}  // namespace.*)"), defines(R"(^(?:struct|class) (\w+)(?: final)?(?: : [^{]*)? \{.*)");
  std::map<std::string, std::set<std::string>> files;
  for (const char* top : {"src", "include"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (!is_source(entry.path())) continue;
      std::vector<std::string> spaces;
      std::ifstream in(entry.path());
      for (std::string text; std::getline(in, text);) {
        std::smatch match;
        if (std::regex_match(text, match, opens)) {
          spaces.push_back(match[1].matched ? match[1].str() + "::" : "");
        } else if (std::regex_match(text, closes) && !spaces.empty()) {
          spaces.pop_back();
        } else if (std::regex_match(text, match, defines) && !std::count(spaces.begin(), spaces.end(), "")) {
          std::string name;
          for (const std::string& space : spaces) name += space;
          files[name + match[1].str()].insert(fs::relative(entry.path(), root).string());
        }
      }
    }
  }
  std::vector<std::string> found;
  for (const auto& [name, where] : files) {
    if (where.size() < 2) continue;
    std::string text;
    for (const std::string& file : where) text += (text.empty() ? "" : ", ") + file;
    found.push_back(name + ": " + text);
  }
  return found;
}

std::map<std::string, Rule> read_rules(const fs::path& readme) {
  std::ifstream in(readme);
  if (!in) throw std::runtime_error("cannot read " + readme.string());
  std::map<std::string, Rule> rules;
  std::set<std::string> above;
  static const std::regex row(R"(\|[^|]*\| `([a-z_]+)/` \|[^|]*\| ([^|]+) \|)");
  for (std::string text; std::getline(in, text);) {
    std::smatch match;
    if (!std::regex_match(text, match, row)) continue;
    rules[match[1]] = parse_rule(match[2], above);
    above.insert(match[1]);
  }
  return rules;
}

std::vector<std::string> violations(const fs::path& root, const std::map<std::string, Rule>& rules) {
  std::vector<std::string> found;
  for (const char* top : {"src", "include", "apps"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path& file = entry.path();
      if (!is_source(file)) continue;
      const fs::path below_root = fs::relative(file, root);
      const Place place = place_of(below_root);
      const auto rule = rules.find(place.room);
      if (rule == rules.end()) {
        found.push_back(below_root.string() + ":1: no room " + place.room + " in src/README.md");
        continue;
      }
      for (const Include& include : includes_of(file)) {
        const std::string why = objection(include, place, file.parent_path(), rule->second, rules);
        if (!why.empty())
          found.push_back(below_root.string() + ":" + std::to_string(include.line) + ": " + why);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace bernal::layering
