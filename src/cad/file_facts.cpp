#include "cad/file_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

namespace bernal::cad {
namespace {

/// One tag of an XML document: enough for attributes near the root.
struct Tag {
  std::string_view name;        // without a prefix of a namespace
  std::string_view attributes;  // as they stand
  std::string_view text;        // up to the next tag
  int depth = 0;                // 0: the root
};

/// Calls visit(tag) for opening tags in their order until it returns false.
template <typename Visit>
void for_each_tag(std::string_view xml, const Visit& visit) {
  int depth = 0;
  for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
    const std::string_view rest = xml.substr(at);
    const auto skip_behind = [&](std::string_view end) {
      const std::size_t found = xml.find(end, at);
      at = found == std::string_view::npos ? xml.size() : found + end.size();
    };
    if (rest.starts_with("<!--")) {
      skip_behind("-->");
    } else if (rest.starts_with("<![CDATA[")) {
      skip_behind("]]>");
    } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
      skip_behind(">");
    } else if (rest.starts_with("</")) {
      --depth;
      skip_behind(">");
    } else {
      const std::size_t end = xml.find('>', at);
      if (end == std::string_view::npos) return;
      std::string_view inside = xml.substr(at + 1, end - at - 1);
      const bool closed = inside.ends_with('/');
      if (closed) inside.remove_suffix(1);
      Tag tag;
      const std::size_t name_end = std::min(inside.find_first_of(" \t\r\n"), inside.size());
      tag.name = inside.substr(0, name_end);
      if (const std::size_t colon = tag.name.find(':'); colon != std::string_view::npos)
        tag.name.remove_prefix(colon + 1);
      tag.attributes = inside.substr(name_end);
      tag.text = xml.substr(end + 1, std::min(xml.find('<', end), xml.size()) - end - 1);
      tag.depth = depth;
      if (!visit(tag)) return;
      if (!closed) ++depth;
      at = end + 1;
    }
  }
}

std::string without_entities(std::string_view text) {
  std::string result(text);
  for (const auto& [entity, letter] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}})
    for (std::size_t at = result.find(entity); at != std::string::npos; at = result.find(entity, at + 1))
      result.replace(at, std::string_view(entity).size(), letter);
  return result;
}

std::optional<std::string> attribute(std::string_view attributes, std::string_view name) {
  for (std::size_t at = attributes.find(name); at != std::string_view::npos;
       at = attributes.find(name, at + 1)) {
    if (at == 0 || std::isspace(static_cast<unsigned char>(attributes[at - 1])) == 0) continue;
    const std::size_t sign = attributes.find_first_not_of(" \t\r\n", at + name.size());
    if (sign == std::string_view::npos || attributes[sign] != '=') continue;
    const std::size_t open = attributes.find_first_of("\"'", sign);
    if (open == std::string_view::npos) return std::nullopt;
    const std::size_t close = attributes.find(attributes[open], open + 1);
    if (close == std::string_view::npos) return std::nullopt;
    return without_entities(attributes.substr(open + 1, close - open - 1));
  }
  return std::nullopt;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

constexpr std::pair<std::string_view, double> units_by_name[] = {
    {"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254},
    {"foot", 0.3048}, {"feet", 0.3048},     {"meter", 1},
};

/// The unit that an attribute names, millimetre if there is none.
void set_unit(const std::optional<std::string>& name, FileFacts& facts) {
  if (!name) {
    facts.unit = FileFacts::Length{1e-3, "millimeter"};
    facts.notes.push_back("the file names no unit, which means millimeter");
    return;
  }
  for (const auto& [known, metres] : units_by_name)
    if (*name == known) facts.unit = FileFacts::Length{metres, *name};
  if (!facts.unit) facts.notes.push_back(fmt::format("the file's unit \"{}\" is none of its format", *name));
}

}  // namespace

FileFacts facts_of_collada(std::string_view xml) {
  FileFacts facts;
  bool in_own_asset = false, said = false;
  for_each_tag(xml, [&](const Tag& tag) {
    if (tag.depth <= 1) in_own_asset = tag.depth == 1 && tag.name == "asset";
    if (!in_own_asset || tag.depth != 2) return true;
    if (tag.name == "up_axis") {
      const std::string_view axis = trimmed(tag.text);
      if (axis == "X_UP") facts.up = 'x';
      if (axis == "Y_UP") facts.up = 'y';
      if (axis == "Z_UP") facts.up = 'z';
    } else if (tag.name == "unit") {
      said = true;
      const std::string meter = attribute(tag.attributes, "meter").value_or("1");
      const std::string_view digits = trimmed(meter);
      double metres = 0;
      std::from_chars(digits.data(), digits.data() + digits.size(), metres);
      if (metres > 0 && std::isfinite(metres)) {
        std::string name = attribute(tag.attributes, "name").value_or("");
        if (name.empty()) name = metres == 1 ? "meter" : fmt::format("{} m", metres);
        facts.unit = FileFacts::Length{metres, std::move(name)};
      } else {
        facts.notes.push_back(fmt::format("the file's unit is \"{}\" metres, which is none", meter));
      }
    }
    return true;
  });
  if (!said) facts.unit = FileFacts::Length{1, "meter"};
  return facts;
}

FileFacts facts_of_amf(std::string_view xml) {
  FileFacts facts;
  for_each_tag(xml, [&](const Tag& tag) {
    if (tag.name == "amf") set_unit(attribute(tag.attributes, "unit"), facts);
    return false;
  });
  return facts;
}

namespace {

/// The objects of a 3MF by their ids: faces of their own, and other objects that they hold.
struct ThreeMfObject {
  double faces = 0;
  std::vector<std::string> components = {};
  enum { unseen, open, counted } state = unseen;
};
using ThreeMfObjects = std::map<std::string, ThreeMfObject>;

constexpr int most_nested_objects = 1000;
constexpr double most_3mf_faces = 1e9;

struct Unbuildable {
  std::string why;
};

/// Of the object and all that it holds. Throws Unbuildable.
double faces_of(const std::string& id, ThreeMfObjects& objects, int level = 0) {
  const auto found = objects.find(id);
  if (found == objects.end()) throw Unbuildable{"it names an object that it does not hold"};
  ThreeMfObject& object = found->second;
  if (object.state == ThreeMfObject::open) throw Unbuildable{"one of its objects is a part of itself"};
  if (level == most_nested_objects) throw Unbuildable{"its objects are nested more than a thousand deep"};
  if (object.state == ThreeMfObject::unseen) {
    object.state = ThreeMfObject::open;
    for (const std::string& component : object.components)
      object.faces += faces_of(component, objects, level + 1);
    object.state = ThreeMfObject::counted;
  }
  return object.faces;
}

}  // namespace

ThreeMfFacts facts_of_3mf(std::string_view xml) {
  ThreeMfFacts result;
  ThreeMfObjects objects;
  std::string inside;  // the object whose tags these are
  double faces = 0;
  std::vector<std::string> items;
  for_each_tag(xml, [&](const Tag& tag) {
    const auto named = [&](std::string_view name) { return attribute(tag.attributes, name).value_or(""); };
    if (tag.depth == 0 && tag.name == "model") set_unit(attribute(tag.attributes, "unit"), result.facts);
    if (tag.name == "object") {
      inside = named("id");
      objects[inside];
      result.objects[inside] = {named("name"),
                                !attribute(tag.attributes, "type").value_or("model").ends_with("support")};
    } else if (tag.name == "triangle") {
      ++objects[inside].faces;
    } else if (tag.name == "component" && !attribute(tag.attributes, "p:path")) {
      objects[inside].components.push_back(named("objectid"));
    } else if (tag.name == "item" && !attribute(tag.attributes, "p:path")) {
      items.push_back(named("objectid"));
    }
    return true;
  });
  try {
    for (const std::string& item : items) faces += faces_of(item, objects);
    if (faces > most_3mf_faces) throw Unbuildable{"its objects repeat each other up to more than 1e9 faces"};
  } catch (const Unbuildable& unbuildable) {
    result.trouble = unbuildable.why;
  }
  return result;
}

std::string text_without_mark(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

}  // namespace bernal::cad
