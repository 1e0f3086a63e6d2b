#include <array>

#include "formats/format.hpp"

namespace bernal {

// Each in its own file, src/formats/write_<name>.cpp.
const Format& lammps_format();
const Format& liggghts_format();
const Format& yade_format();
const Format& esys_format();
const Format& extxyz_format();
const Format& gsd_format();
const Format& pfc_format();
const Format& mfix_format();
const Format& openmc_format();
const Format& povray_format();
const Format& npy_format();
// Solids for meshers.
const Format& gmsh_format();
// Both in write_cad.cpp.
const Format& step_format();
const Format& brep_format();
// Triangles.
const Format& stl_format();
const Format& obj_format();
const Format& ply_format();
const Format& threemf_format();
const Format& gltf_format();
const Format& snappy_format();
// Images, all in write_images.cpp.
const Format& nrrd_format();
const Format& vti_format();
const Format& tiff_format();
const Format& raw_format();

/// A line a format.
constexpr std::array all_formats = {
    lammps_format, liggghts_format, yade_format,   esys_format,   extxyz_format, gsd_format,
    pfc_format,    mfix_format,     openmc_format, povray_format, npy_format,    gmsh_format,
    step_format,   brep_format,     stl_format,    obj_format,    ply_format,    threemf_format,
    gltf_format,   snappy_format,   nrrd_format,   vti_format,    tiff_format,   raw_format};

std::span<const Format* const> formats() {
  static const auto entries = [] {
    std::array<const Format*, all_formats.size()> made;
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = &all_formats[k]();
    return made;
  }();
  return entries;
}

std::span<const OutputTable* const> output_tables() {
  static const auto tables = [] {
    std::array<const OutputTable*, all_formats.size()> made;
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = &formats()[k]->table;
    return made;
  }();
  return tables;
}

const Format& format_of(const Output& output) {
  const OutputTable& table = table_of(output);
  for (const Format* format : formats())
    if (&format->table == &table) return *format;
  throw Error(ErrorCode::bad_scene, "this is the format of no file", output.locations.whole);
}

}  // namespace bernal
