#pragma once
#include "formats/format.hpp"

namespace bernal {

/// The levels of a packing as CSG for OpenMC: a folder with geometry.xml, materials.xml, settings.xml and
/// build.py, in which OpenMC's Python API takes them and gives the materials what they are made of; or all
/// XML in one file of that name. Returns what it holds. Cost: about 1 µs a sphere of each level.
std::string write_openmc_model(const Exported&, StagedFolder&);

/// The spheres of such a geometry that bernal wrote.
FileContents read_openmc_model(const Reading&);
bool is_openmc_model(const FileBeginning&);

}  // namespace bernal
