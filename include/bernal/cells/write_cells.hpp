#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/measure/cells.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// The cells of a packing: by its weights where it has such, see `Packing::weights`, else by radii.
Cells cells_of(const Packing&, const CellsOptions& = {});

/// Those cells and the shape of each: what all that is written of them is made from.
struct ShapedCells {
  Cells cells = {};
  std::vector<CellShape> shapes = {};
};
ShapedCells shaped_cells_of(const Packing&, const CellsOptions& = {});

/// A format that cells are written in.
struct CellFormat {
  std::string name;    ///< "vtu"
  std::string what;    ///< for whom, and what the file holds
  std::string ending;  ///< of the file's name: ".vtu"
  int least_dimension = 3;
};
/// All of them, in the order in which users see them.
std::vector<CellFormat> cell_formats();

/// What is written of cells, and how.
struct CellFileOptions {
  std::string format;                        ///< the name of one of `cell_formats`
  CellsOptions cells = {};                   ///< of polyhedra
  std::optional<double> strut_radius = {};   ///< of the struts of a foam
  std::optional<double> strut_density = {};  ///< their share of the volume, for the radius; 0.05 if neither
  std::optional<double> voxel = {};          ///< edge of the voxels of an image
  std::optional<int> resolution = {};        ///< else so many along the longest edge; 100 if neither
};

struct WrittenCells {
  std::vector<std::filesystem::path> files;  ///< the format's file, then those that go with it
  std::string note;                          ///< what they hold, in one line
};

/// Throws Error{bad_argument} for a format that is not there, with the nearest name, for options that it does
/// not take or that are out of range, and for two dimensions where it has none.
void require_cell_format(const CellFileOptions&, int dimension);

/// Writes the cells of a packing, in the scene's unit, to `file` and for some formats to others beside it:
/// those that are `made`, by the options' `cells`, else it makes them; an image needs none. All files appear
/// whole, or none; existing ones of these names are replaced. Throws as `require_cell_format` and `cells_of`;
/// Error{cannot_write} if a file of a result would be overwritten; Cancelled. Cost: about 10 µs a cell, and
/// that of `cells_of` unless they are made; of images about 20 ns a voxel.
WrittenCells write_cells(const Packing&, const CellFileOptions&, const std::filesystem::path& file,
                         const Monitor& monitor = {}, const ShapedCells* made = nullptr);

/// Writes a table of cells as CSV: centre, radius and `CellShape` of each, in the order of the spheres.
/// Throws Error{cannot_write} as above.
void write_cell_table(const Packing&, const ShapedCells&, const std::filesystem::path& file);

/// Statistics as a JSON object: what `bernal cells --json` prints.
std::string cell_statistics_as_json(const Packing&, const Cells&, const CellStatistics&);

}  // namespace bernal
