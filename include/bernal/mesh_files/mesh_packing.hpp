#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/solids/contact_treatment.hpp"

namespace bernal {

/// A format that volume meshes are written in.
struct MeshFormat {
  std::string name;       ///< "openfoam"
  std::string what;       ///< for whom, and what the files hold
  std::string ending;     ///< of the file's name: ".msh"
  int largest_order = 2;  ///< of its elements
  bool has_prisms = false;
  bool is_surface = false;  ///< its files hold triangles that another program meshes: TetGen is not needed
};
/// All of them, in the order in which users see them.
std::vector<MeshFormat> mesh_formats();

/// How a packing is meshed, and what is written. Lengths of edges are in radii.
struct MeshFileOptions {
  std::string format;  ///< the name of one of `mesh_formats`
  ContactTreatment contact = ContactTreatment::bridge;
  double gap = 0.01;           ///< contacts nearer than this are treated: over the sum of the radii, at walls
                               ///< over the radius
  double bridge_radius = 0.2;  ///< of the smaller radius; of fillets at their waists
  double bridge_angle = 0;     ///< instead, in degrees: the least half-angle under which spheres see bridges
  double sphere_edge = 0.3;    ///< longest edges on spheres
  double neck_edge = 0.15;     ///< edges where necks begin, of the smaller radius
  double gap_edge = 4;         ///< longest edges where surfaces are near each other, in widths of the gap
  double layer_edge = 6;       ///< longest edges on spheres with thin layers, in thicknesses of these
  std::string unit = {};       ///< of the lengths in the files; the scene's if empty
  /// The convex part that is meshed: "x = 1..4, y = 1..4, z = 0..5", other planes, or a file of any format
  /// of a mesh; all if empty.
  std::string cut = {};
  std::string patches = {};   ///< flat walls with names: "inlet: z = 0, outlet: z = 40"; none if empty
  bool solids = false;        ///< whether spheres and bridges are meshed too, or the fluid alone
  bool hold_volumes = false;  ///< whether facets of spheres hold their volumes, or corners lie on them
  int prisms = 0;             ///< layers of prisms in the fluid, on spheres and walls where there is room
  double prism_height = 0.1;  ///< of all layers together, on walls in mean radii
  double prism_growth = 1.2;  ///< height of a layer over that of the one nearer to the surface
  int order = 1;              ///< 2: with middles of edges, on the true spheres
};

/// A member of the options as users give it: `--mesh-size 0.2` to the command, `mesh_size=0.2` in Python.
struct MeshKey {
  std::string name;         ///< "mesh_size"
  std::string what;         ///< with its default
  std::string placeholder;  ///< of its value: "SHARE"
  std::variant<double MeshFileOptions::*, int MeshFileOptions::*, bool MeshFileOptions::*,
               ContactTreatment MeshFileOptions::*, std::string MeshFileOptions::*>
      to;
  double least = 0, most = 0;           ///< of a number
  std::vector<std::string> words = {};  ///< else what it may be: of a flag the word for false first; of a
                                        ///< text none
};
/// All of them, in the order in which users see them.
const std::vector<MeshKey>& mesh_keys();

/// The options for a format's name and the values of some keys: {{"mesh_size", "0.2"}}. Throws
/// Error{bad_argument}, with the nearest name, for a key that is not there or a value that it does not take.
MeshFileOptions mesh_options_of(std::string_view format,
                                const std::map<std::string, std::string>& words = {});

/// What the mesh of a packing is like.
struct BedMeshReport {
  std::size_t spheres = 0, necks = 0, triangles = 0;
  double least_edge = 0;            ///< of all triangles, as a length
  double least_triangle_angle = 0;  ///< in degrees
  Vector<3> place_of_least_angle = Vector<3>::Zero();
  std::size_t shrunk_necks = 0;    ///< whose radius is smaller than asked for
  double largest_neck_shrink = 0;  ///< of their radii, over the one asked for
  std::size_t cut_fillets = 0;     ///< that are cylinders, as ends of periods would cut or nearly touch them
  std::size_t widened_necks = 0;   ///< whose radius is larger, so that ends of periods cut them clearly
  std::size_t deepened_caps = 0;   ///< that are deeper than the gap asks for, for the same reason
  std::size_t clipped = 0;         ///< spheres that the faces of a part cut out of the packing clip
  /// Spheres that are smaller, themselves or their layers, as a face or an end of a period nearly touched
  /// them.
  std::size_t cleared = 0;
  /// Spheres that touch walls of triangles where no bridge has room: these have a gap instead.
  std::size_t gaps_at_edges = 0;
  /// How far triangles of walls are off those of a CAD part, or off round walls of a solid of revolution.
  double wall_deviation = 0;
  std::size_t shrunk_spheres = 0;    ///< that are smaller than in the packing, for gaps
  double largest_sphere_shrink = 0;  ///< of a radius, over the radius

  /// Whether the triangles are all: for formats whose files another program makes the mesh from. Then there
  /// are no tetrahedra, and volumes are those between the triangles.
  bool is_surface = false;
  std::size_t tetrahedra = 0, nodes = 0;
  double least_sicn = 0, mean_sicn = 0;       ///< Gmsh's signed inverse condition number, of straight edges
  double least_angle = 0, largest_angle = 0;  ///< dihedral, in degrees
  std::array<std::size_t, 10> histogram{};    ///< of the SICN, by tenths
  struct Place {
    double sicn = 1;
    Vector<3> center = Vector<3>::Zero();
  };
  std::size_t prisms = 0;        ///< in layers on spheres and walls
  std::size_t prism_ends = 0;    ///< pyramids and flat tetrahedra in which the layers end
  double prism_share = 0;        ///< of the area of spheres that whole prisms stand on
  double mean_prism_height = 0;  ///< of all layers together, as a length
  double least_prism_height = 0;
  double least_scaled_jacobian =
      1;                     ///< of cells in layers, 1 for an upright prism on an equal-sided triangle
  std::vector<Place> worst;  ///< up to ten tetrahedra, the worst first
  std::optional<double> least_curved_sicn = {};  ///< of second order
  /// Edges on round surfaces, of second order, and those of them that stay straight where elements would
  /// fold.
  std::size_t curved_edges = 0, straight_edges = 0;

  double domain_volume = 0;
  double porosity = 0;                         ///< in closed form, contacts as they were treated
  std::optional<double> packed_porosity = {};  ///< of the spheres as they are packed
  double meshed_porosity = 0;                  ///< of the mesh
  double contact_area = 0;                     ///< least cross-sections of necks, flat faces of caps
  struct Group {
    std::string name;
    double volume = 0;                    ///< of the mesh
    std::optional<double> stated_volume;  ///< in closed form, contacts as they were treated, where known
    std::size_t tetrahedra = 0;
  };
  std::vector<Group> groups;

  struct Part {
    std::string name;
    double seconds = 0;
    double peak_bytes = 0;  ///< of a program that was started; 0: in this process
  };
  std::vector<Part> parts;

  /// Whether the least SICN is as large as it is promised to be.
  static constexpr double promised_sicn = 0.1;
  double worst_sicn() const { return std::min(least_sicn, least_curved_sicn.value_or(1)); }
  bool keeps_promise() const { return is_surface || worst_sicn() >= promised_sicn; }
};

struct MeshedPacking {
  BedMeshReport report;
  std::vector<std::filesystem::path> files;  ///< the format's file, then those that go with it
  std::string note;                          ///< what they hold, in one line
};

/// Throws Error{bad_argument} for a format that is not there, with the nearest name, and for options that it
/// does not take or that are out of range.
void require_mesh_format(const MeshFileOptions&, int dimension);

/// Meshes the space between the spheres of a packing, and the spheres where that is asked for, by
/// tetrahedra, and prisms where these are asked for, that fit to each other, and writes them in the scene's
/// unit to `file` and for some formats to others beside it. All appear whole, or none; existing files of
/// these names are replaced. The surface is bernal's own, equal at opposite ends of periods; TetGen fills it,
/// a program of its own. For formats that are surfaces nothing is filled: they hold triangles, of half the
/// lengths that are asked of edges, and what the other program needs to mesh them.
///
/// Throws as `require_mesh_format`; Error{bad_argument} for containers that cannot be meshed and where TetGen
/// is not installed, with the remedy; Error{bad_mesh} where TetGen fails; Error{cannot_write} if a file of a
/// result would be overwritten; Cancelled. Cost: about 0.07 s, 3,000 tetrahedra and
/// 0.5 MB a sphere with the sizes that are given here, and 3 GB for TetGen, of which up to four run at once.
MeshedPacking mesh_packing(const Packing&, const MeshFileOptions&, const std::filesystem::path& file,
                           const Monitor& monitor = {});

/// What the mesh would be like that `mesh_packing` writes; writes nothing. Throws as that.
BedMeshReport measure_mesh(const Packing&, const MeshFileOptions&, const Monitor& monitor = {});

/// The report as a JSON object: what `bernal mesh --json` prints.
std::string mesh_report_as_json(const Packing&, const BedMeshReport&);

}  // namespace bernal
