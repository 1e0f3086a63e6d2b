#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/cells/write_cells.hpp"
#include "files/staged_folder.hpp"

namespace bernal {

/// What a writer is given. `cells` and `shapes` are empty for images.
struct CellFile {
  const Packing& packing;
  const CellFileOptions& options;
  const std::filesystem::path& name;  ///< of the file, in the folder
  const Cells& cells;
  const std::vector<CellShape>& shapes;
  Monitor monitor = {};

  std::string_view unit() const { return name_of(packing.scene.unit); }
  /// "bernal 0.2.0 (…): 1,000 cells in a periodic box", in ASCII.
  std::string title() const;
  /// How many cells are not empty.
  std::uint32_t full() const;
};

/// An entry of the list of formats.
struct CellWriter {
  CellFormat format;
  std::vector<std::string_view> endings = {};  ///< of files that go with it
  bool is_image = false;
  bool has_struts = false;
  /// Writes the files and returns what they hold.
  std::string (*write)(const CellFile&, StagedFolder&);
};

CellWriter vtu_of_cells();
CellWriter obj_of_cells();
CellWriter neper_of_cells();
CellWriter gmsh_of_cells();
CellWriter struts_of_cells();
CellWriter nrrd_of_cells();
CellWriter vti_of_cells();
CellWriter npy_of_cells();

/// A file that goes with the named one: "a.coo" beside "a.tess".
std::string beside(const std::filesystem::path& name, std::string_view ending);

}  // namespace bernal
