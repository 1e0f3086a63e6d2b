#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/mesh_files/mesh_packing.hpp"
#include "files/staged_folder.hpp"
#include "meshes/triangle_sides.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Names of what belongs together in files: of patches "spheres", "necks", "x_lower", and of regions "fluid".
struct MeshGroups {
  std::vector<std::string> surfaces, volumes;
  std::vector<std::uint32_t> surface_of_patch, volume_of_region;
  std::vector<bool> is_opening;  ///< of surfaces: where fluid may enter or leave

  std::uint32_t surface_of(const VolumeMesh& mesh, std::size_t triangle) const {
    return surface_of_patch[mesh.patch[triangle]];
  }
  std::uint32_t volume_of(const VolumeMesh& mesh, std::size_t tetrahedron) const {
    return volume_of_region[mesh.region[tetrahedron]];
  }
  /// The number of a surface by its name; surfaces.size() if there is none.
  std::uint32_t surface_named(std::string_view name) const;
};

/// The classes of spheres that a scene tells apart, by names that every format takes, and each sphere's.
struct ClassesOfMesh {
  std::vector<std::string> names = {};
  std::vector<std::uint32_t> of_sphere = {};
  /// The names of the layers of each class, from the centre out; one list where there are no classes.
  std::vector<std::vector<std::string>> layers = {};
};
/// Other characters than letters, digits, _ and - become _; equal names are numbered. A layer that several
/// classes have is named after these, too: "kernel_of_steel".
ClassesOfMesh classes_of_mesh(const Packing&);

/// Where there are classes, "spheres_steel" and "surface_of_steel" stand for "spheres" and
/// "surface_of_spheres"; where spheres have layers, "layer_kernel" stands for what is in them, and
/// "surface_of_layer_kernel" for where it ends within others.
/// Faces of a `part` that is cut out have names: "x_lower" across an axis, else "face_1" and so on by number.
MeshGroups groups_of(const VolumeMesh&, const Domain&, const ClassesOfMesh& = {},
                     const ConvexPart* part = nullptr);

/// "x_lower" for 0, "x_upper" for 1, up to "z_upper" for 5.
std::string name_of_end(std::uint32_t face);

/// What a writer is given.
struct MeshToWrite {
  const VolumeMesh& mesh;
  const MeshGroups& groups;
  const std::filesystem::path& folder;
  const std::filesystem::path& name;  ///< of the file, in the folder
  std::string_view title;             ///< "bernal 0.2.0 (…): mesh of 1,000 spheres", in ASCII
  std::string_view unit;
  double metres;         ///< in one unit
  const Solids& solids;  ///< that the mesh is of
  const MeshFileOptions& options;
};

/// An entry of the list of formats.
struct MeshWriter {
  MeshFormat format;
  std::vector<std::string_view> others = {};  ///< names of files that go with it
  std::string_view beside = {};               ///< and how that of another ends, after the stem of the file's
  /// Files that programs leave beside `others` and that are wrong for another mesh: these go.
  std::vector<std::string_view> outdated = {};
  bool for_gradients = false;  ///< see `ImproveOptions`
  /// Writes the files and returns what they hold.
  std::string (*write)(const MeshToWrite&, StagedFolder&);
};

MeshWriter gmsh_of_mesh();
MeshWriter abaqus_of_mesh();
MeshWriter openfoam_of_mesh();
MeshWriter vtu_of_mesh();
MeshWriter snappy_of_mesh();

/// What OpenFOAM calls the patch of a surface: "patch" where fluid may enter or leave, else "wall".
std::string type_of_patch(const MeshGroups&, std::size_t surface);
/// What programs of OpenFOAM read before the mesh, where the case does not have it: it is the user's then.
void write_system_of_openfoam(const MeshToWrite&, StagedFolder&);

/// Throws Error{bad_argument} where a number of the options is not in the range of its key.
void require_in_range(const MeshKey&, const MeshFileOptions&);

/// Numbers of what is in each group, in their order: [k] of those with group(i) = k.
template <class Group>
std::vector<std::vector<std::uint32_t>> by_group(std::size_t count, std::size_t groups, const Group& group) {
  std::vector<std::vector<std::uint32_t>> of(groups);
  for (std::uint32_t i = 0; i < count; ++i) of[group(i)].push_back(i);
  return of;
}

}  // namespace bernal
