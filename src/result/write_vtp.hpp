#pragma once
#include "bernal/core/spheres.hpp"
#include "files/output_file.hpp"

namespace bernal {

/// ParaView's PolyData: one vertex cell a sphere, point data `radius` and `id` (the sphere's line in
/// spheres.csv, counted from 0), all as 64-bit appended raw data. In ParaView: Glyph, type Sphere, radius 1,
/// scale array `radius`, scale factor 1; or representation Point Gaussian. Points have three coordinates:
/// missing ones are 0, and those beyond the third are the point data `x3`, `x4`, … . A comment says the
/// dimension and, where one is given, the unit: "lengths in mm; dimension 2".
void write_vtp(OutputFile& file, const Spheres<dynamic>& spheres, std::string_view unit = {});

}  // namespace bernal
