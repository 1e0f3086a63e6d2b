#pragma once
#include <string>
#include <vector>

#include "bernal/voxels/voxels.hpp"
#include "files/output_file.hpp"

namespace bernal {

/// An image of a packing with its metadata. Holds references.
struct VoxelImage {
  const Spheres<dynamic>& spheres;
  const Domain& domain;
  VoxelGrid grid;
  VoxelValues values = VoxelValues::binary;
  std::string unit;   ///< of lengths: "mm"
  std::string title;  ///< one line
  VoxelLayers layers = {};
  std::vector<std::string> names = {};  ///< what the values of layers stand for, from 1, or their fraction
  std::string meaning = {};             ///< what the values of `make` mean
  /// What makes the voxels of other images than `voxelise`, of four bytes.
  void (*make)(const Spheres<dynamic>&, const Domain&, const VoxelGrid&, const TakeLayers&,
               const Monitor&) = nullptr;
};

/// Explanation of the values: "0 pore, 1 sphere, 2 outside the container".
std::string meaning_of(const VoxelImage&);

// All of these write an array of voxels, x fastest, then y, then z, little-endian, while it is made; see
// `voxelise` for exceptions and cost. Nothing is certain before the file is closed.

/// NRRD with embedded header: ITK, 3D Slicer, ParaView, DREAM.3D. The origin is the centre of the first
/// voxel. Source: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html).
void write_nrrd(OutputFile&, const VoxelImage&, const Monitor& = {});

/// VTK's ImageData, one value a cell, raw appended data with 64-bit lengths: ParaView, PyVista. The array is
/// named "phase", "FeatureIds", "solid_fraction", "material" or "layer". The origin is the corner of the
/// first voxel.
void write_vti(OutputFile&, const VoxelImage&, const Monitor& = {});

/// TIFF 6.0, uncompressed, one page a layer of 8 or 32 bits, with the lowest y in the first row; ImageJ's
/// description holds the distance of layers and the unit. BigTIFF from 4 GiB on. TIFF does not store the
/// origin. The scale is accurate to 1e-9; if a quotient of 32-bit numbers cannot represent it, it is left
/// out, and the description gives the edges of a voxel.
void write_tiff(OutputFile&, const VoxelImage&, const Monitor& = {});
bool has_scale_in_tiff(const VoxelGrid&);
/// Everything before the voxels.
void write_tiff_directories(OutputFile&, const VoxelImage&);

/// The voxels only.
void write_raw(OutputFile&, const VoxelImage&, const Monitor& = {});
/// Metadata for reading them, as a JSON object: "dtype" and "shape" as in NumPy, "sizes" along x, y, z,
/// "spacing", "corner" of the first voxel, "origin" (its centre), "unit", "values"; and a seal, see
/// `is_sealed`.
std::string raw_header(const VoxelImage&);

}  // namespace bernal
