#pragma once
#include <string>

#include "bernal/voxels/voxels.hpp"
#include "files/output_file.hpp"

namespace bernal {

/// An image of a packing, and what is said of it. Refers to what it was made of.
struct VoxelImage {
  const Spheres<dynamic>& spheres;
  const Domain& domain;
  VoxelGrid grid;
  VoxelValues values = VoxelValues::binary;
  std::string unit;   ///< of lengths: "mm"
  std::string title;  ///< one line
};

/// What the values of voxels mean: "0 pore, 1 sphere, 2 outside the container".
std::string meaning_of(VoxelValues);

// All of them write one array of voxels, x fastest, then y, then z, little-endian, as it is made; see
// `voxelise` for what may be thrown and what it costs. Nothing is certain before the file is closed.

/// NRRD, with its header in the file: ITK, 3D Slicer, ParaView, DREAM.3D. The origin is the centre of the
/// first voxel. Source: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html).
void write_nrrd(OutputFile&, const VoxelImage&, const Monitor& = {});

/// VTK's ImageData, one value a cell, raw appended data with lengths of 64 bits: ParaView, PyVista. The array
/// is called "phase", "FeatureIds" or "solid_fraction". The origin is the corner of the first voxel.
void write_vti(OutputFile&, const VoxelImage&, const Monitor& = {});

/// TIFF 6.0, uncompressed, one page a layer of 8 or 32 bits, whose first row is that of the lowest y; with a
/// description as ImageJ writes it, for the distance of layers and the unit. Of 4 GiB and more it is a
/// BigTIFF. A TIFF has no place for the origin. The scale is right to 1e-9, or, where a quotient of 32 bits
/// cannot hold it, left out, and the edges of a voxel stand in the description.
void write_tiff(OutputFile&, const VoxelImage&, const Monitor& = {});
bool has_scale_in_tiff(const VoxelGrid&);
/// All of it but the voxels, which follow.
void write_tiff_directories(OutputFile&, const VoxelImage&);

/// The voxels and nothing else.
void write_raw(OutputFile&, const VoxelImage&, const Monitor& = {});
/// What one has to know to read them, as a JSON object: "dtype" and "shape" in the words of NumPy, "sizes"
/// along x, y, z, "spacing", "corner" of the first voxel, "origin" its centre, "unit", "values"; and a seal,
/// see `is_sealed`.
std::string raw_header(const VoxelImage&);

}  // namespace bernal
