#include "cad/read/known_formats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "bernal/cad/read_mesh.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {
namespace {

// The tested formats.
constexpr std::string_view read_formats[] = {".stl",  ".obj", ".ply",  ".off", ".3mf",  ".amf",
                                             ".gltf", ".glb", ".dae",  ".fbx", ".step", ".stp",
                                             ".iges", ".igs", ".brep", ".brp"};

struct NativeFormat {
  std::string_view extension, what;
};

// Formats that no reader knows: they hold surfaces or a recipe, not triangles.
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
    {".dxf", "a drawing (DXF)"},
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

// Whatever the name is.
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

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  constexpr std::size_t most_digits = 1000;  // longer words are no numbers
  std::string_view digits = trimmed(text);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  if (digits.empty() || digits.size() > most_digits) return {};
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)  // underflow gives 0, overflow infinity
    value = std::strtod(std::string(digits).c_str(), nullptr);
  const bool whole = error != std::errc::invalid_argument && end == digits.data() + digits.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string extension_of(const std::filesystem::path& file) {
  return in_lower_case(file.extension().string());
}

std::string why_no_mesh(const std::filesystem::path& file) {
  std::string head(1024, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));

  // A binary STL may begin with any words; its size identifies it.
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
  // Creo appends version numbers: part.prt.12
  if (extension.find_first_not_of("0123456789", 1) == std::string::npos)
    extension = extension_of(file.stem());
  for (const NativeFormat& format : native_formats)
    if (extension == format.extension) return fmt::format("is {}; export STEP or STL", format.what);
  for (const Beginning& beginning : beginnings)
    if (text.starts_with(beginning.bytes)) return fmt::format("is {}", beginning.what);

  const bool zipped_format = extension == ".3mf" || extension == ".amf";
  if (text.starts_with("PK\x03\x04") && !zipped_format)
    return "is a zip archive; unpack it and name the file inside";
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string words = in_lower_case(text.substr(0, 64));
  if (words.starts_with("<!doctype html") || words.starts_with("<html"))
    return "is a web page, not a CAD file; download the file itself";
  if (words.starts_with("iso-10303-21") && extension != ".step" && extension != ".stp" && extension != ".ifc")
    return "is a STEP file by its content; rename it to .step";
  if (!is_mesh_file_name(file))
    return fmt::format("has a name that ends in none of {}; export one of these",
                       fmt::join(read_formats, ", "));
  return {};
}

}  // namespace bernal::cad

namespace bernal {

std::span<const std::string_view> mesh_file_endings() { return cad::read_formats; }

bool is_mesh_file_name(const std::filesystem::path& file) {
  return std::ranges::find(cad::read_formats, cad::extension_of(file)) != std::end(cad::read_formats);
}

}  // namespace bernal
