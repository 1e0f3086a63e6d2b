#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "cells/cell_file.hpp"
#include "cells/vtk_appended.hpp"
#include "files/output_file.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

constexpr double usual_density = 0.05;

struct Strut {
  CellEdge edge;
  Vector<3> from, to;
  bool at_wall = false;
};

/// The edges in which cells meet, each once a period; those where two flat pieces of a wall meet in one cell
/// are none.
std::vector<Strut> struts_of(const Cells& cells) {
  std::vector<std::pair<CellEdge, bool>> all;
  for (std::uint32_t f = 0; f < cells.faces.size(); ++f) {
    const auto loop = cells.corners_of(f);
    const std::size_t count = cells.dimension == 2 ? 1 : loop.size();
    for (std::size_t k = 0; k < count; ++k)
      all.emplace_back(cell_edge(loop[k], loop[(k + 1) % loop.size()]), cells.faces[f].wall != Cells::none);
  }
  std::ranges::sort(all);
  std::vector<Strut> struts;
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    for (last = first; last < all.size() && all[last].first == all[first].first;) ++last;
    if (all[first].second) continue;  // sorted behind the faces between cells: there are none
    const CellEdge& edge = all[first].first;
    struts.push_back(
        {edge, cells.place({edge.from, {}}), cells.place({edge.to, edge.image}), all[last - 1].second});
  }
  return struts;
}

double length_of(const std::vector<Strut>& struts) {
  double length = 0;
  for (const Strut& strut : struts) length += (strut.to - strut.from).norm();
  return length;
}

/// The asked one, else that with which rods of this length have the asked share of the volume.
double radius_of(const CellFile& file, double length) {
  if (file.options.strut_radius) return *file.options.strut_radius;
  const double volume = file.options.strut_density.value_or(usual_density) * file.cells.volume;
  return file.cells.dimension == 2 ? 0.5 * volume / length : std::sqrt(volume / (std::numbers::pi * length));
}

void write_struts_csv(const CellFile& file, const std::vector<Strut>& struts, double radius,
                      StagedFolder& staged) {
  TextFile out(staged.add(file.name.string()));
  out.add("# unit: ", file.unit(), "\nfrom,to,image_x,image_y,image_z,x0,y0,z0,x1,y1,z1,radius,at_wall\n");
  for (const Strut& strut : struts) {
    out.add(strut.edge.from, ",", strut.edge.to);
    for (const std::int8_t shift : strut.edge.image) out.add(",", static_cast<int>(shift));
    for (const Vector<3>* p : {&strut.from, &strut.to})
      for (int k = 0; k < 3; ++k) out.add(",", (*p)[k]);
    out.add(",", radius, ",", strut.at_wall ? 1 : 0, "\n");
  }
  out.close();
}

void write_struts_vtp(const CellFile& file, const std::vector<Strut>& struts, double radius,
                      StagedFolder& staged) {
  std::map<std::pair<std::uint32_t, Cells::Image>, std::int64_t> number;
  std::vector<double> points, radii(struts.size(), radius), lengths;
  std::vector<std::int64_t> connectivity, offsets, at_wall;
  const auto add_end = [&](std::uint32_t corner, const Cells::Image& image, const Vector<3>& p) {
    const auto [at, is_new] = number.try_emplace({corner, image}, static_cast<std::int64_t>(number.size()));
    if (is_new) points.insert(points.end(), {p[0], p[1], p[2]});
    connectivity.push_back(at->second);
  };
  for (const Strut& strut : struts) {
    add_end(strut.edge.from, {}, strut.from);
    add_end(strut.edge.to, strut.edge.image, strut.to);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    at_wall.push_back(strut.at_wall);
    lengths.push_back((strut.to - strut.from).norm());
  }
  VtkAppended data;
  std::string text = fmt::format(R"(<?xml version="1.0"?>
<!-- {}; lengths in {} -->
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <PolyData>
    <Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="0">
      <Points>
)",
                                 file.title(), file.unit(), points.size() / 3, struts.size());
  text += data.tag("Float64", "Points", points, 3) + "      </Points>\n      <Lines>\n";
  text += data.tag("Int64", "connectivity", connectivity) + data.tag("Int64", "offsets", offsets);
  text += "      </Lines>\n      <CellData Scalars=\"radius\">\n";
  text += data.tag("Float64", "radius", radii) + data.tag("Float64", "length", lengths);
  text += data.tag("Int64", "at_wall", at_wall);
  text += "      </CellData>\n    </Piece>\n  </PolyData>\n";
  OutputFile out(staged.add(file.name.string()));
  out.append(text);
  data.append_to(out);
  out.close();
}

std::string write_struts(const CellFile& file, StagedFolder& staged) {
  const std::string ending = file.name.extension().string();
  if (ending != ".vtp" && ending != ".csv")
    throw Error(ErrorCode::bad_argument,
                "struts are written as .vtp or .csv: let the name end in one of these", {file.name.string()});
  const std::vector<Strut> struts = struts_of(file.cells);
  if (struts.empty())
    throw Error(ErrorCode::bad_argument, "there are no struts: the cells meet in no edge away from the walls",
                {file.name.string()});
  const double length = length_of(struts), radius = radius_of(file, length);
  (ending == ".csv" ? write_struts_csv : write_struts_vtp)(file, struts, radius, staged);
  const double share = file.cells.dimension == 2
                           ? 2 * radius * length / file.cells.volume
                           : std::numbers::pi * radius * radius * length / file.cells.volume;
  return fmt::format(
      "; {} struts of {:.6g} {} together, radius {:.6g} {}: {:.4g} of the volume, counted without "
      "what they share where they meet",
      struts.size(), length, file.unit(), radius, file.unit(), share);
}

}  // namespace

CellWriter struts_of_cells() {
  return {.format = {"struts", "edges of a foam as lines with radii, each once a period: .vtp or .csv",
                     ".vtp", 2},
          .has_struts = true,
          .write = write_struts};
}

}  // namespace bernal
