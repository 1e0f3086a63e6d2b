#include <fmt/format.h>

#include "formats/gmsh_model.hpp"
#include "formats/gmsh_script.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

std::string numbers(const Vector<3>& v) { return fmt::format("{}, {}, {}", v[0], v[1], v[2]); }

/// What makes volume 1.
struct PythonDomain {
  const GmshModel& model;

  std::string operator()(const Box& box) const {
    return fmt::format("    occ.addBox({}, {}, 1)\n", numbers(box.corner), numbers(box.size));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("    occ.addCylinder({}, {}, {}, 1)\n", numbers(cylinder.base),
                       numbers(cylinder.height * cylinder.axis.normalized()), cylinder.radius);
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("    occ.addSphere({}, {}, 1)\n", numbers(sphere.center), sphere.radius);
  }
  std::string operator()(const Mesh& mesh) const {
    std::string text = "    corners = [\n";
    for (const Vector<3>& v : mesh.vertices) text += fmt::format("        ({}),\n", numbers(v));
    text += "    ]\n    polygons = [  # loops of corners, the outline first\n";
    for (const FlatFace& face : model.faces) {
      text += "        [";
      for (const auto& loop : face.loops) {
        text += "[";
        for (const std::uint32_t v : loop) text += fmt::format("{}, ", v);
        text += "], ";
      }
      text += "],\n";
    }
    return text + R"(    ]
    points = [occ.addPoint(*p) for p in corners]
    lines = {}

    def line(a, b):
        if (b, a) in lines:
            return -lines[b, a]
        if (a, b) not in lines:
            lines[a, b] = occ.addLine(points[a], points[b])
        return lines[a, b]

    faces = []
    for loops in polygons:
        wires = [occ.addCurveLoop([line(a, b) for a, b in zip(loop, loop[1:] + loop[:1])]) for loop in loops]
        faces.append(occ.addPlaneSurface(wires))
    occ.addVolume([occ.addSurfaceLoop(faces)], 1)
)";
  }
  std::string operator()(const Polygon&) const { return {}; }
};

std::string data_of(const GmshModel& model) {
  std::string text =
      "# x, y, z, radius, type; axis and angle of a turn, which keeps seams off the cuts\nPIECES = [\n";
  for (std::size_t p = 0; p < model.solids.pieces.size(); ++p) {
    const Piece& piece = model.solids.pieces[p];
    const Turn& turn = model.turns[p];
    text += fmt::format("    ({}, {}, {}, {:.6g}, {:.6g}, {:.6g}, {:.6g}),\n", numbers(piece.center),
                        piece.radius, model.type_of(p), turn.axis[0], turn.axis[1], turn.axis[2], turn.angle);
  }
  text += "]\nCUT_AT_ENDS = [";  // volumes
  for (const std::size_t p : model.cut_pieces) text += fmt::format("{}, ", p + 2);
  for (const std::size_t b : model.cut_bridges) text += fmt::format("{}, ", model.first_bridge() + b);
  text += "]\nCAPS = {  # of a volume: cylinders on the planes of the cuts\n";
  for (std::size_t p = 0; p < model.caps.size(); ++p) {
    if (model.caps[p].empty()) continue;
    text += fmt::format("    {}: [", p + 2);
    for (const CapTool& cap : model.caps[p])
      text += fmt::format("({}, {}, {}), ", numbers(cap.base), numbers(cap.axis), cap.radius);
    text += "],\n";
  }
  text += "}\nBRIDGES = [  # centres of the rims, radius; longer inside of the spheres by the last number\n";
  for (const Bridge& bridge : model.solids.bridges)
    text += fmt::format("    ({}, {}, {}, {}),\n", numbers(bridge.rims[0]), numbers(bridge.rims[1]),
                        bridge.radius, bridge.radius);
  text +=
      "]\n# where gaps are narrow: point, normal, reach, size in the middle and beside, layer\nNARROW = "
      "np.array([\n";
  for (const NarrowPlace& place : model.places)
    text += fmt::format("    ({:.9g}, {:.9g}, {:.9g}, {:.6g}, {:.6g}, {:.6g}, {:.5g}, {:.5g}, {:.5g}, {}),\n",
                        place.point[0], place.point[1], place.point[2], place.normal[0], place.normal[1],
                        place.normal[2], place.reach, place.size, place.size_beside, place.layer);
  return text + "], dtype=float).reshape(-1, 10)\n";
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string names_of_types(const GmshModel& model) {
  std::string names;
  for (std::uint32_t type = 1; type <= model.file.type_count; ++type)
    names += toml_string(model.name_of_type(type)) + ", ";
  return names;
}

/// Exact volume fractions: of whole balls, each type once, and of the rest. None where solids meet that no
/// formula tells of.
std::string exact_fractions(const GmshModel& model) {
  if (model.file.contacts.meetings > 0 || !model.trouble().empty()) return {};
  const double total = volume_of(model.file.domain);
  std::vector<double> of_type(model.file.type_count, 0.0);
  const auto& radii = model.solids.spheres.r;
  for (std::size_t i = 0; i < radii.size(); ++i)
    of_type[model.file.types[i] - 1] += cap_volume(radii[i], 2 * radii[i]);
  const ContactReport& contacts = model.file.contacts;
  const bool cut = contacts.treatment == ContactTreatment::cap;
  double solid = 0;
  for (const double volume : of_type) solid += volume;
  if (contacts.treatment == ContactTreatment::bridge || cut) solid = contacts.volume_after;
  std::string text = fmt::format("\"matrix\": {}", 1 - solid / total);
  for (std::uint32_t type = 1; !cut && type <= model.file.type_count; ++type)
    text += fmt::format(", {}: {}", toml_string(model.name_of_type(type)), of_type[type - 1] / total);
  return text;
}

}  // namespace

std::string gmsh_python(const GmshModel& model) {
  const Exported& file = model.file;
  const auto word = [&](std::size_t k) { return model.periods[k] ? "True" : "False"; };
  std::string text = fmt::format(
      R"("""{title}; for Gmsh 4.8 and later, lengths in {unit}.

Conforming tetrahedra of the matrix and of every type of spheres, with physical groups. Debian: apt-get install
python3-gmsh python3-numpy; else pip install gmsh numpy.
"""
import argparse
import json
import sys
import time
from pathlib import Path

import gmsh
import numpy as np

NAMES = [{names}]  # of the types
EXACT = {{{exact}}}  # volume fractions
TROUBLE = {trouble}
LOWER, UPPER = np.array([{lower}]), np.array([{upper}])  # of the domain
PERIODIC = ({p0}, {p1}, {p2})
IS_BOX = {box}
LENGTH = {length}  # of the model, in the mesh's unit
MESH_SIZE, LARGEST_SIZE, MESH_ORDER = {size}, {largest}, {order}  # over the radius; of any element
)",
      fmt::arg("title", file.title()), fmt::arg("unit", model.unit_in_words()),
      fmt::arg("length", model.length()), fmt::arg("trouble", toml_string(model.trouble())),
      fmt::arg("names", names_of_types(model)), fmt::arg("exact", exact_fractions(model)),
      fmt::arg("lower", numbers(model.bounds.lower)), fmt::arg("upper", numbers(model.bounds.upper)),
      fmt::arg("p0", word(0)), fmt::arg("p1", word(1)), fmt::arg("p2", word(2)),
      fmt::arg("box", std::holds_alternative<Box>(file.domain) ? "True" : "False"),
      fmt::arg("size", file.output.mesh_size), fmt::arg("largest", model.largest_size),
      fmt::arg("order", file.output.mesh_order));
  return text + data_of(model) +
         replaced(std::string(gmsh_script), "@DOMAIN@", std::visit(PythonDomain{model}, file.domain));
}

}  // namespace bernal
