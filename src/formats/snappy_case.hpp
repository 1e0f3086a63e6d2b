#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/vector.hpp"
#include "files/staged_folder.hpp"
#include "geometry/edges.hpp"

namespace bernal {

/// A case for snappyHexMesh of OpenFOAM, without its surfaces, which stand in constant/triSurface. Lengths in
/// m. Source: OpenFOAM User Guide v1912, 4.4 "Mesh generation with the snappyHexMesh utility".
struct SnappyCase {
  /// A part of a surface, which becomes a patch of the mesh.
  struct Part {
    std::string name;           ///< of the patch, and of the region in the file where that has several
    std::string group = {};     ///< of patches, where several belong together
    std::string type = "wall";  ///< of the patch
    int level = 0;              ///< of refinement: cells there have 1/2^level of the block's edges
    int level_in_curves = 0;    ///< where normals of a cell's triangles differ by more than 30 degrees
    int level_in_gaps = 0;      ///< up to which level surfaces that face each other are refined; 0: not
    int layers = 0;             ///< of flat cells on it
  };
  struct Surface {
    std::string file, name;
    std::vector<Part> parts;  ///< its regions; one without a region has the surface's name
  };
  /// Lines that cells keep: a file of edges, and the level there.
  struct Edges {
    std::string file;
    int level = 0;
  };
  /// What cells are made from: boxes, of which those outside of the surfaces go.
  struct Block {
    Bounds<3> bounds;
    std::array<bool, 3> periodic{};
    bool is_container = false;  ///< whether its faces are walls, and not outside of these
    std::array<int, 3> cells{};

    /// Divides it into cells of about this edge, none of them longer.
    void divide(double edge);
  };

  std::string title;
  Block block;
  std::vector<Surface> surfaces;
  std::vector<Edges> edges;
  double layers_height = 0.3, layers_growth = 1.2;  ///< of all together, in cells; of one over that below
  Vector<3> inside = Vector<3>::Zero();             ///< in the pores
  double clearance = 0;                             ///< no sphere and no wall is nearer to that
  bool is_proven = true;
};

/// Writes the dictionaries that are the case's own, and the script Allmesh that runs it. Sets its mode.
void write_snappy_case(const SnappyCase&, StagedFolder&);

/// Lines between vertices, as an OBJ file; lengths times `scale`.
void write_edges_as_obj(const std::vector<Vector<3>>&, const SharpEdges&, double scale,
                        const std::filesystem::path&);

/// What every program of OpenFOAM reads before a mesh: names and contents.
std::vector<std::array<std::string_view, 2>> system_files_of_openfoam();

/// "(0 0 0.5)"
std::string point_for_openfoam(const Vector<3>&);

}  // namespace bernal
