#pragma once
#include <string_view>

namespace bernal {

// The files in src/formats/files, written after @NAMES@ in them are replaced, see `filled`.
extern const std::string_view gmsh_py, liggghts_in, openmc_build_py, openmc_py, particle_input_dat,
    povray_pov;
extern const std::string_view threemf_content_types_xml, threemf_rels_xml;
extern const std::string_view snappy_Allmesh, snappy_blockMeshDict, snappy_controlDict, snappy_fvSchemes,
    snappy_fvSolution, snappy_snappyHexMeshDict;

}  // namespace bernal
