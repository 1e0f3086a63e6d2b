#include <fmt/format.h>

#include "bernal/measure/cell_weights.hpp"
#include "cells/cell_file.hpp"
#include "cells/voxel_labels.hpp"
#include "files/npy_file.hpp"
#include "files/output_file.hpp"
#include "report/write_image.hpp"

namespace bernal {
namespace {

constexpr int usual_resolution = 100;
constexpr std::string_view meaning_of_labels =
    "i + 1 cell of sphere i (counted from 0), 4294967295 outside the container";

VoxelImage image_of(const CellFile& file, const Spheres<dynamic>& spheres) {
  const CellFileOptions& options = file.options;
  const Domain& domain = file.packing.domain;
  const VoxelGrid grid = options.voxel ? voxel_grid(domain, *options.voxel)
                                       : voxel_grid_of(domain, options.resolution.value_or(usual_resolution));
  return {.spheres = spheres,
          .domain = domain,
          .grid = grid,
          .values = VoxelValues::labels,
          .unit = std::string(file.unit()),
          .title = file.title(),
          .layers = {},
          .names = {},
          .meaning = std::string(meaning_of_labels),
          .make = label_cells};
}

void write_npy_image(OutputFile& out, const VoxelImage& image, const Monitor& monitor) {
  std::vector<std::size_t> shape;  // layers, rows, voxels, as raw_header has them
  for (int k = image.grid.dimension - 1; k >= 0; --k)
    shape.push_back(static_cast<std::size_t>(image.grid.count[static_cast<std::size_t>(k)]));
  out.append(npy_header("<u4", shape));
  write_raw(out, image, monitor);
}

template <void (*write)(OutputFile&, const VoxelImage&, const Monitor&)>
std::string write_labels(const CellFile& file, StagedFolder& staged) {
  const Spheres<dynamic> spheres = with_weights(file.packing.spheres, file.packing.weights);
  const VoxelImage image = image_of(file, spheres);
  staged.require_room(static_cast<std::uint64_t>(image.grid.voxels()) *
                      static_cast<std::uint64_t>(bytes_per_voxel(image.values)));
  OutputFile out(staged.add(file.name.string()));
  write(out, image, file.monitor);
  out.close();
  const auto& count = image.grid.count;
  return fmt::format("{} x {} x {} voxels, {}", count[0], count[1], count[2], meaning_of_labels);
}

CellWriter image_writer(const char* name, const char* what, const char* ending,
                        std::string (*write)(const CellFile&, StagedFolder&)) {
  return {.format = {name, what, ending, 2}, .is_image = true, .write = write};
}

}  // namespace

CellWriter nrrd_of_cells() {
  return image_writer("nrrd", "image for ITK, 3D Slicer, DREAM.3D: which cell has each voxel's centre",
                      ".nrrd", write_labels<write_nrrd>);
}
CellWriter vti_of_cells() {
  return image_writer("vti", "the same image for ParaView and PyVista", ".vti", write_labels<write_vti>);
}
CellWriter npy_of_cells() {
  return image_writer("npy", "the same for NumPy, indexed z, y, x", ".npy", write_labels<write_npy_image>);
}

}  // namespace bernal
