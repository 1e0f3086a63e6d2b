#pragma once
#include <string>
#include <string_view>

#include "formats/format.hpp"
#include "formats/text_file.hpp"
#include "surfaces/surfaces.hpp"

namespace bernal {

/// The triangles of a file. `file` must outlive them.
Surfaces surfaces_of(const Exported& file);

/// An entry with the keys of all triangle formats and these additional ones.
Format surface_format(std::string_view name, std::string_view help, std::string_view file,
                      std::string (*write)(const Exported&, StagedFolder&),
                      const std::vector<std::string_view>& keys = {});

/// All triangles as one binary STL file. Source: Marshall Burns, Automated Fabrication (1993), section 6.5.
void write_stl(OutputFile& out, const Exported& file, const Surfaces& surfaces);

}  // namespace bernal
