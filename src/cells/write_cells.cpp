#include "bernal/cells/write_cells.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/measure/cell_weights.hpp"
#include "bernal/version.hpp"
#include "cells/cell_file.hpp"
#include "core/parallel.hpp"
#include "formats/text_file.hpp"
#include "result/free_places.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

const std::vector<CellWriter>& cell_writers() {
  static const std::vector<CellWriter> all = {vtu_of_cells(),  obj_of_cells(),    neper_of_cells(),
                                              gmsh_of_cells(), struts_of_cells(), nrrd_of_cells(),
                                              vti_of_cells(),  npy_of_cells()};
  return all;
}

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

const CellWriter& writer_of(const std::string& name) {
  std::vector<std::string_view> names;
  for (const CellWriter& writer : cell_writers()) {
    if (writer.format.name == name) return writer;
    names.emplace_back(writer.format.name);
  }
  refuse(fmt::format("unknown format of cells \"{}\"{}", plain_text(name), remedy(name, names)));
}

void require_positive(const std::optional<double>& value, const char* what, double most) {
  if (value && !(*value > 0 && *value < most))
    refuse(fmt::format("{} must be above 0 and below {}, not {}", what, most, *value));
}

std::string cells_in_words(const CellFile& file) {
  const Cells& cells = file.cells;
  std::string words = fmt::format("{} cells", grouped(file.full()));
  if (file.full() < cells.size())
    words += fmt::format(" of {} spheres, of which the others are hidden", grouped(cells.size()));
  if (cells.deviation > 0)
    words += fmt::format("; round walls are flat in {} steps around, off by up to {:.2g} {}",
                         file.options.cells.sides, cells.deviation, file.unit());
  return words;
}

}  // namespace

std::string CellFile::title() const {
  return fmt::format("bernal {}: cells of {} spheres in a {}", text_of(this_program()),
                     grouped(packing.spheres.size()), name_of(packing.domain));
}

std::uint32_t CellFile::full() const {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) count += !cells.is_empty(i);
  return count;
}

std::string beside(const fs::path& name, std::string_view ending) {
  fs::path other = name;
  other.replace_extension(ending);
  return other.string();
}

Cells cells_of(const Packing& packing, const CellsOptions& options) {
  return cells_of(with_weights(packing.spheres, packing.weights), packing.domain, options);
}

ShapedCells shaped_cells_of(const Packing& packing, const CellsOptions& options) {
  ShapedCells made{.cells = cells_of(packing, options)};
  made.shapes = shapes_of(made.cells);
  return made;
}

std::vector<CellFormat> cell_formats() {
  std::vector<CellFormat> all;
  for (const CellWriter& writer : cell_writers()) all.push_back(writer.format);
  return all;
}

void require_cell_format(const CellFileOptions& options, int dimension) {
  const CellWriter& writer = writer_of(options.format);
  const CellFormat& format = writer.format;
  if (dimension < format.least_dimension || dimension > 3)
    refuse(fmt::format("the format {} is for cells of {} dimensions, not of {}", format.name,
                       format.least_dimension == 2 ? "two or three" : "three", dimension));
  if ((options.strut_radius || options.strut_density) && !writer.has_struts)
    refuse(fmt::format("the format {} has no struts; struts does", format.name));
  if (options.strut_radius && options.strut_density)
    refuse("struts have a radius or a share of the volume; give one of ‹radius› and ‹density›");
  require_positive(options.strut_radius, "‹radius›", 1e30);
  require_positive(options.strut_density, "‹density›", 1);
  if ((options.voxel || options.resolution) && !writer.is_image)
    refuse(fmt::format("the format {} has no voxels; nrrd, vti and npy have", format.name));
  if (options.voxel && options.resolution)
    refuse("voxels have an edge or a number along the longest one; give one of ‹voxel› and ‹resolution›");
}

WrittenCells write_cells(const Packing& packing, const CellFileOptions& options, const fs::path& named,
                         const Monitor& monitor, const ShapedCells* made) {
  require_cell_format(options, packing.spheres.dimension());
  const CellWriter& writer = writer_of(options.format);
  const fs::path name = named.filename(), folder = folder_of(named);
  std::vector<std::string> names{name.string()};
  for (const std::string_view ending : writer.endings) {
    names.push_back(beside(name, ending));
    if (names.back() == names.front())
      refuse(fmt::format("{} is a file that goes with the one of cells; let the name end in {}",
                         plain_text(names.front()), writer.format.ending));
  }
  require_free(folder, names);
  const Interruptible interruptible(monitor);
  require_closed_walls(packing.domain, "a file of cells");
  if (packing.spheres.empty()) refuse("there are no spheres, and no cells");
  const ShapedCells own = made || writer.is_image ? ShapedCells() : shaped_cells_of(packing, options.cells);
  const auto& [cells, shapes] = made ? *made : own;
  const CellFile file{.packing = packing,
                      .options = options,
                      .name = name,
                      .cells = cells,
                      .shapes = shapes,
                      .monitor = monitor};
  StagedFolder staged(folder);
  WrittenCells written;
  written.note = writer.write(file, staged);
  if (!writer.is_image) written.note = cells_in_words(file) + written.note;
  written.files = staged.publish();
  for (fs::path& path : written.files) path = path.lexically_normal();
  return written;
}

void write_cell_table(const Packing& packing, const ShapedCells& made, const fs::path& file) {
  const auto& [cells, shapes] = made;
  const fs::path folder = folder_of(file), name = file.filename();
  require_free(folder, {name.string()});
  StagedFolder staged(folder);
  TextFile out(staged.add(name.string()));
  const bool flat = cells.dimension == 2;
  out.add("# unit: ", name_of(packing.scene.unit), "\n",
          flat ? "x0,x1,r,area,outline" : "x,y,z,r,volume,surface", flat ? ",cx0,cx1" : ",cx,cy,cz",
          ",sphericity,aspect,faces,neighbours,edges,corners\n");
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const CellShape& shape = shapes[i];
    for (int k = 0; k < cells.dimension; ++k) out.add(cells.centers[i][k], ",");
    out.add(packing.spheres.r[i], ",", shape.volume, ",", shape.surface);
    for (int k = 0; k < cells.dimension; ++k) out.add(",", shape.centroid[k]);
    out.add(",", shape.sphericity, ",", shape.aspect, ",", shape.faces, ",", shape.neighbours, ",",
            shape.edges, ",", shape.corners, "\n");
  }
  out.close();
  staged.publish();
}

}  // namespace bernal
