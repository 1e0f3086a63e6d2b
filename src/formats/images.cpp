#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/layered.hpp"
#include "report/write_image.hpp"

namespace bernal {
namespace {

/// What the values of the image stand for: materials, layers, or one material's fraction.
void name_layers(const Exported& file, VoxelImage& image) {
  const Output& output = file.output;
  if (output.values == VoxelValues::fraction && output.material.empty()) return;
  LayeredSpheres spheres = layered(file);
  for (const std::uint32_t kind : spheres.kind) {
    const std::uint32_t material = spheres.kinds[kind].material;
    const std::uint32_t value = output.values == VoxelValues::layers             ? kind + 1
                                : output.values == VoxelValues::materials        ? material + 1
                                : spheres.materials[material] == output.material ? 1
                                                                                 : 0;
    image.layers.value.push_back(static_cast<std::uint8_t>(value));
  }
  image.layers.first = std::move(spheres.first);
  image.layers.outer = std::move(spheres.outer);
  if (output.values == VoxelValues::layers)
    for (const LayeredSpheres::Kind& kind : spheres.kinds) image.names.push_back(kind.name);
  else if (output.values == VoxelValues::materials)
    image.names = std::move(spheres.materials);
  else
    image.names = {output.material};
}

VoxelImage image_of(const Exported& file) {
  const Output& output = file.output;
  const VoxelGrid grid =
      output.voxel
          ? voxel_grid(file.domain, *output.voxel * conversion_factor(file.packing.scene.unit, file.unit()))
          : voxel_grid_of(file.domain, *output.resolution);
  VoxelImage image{file.spheres, file.domain, grid, output.values, std::string(name_of(file.unit())),
                   file.title()};
  if (output.values != VoxelValues::binary && output.values != VoxelValues::labels) name_layers(file, image);
  return image;
}

template <void (*write)(OutputFile&, const VoxelImage&, const Monitor&)>
void write_image(const Exported& file, StagedFolder& staged) {
  const VoxelImage image = image_of(file);
  staged.require_room(static_cast<std::uint64_t>(image.grid.voxels()) *
                      static_cast<std::uint64_t>(bytes_per_voxel(image.values)));
  OutputFile out(staged.add(file.output.file.string()));
  write(out, image, file.monitor);
  out.close();
}

void write_raw_and_header(const Exported& file, StagedFolder& staged) {
  write_image<write_raw>(file, staged);
  staged.write(file_beside(file.output.file, ".json"), raw_header(image_of(file)));
}

/// "100 x 100 x 250 voxels of 0.02 mm, 0 pore, 1 sphere, 2 outside the container".
std::string note_of_image(const Exported& file) {
  const VoxelImage image = image_of(file);
  const VoxelGrid& grid = image.grid;
  std::string counts, edges;
  for (int k = 0; k < grid.dimension; ++k) {
    counts += fmt::format("{}{}", k == 0 ? "" : " x ", grid.count[static_cast<std::size_t>(k)]);
    edges += fmt::format("{}{:.6g}", k == 0 ? "" : " x ", grid.spacing[k]);
  }
  return fmt::format("{} voxels of {} {}, {}", counts,
                     grid.has_cubes() ? fmt::format("{:.6g}", grid.spacing[0]) : edges, name_of(file.unit()),
                     meaning_of(image));
}

std::string remark_on_scale(const Exported& file) {
  return has_scale_in_tiff(image_of(file).grid)
             ? ""
             : fmt::format(
                   "; a TIFF cannot hold their size in {}, which stands in its description alone: take "
                   "another unit",
                   name_of(file.unit()));
}

Format image_format(std::string_view name, std::string_view help, std::string_view file,
                    void (*write)(const Exported&, StagedFolder&)) {
  return {.name = name,
          .writes = help,
          .keys = {"unit", "voxel", "resolution", "values", "material"},
          .file = file,
          .least_dimension = 2,
          .most_dimensions = 3,
          .sizes = "voxels",
          .choices = {{{"voxel"}, {"resolution"}, {}}},
          .write = write,
          .note = note_of_image};
}

}  // namespace

Format nrrd_format() {
  return image_format("nrrd", "image for ITK, 3D Slicer, ParaView, DREAM.3D", "voxels.nrrd",
                      write_image<write_nrrd>);
}

Format vti_format() {
  return image_format("vti", "image for ParaView and PyVista, a value a cell", "voxels.vti",
                      write_image<write_vti>);
}

Format tiff_format() {
  Format made = image_format("tiff", "stack of images for ImageJ, PoreSpy and lattice Boltzmann codes",
                             "voxels.tiff", write_image<write_tiff>);
  made.remark = remark_on_scale;
  return made;
}

Format raw_format() {
  Format made = image_format("raw", "bare voxels, and a header in JSON beside them", "voxels.raw",
                             write_raw_and_header);
  made.endings = {".json"};
  return made;
}

}  // namespace bernal
