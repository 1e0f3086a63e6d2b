#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "cells/cell_file.hpp"
#include "cells/neper_domain.hpp"
#include "cells/placed_cells.hpp"
#include "formats/text_file.hpp"

// Source: the Neper Reference Manual, "Tessellation File (.tess)", format 3.5. A weight of Neper's is a
// radius: it cuts at |x - c|² - w².

namespace bernal {
namespace {

/// The unit normal of a face, by the areas of its triangles, and how far it is from the origin.
Cells::Wall plane_of(const PlacedCells& placed, const PlacedCells::Face& face) {
  Vector<3> twice = Vector<3>::Zero(), middle = Vector<3>::Zero();
  const Vector<3>& apex = placed.nodes[face.nodes[0]];
  for (std::size_t k = 0; k < face.nodes.size(); ++k) {
    middle += placed.nodes[face.nodes[k]] / static_cast<double>(face.nodes.size());
    twice += (placed.nodes[face.nodes[k]] - apex)
                 .cross(placed.nodes[face.nodes[(k + 1) % face.nodes.size()]] - apex);
  }
  const Vector<3> normal = twice.stableNormalized();
  return {normal, normal.dot(middle), {}};
}

/// Cells are named where their numbers are not those of the spheres, which count from 1 here.
void write_cells_section(const CellFile& file, const std::vector<std::uint32_t>& full, TextFile& out) {
  out.add(" **cell\n  ", full.size(), "\n");
  if (full.size() < file.cells.size()) {
    out.add("  *id\n  ");
    for (std::size_t k = 0; k < full.size(); ++k) out.add(" ", full[k] + 1, k % 10 == 9 ? "\n  " : "");
    out.add("\n");
  }
  out.add("  *seed\n");
  for (std::size_t k = 0; k < full.size(); ++k) {
    const Vector<3>& p = file.cells.centers[full[k]];
    out.add("   ", k + 1, " ", p[0], " ", p[1], " ", p[2], " ", file.cells.radii[full[k]], "\n");
  }
}

void write_shapes(const PlacedCells& placed, const std::vector<std::uint32_t>& full, TextFile& out) {
  out.add(" **vertex\n  ", placed.nodes.size(), "\n");
  for (std::size_t n = 0; n < placed.nodes.size(); ++n) {
    const Vector<3>& p = placed.nodes[n];
    out.add("   ", n + 1, " ", p[0], " ", p[1], " ", p[2], " 0\n");
  }
  out.add(" **edge\n  ", placed.edges.size(), "\n");
  for (std::size_t e = 0; e < placed.edges.size(); ++e)
    out.add("   ", e + 1, " ", placed.edges[e].from + 1, " ", placed.edges[e].to + 1, " 0\n");
  out.add(" **face\n  ", placed.faces.size(), "\n");
  for (std::size_t f = 0; f < placed.faces.size(); ++f) {
    const PlacedCells::Face& face = placed.faces[f];
    out.add("   ", f + 1, " ", face.nodes.size());
    for (const std::uint32_t node : face.nodes) out.add(" ", node + 1);
    out.add("\n     ", face.edges.size());
    for (const std::int64_t edge : face.edges) out.add(" ", edge);
    const Cells::Wall plane = plane_of(placed, face);
    out.add("\n     ", plane.offset, " ", plane.normal[0], " ", plane.normal[1], " ", plane.normal[2],
            "\n     0 0 0 0 0\n");
  }
  out.add(" **polyhedron\n  ", full.size(), "\n");
  for (std::size_t k = 0; k < full.size(); ++k) {
    const std::vector<std::int64_t>& faces = placed.faces_of_cell[full[k]];
    out.add("   ", k + 1, " ", faces.size());
    for (const std::int64_t face : faces) out.add(" ", face);
    out.add("\n");
  }
}

void add_image(TextFile& out, std::size_t number, std::size_t of, const Cells::Image& image) {
  out.add("   ", number + 1, " ", of + 1);
  for (const std::int8_t shift : image) out.add(" ", static_cast<int>(shift));
}

void write_periods(const CellFile& file, const PlacedCells& placed, std::size_t seeds, TextFile& out) {
  const Vector<3>& periods = file.cells.periods;
  out.add(" **periodicity\n  *general\n  ");
  for (int k = 0; k < 3; ++k) out.add(" ", periods[k] > 0 ? 1 : 0);
  const Vector<3> size = bounds_of(file.packing.domain).size();
  out.add("\n   ", size[0], " ", size[1], " ", size[2], "\n");
  std::vector<Cells::Image> around;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Cells::Image image{static_cast<std::int8_t>(x), static_cast<std::int8_t>(y),
                                 static_cast<std::int8_t>(z)};
        bool is_there = image != Cells::Image{};
        for (int k = 0; k < 3; ++k) is_there &= periods[k] > 0 || image[static_cast<std::size_t>(k)] == 0;
        if (is_there) around.push_back(image);
      }
  out.add("  *seed\n   ", around.size() * seeds, "\n");
  std::size_t number = seeds;
  for (const Cells::Image& image : around)
    for (std::size_t k = 0; k < seeds; ++k) {
      add_image(out, number++, k, image);
      out.add("\n");
    }
  const auto images_in = [&](const auto& all, const auto& origin_of) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < all.size(); ++k) count += origin_of(k).first != k;
    return count;
  };
  const auto of_node = [&](std::size_t k) { return placed.origin_of_node[k]; };
  out.add("  *vertex\n   ", images_in(placed.nodes, of_node), "\n");
  for (std::size_t n = 0; n < placed.nodes.size(); ++n) {
    if (of_node(n).first == n) continue;
    add_image(out, n, of_node(n).first, of_node(n).image);
    out.add("\n");
  }
  const auto of_edge = [&](std::size_t k) { return placed.edges[k].origin; };
  out.add("  *edge\n   ", images_in(placed.edges, of_edge), "\n");
  for (std::size_t e = 0; e < placed.edges.size(); ++e) {
    if (of_edge(e).first == e) continue;
    add_image(out, e, of_edge(e).first, of_edge(e).image);
    out.add(placed.edges[e].is_backwards ? " -1\n" : " 1\n");
  }
  const auto of_face = [&](std::size_t k) { return placed.faces[k].origin; };
  out.add("  *face\n   ", images_in(placed.faces, of_face), "\n");
  for (std::size_t f = 0; f < placed.faces.size(); ++f) {
    if (of_face(f).first == f) continue;
    add_image(out, f, of_face(f).first, of_face(f).image);
    out.add(" -1\n");
  }
}

/// Seeds from the lowest corner of a box, where Neper's domains begin.
void write_seeds(const CellFile& file, const std::vector<std::uint32_t>& full, StagedFolder& staged) {
  TextFile places(staged.add(beside(file.name, ".coo"))), weights(staged.add(beside(file.name, ".weight")));
  const Vector<3> corner = bounds_of(file.packing.domain).lower;
  for (const std::uint32_t i : full) {
    const Vector<3> p = file.cells.centers[i] - corner;
    places.add(p[0], " ", p[1], " ", p[2], "\n");
    weights.add(file.cells.radii[i], "\n");
  }
  places.close();
  weights.close();
}

/// How Neper makes the cells itself of the seeds, in a box.
std::string call_of_neper(const CellFile& file, std::size_t cells) {
  if (!std::holds_alternative<Box>(file.packing.domain)) return {};
  const Vector<3> size = bounds_of(file.packing.domain).size();
  std::string axes;
  for (int k = 0; k < 3; ++k)
    if (file.cells.periods[k] > 0) axes += "xyz"[k];
  return fmt::format(
      "; Neper makes them itself with: neper -T -n {} -morpho voronoi -domain \"cube({},{},{})\"{} "
      "-morphooptiini \"coo:file({}),weight:file({})\"",
      cells, size[0], size[1], size[2],
      axes.empty()       ? ""
      : axes.size() == 3 ? " -periodicity all"
                         : " -periodicity " + axes,
      plain_text(beside(file.name, ".coo")), plain_text(beside(file.name, ".weight")));
}

std::string write_neper(const CellFile& file, StagedFolder& staged) {
  const PlacedCells shapes = placed(file.cells);
  std::vector<std::uint32_t> full;
  for (std::uint32_t i = 0; i < file.cells.size(); ++i)
    if (!file.cells.is_empty(i)) full.push_back(i);
  const bool repeats = file.cells.periods.maxCoeff() > 0;
  TextFile out(staged.add(file.name.string()));
  out.add("***tess\n **format\n   3.5\n **general\n   3 ", repeats ? "periodic" : "standard", "\n");
  write_cells_section(file, full, out);
  write_shapes(shapes, full, out);
  write_neper_domain(file, shapes, out);
  if (repeats) write_periods(file, shapes, full.size(), out);
  out.add("***end\n");
  out.close();
  write_seeds(file, full, staged);
  return fmt::format("; lengths in {}{}", file.unit(), call_of_neper(file, full.size()));
}

}  // namespace

CellWriter neper_of_cells() {
  return {.format = {"neper", "Neper: a tessellation (.tess), and its seeds and weights beside it", ".tess"},
          .endings = {".coo", ".weight"},
          .write = write_neper};
}

}  // namespace bernal
