#include "cad/file_facts.hpp"

#include <fmt/format.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
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

ThreeMfFacts facts_of_3mf(std::string_view xml) {
  ThreeMfFacts result;
  for_each_tag(xml, [&](const Tag& tag) {
    if (tag.depth == 0 && tag.name == "model") set_unit(attribute(tag.attributes, "unit"), result.facts);
    if (tag.name == "object")
      result.objects[attribute(tag.attributes, "id").value_or("")] = {
          attribute(tag.attributes, "name").value_or(""),
          !attribute(tag.attributes, "type").value_or("model").ends_with("support")};
    return true;
  });
  return result;
}

std::string zip_entry(const std::filesystem::path& archive, std::string_view ending) {
  const std::unique_ptr<void, int (*)(unzFile)> zip(unzOpen64(archive.c_str()), unzClose);
  if (!zip) return {};
  for (int next = unzGoToFirstFile(zip.get()); next == UNZ_OK; next = unzGoToNextFile(zip.get())) {
    char name[512];
    if (unzGetCurrentFileInfo64(zip.get(), nullptr, name, sizeof name, nullptr, 0, nullptr, 0) != UNZ_OK)
      break;
    name[sizeof name - 1] = '\0';
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!lower.ends_with(ending)) continue;
    if (unzOpenCurrentFile(zip.get()) != UNZ_OK) return {};
    std::string content;
    std::vector<char> piece(1U << 16U);
    int read = 0;
    while ((read = unzReadCurrentFile(zip.get(), piece.data(), static_cast<unsigned>(piece.size()))) > 0)
      content.append(piece.data(), static_cast<std::size_t>(read));
    unzCloseCurrentFile(zip.get());
    return content;
  }
  return {};
}

std::string text_without_mark(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

namespace {

struct NativeFormat {
  std::string_view extension, what;
};

// Of those that no reader knows; what they hold are surfaces or a recipe, not triangles.
constexpr NativeFormat native_formats[] = {
    {".sldprt", "a SolidWorks part"},
    {".sldasm", "a SolidWorks assembly"},
    {".slddrw", "a SolidWorks drawing"},
    {".prt", "a part of NX or Creo"},
    {".asm", "an assembly of Creo or Solid Edge"},
    {".par", "a Solid Edge part"},
    {".psm", "a Solid Edge sheet metal part"},
    {".ipt", "an Inventor part"},
    {".iam", "an Inventor assembly"},
    {".catpart", "a CATIA part"},
    {".catproduct", "a CATIA assembly"},
    {".cgr", "a CATIA representation"},
    {".x_t", "a Parasolid file"},
    {".x_b", "a Parasolid file"},
    {".xmt_txt", "a Parasolid file"},
    {".sat", "an ACIS file"},
    {".sab", "an ACIS file"},
    {".f3d", "a Fusion design"},
    {".f3z", "a Fusion assembly"},
    {".3dm", "a Rhino model"},
    {".dwg", "an AutoCAD drawing"},
    {".jt", "a JT file"},
    {".fcstd", "a FreeCAD document"},
    {".scad", "an OpenSCAD program"},
    {".skp", "a SketchUp model"},
    {".blend", "a Blender scene"},
    {".max", "a 3ds Max scene"},
    {".c4d", "a Cinema 4D scene"},
    {".ma", "a Maya scene"},
    {".mb", "a Maya scene"},
    {".nb", "a Mathematica notebook"},
    {".pdf", "a PDF document"},
};

struct Beginning {
  std::string_view bytes, what;
};

// Whatever the name says.
constexpr Beginning beginnings[] = {
    {"\x1f\x8b", "compressed by gzip; run gunzip on it first"},
    {"BZh", "compressed by bzip2; run bunzip2 on it first"},
    {"\xFD"
     "7zXZ",
     "compressed by xz; run unxz on it first"},
    {"7z\xBC\xAF", "a 7z archive; unpack it and name the file inside"},
    {"Rar!", "a RAR archive; unpack it and name the file inside"},
    {"version https://git-lfs.github.com/spec/v1",
     "a pointer of git-lfs, not the file itself; run git lfs pull"},
    {"version https://hawser.github.com/spec/v1",
     "a pointer of git-lfs, not the file itself; run git lfs pull"},
    {"%PDF", "a PDF document; export STEP or STL"},
    {"AC10", "an AutoCAD drawing; export STEP or STL"},
    {"BLENDER", "a Blender scene; export STL"},
    {"3D Geometry File Format", "a Rhino model; export STEP or STL"},
    {"**ABCDEFGHIJKLMNOPQRSTUVWXYZ", "a Parasolid file; export STEP or STL"},
    {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "a native document of a CAD or office program; export STEP or STL"},
    {"\x89PNG", "a picture; export STEP or STL"},
    {"\xFF\xD8\xFF", "a picture; export STEP or STL"},
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

}  // namespace

std::string known_not_to_be_a_mesh(const std::filesystem::path& file) {
  std::string head(1024, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));

  // A binary STL may begin with any words; its size tells it.
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  if (extension_of(file) == ".stl" && head.size() >= 84) {
    const auto byte = [&](std::size_t k) { return std::uint64_t{static_cast<unsigned char>(head[80 + k])}; };
    if (size == 84 + 50 * (byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U)) return {};
  }

  std::string_view text = head;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (const Beginning& beginning : beginnings)
    if (text.starts_with(beginning.bytes) && beginning.what.find("native") == std::string_view::npos)
      return fmt::format("is {}", beginning.what);
  std::string extension = extension_of(file);
  // Creo numbers its versions: part.prt.12
  if (extension.find_first_not_of("0123456789", 1) == std::string::npos)
    extension = extension_of(file.stem());
  for (const NativeFormat& format : native_formats)
    if (extension == format.extension) return fmt::format("is {}; export STEP or STL", format.what);
  for (const Beginning& beginning : beginnings)
    if (text.starts_with(beginning.bytes)) return fmt::format("is {}", beginning.what);

  const bool zipped_format =
      extension == ".3mf" || extension == ".amf" || extension == ".zae" || extension == ".q3s";
  if (text.starts_with("PK\x03\x04") && !zipped_format)
    return "is a zip archive; unpack it and name the file inside";
  const std::string words = lower(trimmed(text).substr(0, 64));
  if (words.starts_with("<!doctype html") || words.starts_with("<html"))
    return "is a web page, not a CAD file; download the file itself";
  if (words.starts_with("iso-10303-21") && extension != ".step" && extension != ".stp" && extension != ".ifc")
    return "is a STEP file by its content; rename it to .step";
  return {};
}

}  // namespace bernal::cad
