#include "formats/snappy_case.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "formats/format.hpp"
#include "formats/templates.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

namespace fs = std::filesystem;

std::string vertices_of(const Bounds<3>& bounds) {
  const Vector<3>&lower = bounds.lower, &upper = bounds.upper;
  std::string corners;
  for (int corner = 0; corner < 8; ++corner) {
    // In the order of hexahedra: around the bottom, then around the top.
    const bool x = (corner & 3) == 1 || (corner & 3) == 2, y = (corner & 2) != 0, z = (corner & 4) != 0;
    corners +=
        "    " +
        point_for_openfoam({x ? upper[0] : lower[0], y ? upper[1] : lower[1], z ? upper[2] : lower[2]}) +
        "\n";
  }
  return corners;
}

std::string patch_of_block(std::string_view name, std::string_view type, const std::string& faces) {
  return fmt::format("    {}\n    {{\n        type {};\n        faces ({});\n    }}\n", name, type, faces);
}

std::string block_mesh(const SnappyCase& of) {
  constexpr std::array<std::string_view, 6> faces = {"(0 4 7 3)", "(1 2 6 5)", "(0 1 5 4)",
                                                     "(3 7 6 2)", "(0 3 2 1)", "(4 5 6 7)"};
  const auto name = [](std::size_t face) {
    return fmt::format("{}_{}", "xyz"[face / 2], face % 2 == 0 ? "lower" : "upper");
  };
  std::string patches, outside;
  for (std::size_t face = 0; face < 6; ++face) {
    if (of.block.periodic[face / 2]) {
      patches += patch_of_block(name(face), "cyclic;\n        neighbourPatch " + name(face ^ 1U),
                                std::string(faces[face]));
    } else if (of.block.is_container) {
      patches += patch_of_block(name(face), "wall", std::string(faces[face]));
    } else {
      outside += std::string(outside.empty() ? "" : " ") + std::string(faces[face]);
    }
  }
  // Of which nothing is left in the mesh.
  if (!outside.empty()) patches += patch_of_block("outside", "wall", outside);
  return filled(snappy_blockMeshDict, {{"TITLE", of.title},
                                       {"CORNERS", vertices_of(of.block.bounds)},
                                       {"CELLS", fmt::format("{}", fmt::join(of.block.cells, " "))},
                                       {"PATCHES", patches}});
}

std::string levels_of(const SnappyCase::Part& part, std::string_view indent) {
  std::string words = fmt::format("{}level ({} {});\n", indent, part.level, part.level_in_curves);
  // Where opposite surfaces leave fewer than three cells.
  if (part.level_in_gaps > 0)
    words += fmt::format("{}gapLevel (3 {} {});\n", indent, part.level, part.level_in_gaps);
  return words + fmt::format("{}patchInfo {{ type {};{} }}\n", indent, part.type,
                             part.group.empty() ? "" : fmt::format(" inGroups ({});", part.group));
}

std::string snappy_dict(const SnappyCase& of) {
  std::string surfaces, levels, layers, features;
  for (const SnappyCase::Surface& surface : of.surfaces) {
    std::string regions, levels_of_regions;
    const bool has_regions = surface.parts.size() > 1 || surface.parts.front().name != surface.name;
    for (const SnappyCase::Part& part : surface.parts) {
      if (has_regions) {
        regions += fmt::format("            {0} {{ name {0}; }}\n", part.name);
        levels_of_regions += fmt::format("                {}\n                {{\n{}                }}\n",
                                         part.name, levels_of(part, "                    "));
      }
      if (part.layers > 0)
        layers += fmt::format("        {} {{ nSurfaceLayers {}; }}\n", part.name, part.layers);
    }
    surfaces += fmt::format("    {}\n    {{\n        type triSurfaceMesh;\n        name {};\n{}    }}\n",
                            surface.file, surface.name,
                            has_regions ? "        regions\n        {\n" + regions + "        }\n" : "");
    levels += fmt::format("        {}\n        {{\n", surface.name);
    if (has_regions) {
      const auto lowest = std::ranges::min(surface.parts, {}, &SnappyCase::Part::level);
      levels += fmt::format(
          "            level ({0} {0});\n            regions\n            {{\n{1}            }}\n",
          lowest.level, levels_of_regions);
    } else {
      levels += levels_of(surface.parts.front(), "            ");
    }
    levels += "        }\n";
  }
  for (const SnappyCase::Edges& edges : of.edges)
    features += fmt::format("        {{ file \"{}\"; level {}; }}\n", edges.file, edges.level);
  return filled(snappy_snappyHexMeshDict, {{"SURFACES", surfaces},
                                           {"FEATURES", features},
                                           {"LEVELS", levels},
                                           {"ADDS", layers.empty() ? "false" : "true"},
                                           {"LAYERS", layers},
                                           {"HEIGHT", fmt::format("{:.6g}", of.layers_height)},
                                           {"GROWTH", fmt::format("{:.6g}", of.layers_growth)},
                                           {"CLEARANCE", fmt::format("{:.6g}", of.clearance)},
                                           {"PROVEN", of.is_proven ? " (proven)" : ""},
                                           {"INSIDE", point_for_openfoam(of.inside)}});
}

}  // namespace

void SnappyCase::Block::divide(double edge) {
  constexpr int most = 2000;
  for (int k = 0; k < 3; ++k)
    cells[static_cast<std::size_t>(k)] =
        std::clamp(static_cast<int>(std::ceil(bounds.size()[k] / edge)), 1, most);
}

void write_snappy_case(const SnappyCase& of, StagedFolder& staged) {
  staged.write("system/blockMeshDict", block_mesh(of));
  staged.write("system/snappyHexMeshDict", snappy_dict(of));
  staged.write("Allmesh", filled(snappy_Allmesh, {{"TITLE", of.title}}));
  std::error_code ignored;  // the file system may not support permissions
  fs::permissions(staged.written("Allmesh"), fs::perms::owner_exec | fs::perms::group_exec,
                  fs::perm_options::add, ignored);
}

void write_edges_as_obj(const std::vector<Vector<3>>& vertices, const SharpEdges& edges, double scale,
                        const fs::path& to) {
  TextFile out(to);
  std::vector<std::uint32_t> number(vertices.size(), 0);
  std::uint32_t written = 0;
  for (const auto& ends : edges)
    for (const std::uint32_t v : ends) {
      if (number[v] != 0) continue;
      number[v] = ++written;
      out.add("v ", scale * vertices[v][0], ' ', scale * vertices[v][1], ' ', scale * vertices[v][2], "\n");
    }
  for (const auto& [a, b] : edges) out.add("l ", number[a], ' ', number[b], "\n");
  out.close();
}

std::vector<std::array<std::string_view, 2>> system_files_of_openfoam() {
  return {{"system/controlDict", snappy_controlDict},
          {"system/fvSchemes", snappy_fvSchemes},
          {"system/fvSolution", snappy_fvSolution}};
}

std::string point_for_openfoam(const Vector<3>& p) { return fmt::format("({})", row_of(p)); }

}  // namespace bernal
