#pragma once
#include <any>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "bernal/core/unit.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/domain/mesh_file.hpp"
#include "bernal/scene/bed_target.hpp"
#include "bernal/scene/engine.hpp"
#include "bernal/scene/inside.hpp"
#include "bernal/scene/shapes.hpp"
#include "bernal/scene/sizes.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/solids/contact_treatment.hpp"
#include "bernal/surfaces/surface_choice.hpp"
#include "bernal/voxels/voxels.hpp"

namespace bernal {

struct Packing;
struct Zone;

/// A box that repeats itself along every axis but those with walls. By `size` or `edge`; with neither, the
/// packing decides how large it is.
struct PeriodicBox {
  int dimension = 3;
  std::vector<double> size = {};
  std::optional<double> edge = {};  ///< all its edges
  /// Of one of three dimensions without walls xy, xz and yz of its cell vectors (lx, 0, 0), (xy, ly, 0) and
  /// (xz, yz, lz), of one of two dimensions xy; empty: it is upright.
  std::vector<double> tilt = {};
  std::vector<int> walls = {};  ///< axes, counted from 0, along which it ends at walls
  bool scalable = false;        ///< the packing decides how large it is; size only gives its proportions
};

/// What is to be filled: `scene.container = Cylinder{.radius = 2, .height = 5}`. A box of two or three
/// dimensions with walls all around is a Box; one that repeats itself is a PeriodicBox.
struct SceneContainer
    : std::variant<Box, Cylinder, MeshFile, Sphere, PeriodicBox, Polygon, Cone, Tube, Lathed, Extruded> {
  using variant::variant;
  /// Of a Box of three dimensions or a Cylinder without periods: the radius of its rounded edges, at most
  /// half of any edge. The walls are those of `rounded`, a mesh or a solid of revolution.
  double rounding = 0;
  /// Solids that are taken out of one of three dimensions without periods, none with obstacles of its own.
  /// What then remains is a mesh, whose flat faces stand for round walls on the inner side of them. Those of
  /// a MeshFile that are files, in its unit, may stand in that instead.
  std::vector<SceneContainer> obstacles = {};
  Locations locations;

  /// Those of it and its obstacles that stand in files.
  std::vector<MeshFile*> meshes();
  std::vector<const MeshFile*> meshes() const;
};

/// Another program that finds the places which the first stage begins with: `scene.engine = Lammps{}`.
struct SceneEngine : std::variant<Lammps, Liggghts> {
  using variant::variant;
  Locations locations;

  const EngineProcess& process() const {
    return std::visit([](const auto& engine) -> const EngineProcess& { return engine.process; },
                      static_cast<const variant&>(*this));
  }
};

/// One act of the protocol: the options of any stage, such as Relax{.patience = 20}.
struct Stage {
  template <class Options>
  requires(!std::is_same_v<Options, Stage>) Stage(Options of) : options(std::move(of)) {}

  /// Its options if it is that stage, else null.
  template <class Options>
  Options* as() {
    return std::any_cast<Options>(&options);
  }
  template <class Options>
  const Options* as() const {
    return std::any_cast<Options>(&options);
  }

  /// "relax": what `do = …` calls it. Throws Error{bad_scene} for options that no stage has.
  std::string_view name() const;

  std::any options;
  Locations locations = {};
};

/// At most one of these says when there are enough spheres; in a periodic box that is given neither size nor
/// edge, `count` and `packing_fraction` together say how large it is. Where nothing is said the stages place
/// what they can, or for relaxation in a container what the plan expects.
struct Target {
  std::optional<std::int64_t> count = {};
  std::optional<double> packing_fraction = {};
  /// `packing_fraction = "predicted"`: `build` puts in a number, what is predicted less the error of that.
  bool predicted = false;
  bool fill = false;  ///< as many as the stages can place, at any price
  /// Of all spheres, in kg, in place of `count`, into which `build` makes it, within half a sphere: it then
  /// leaves it in `mass_counted`. Needs `Scene::material_density`.
  std::optional<double> mass = {};
  /// In kg/m³: the packing fraction times `Scene::material_density`. `complete` makes it into what a porosity
  /// becomes, see `BedTarget`, and leaves it in `bulk_density_asked`.
  std::optional<double> bulk_density = {};
  std::optional<double> mass_counted = {}, bulk_density_asked = {};
  BedTarget bed = {};
  Location where = {};

  bool has_packing_fraction() const { return packing_fraction || predicted; }
  bool has_count() const { return count || mass; }
  /// Whether it is left to the stages how many spheres there are.
  bool is_open() const { return !has_count() && !has_packing_fraction(); }
};

/// Spheres that have places before the first stage acts, and come first in the sequence. Their sizes are
/// those of the file.
struct Start {
  /// A CSV file whose header names its columns, or a folder that holds a result; none: an empty domain.
  std::optional<std::filesystem::path> file = {};
  std::optional<Unit> unit = {};  ///< of the file, where it does not say it; without it the scene's
  /// Edges of the periodic box that they lie in; without them those of the folder's box, else the scene's.
  std::vector<double> box = {};
  /// Of the file, at most one, in hexadecimal, as it was when the scene was run: other bytes are refused.
  std::vector<std::string> sha256 = {};
  /// The packing that is meant, where it stands in no file: `file` is what it is called, such as "first.npy",
  /// and a result has that file beside it.
  std::shared_ptr<const Packing> packing = {};
};

/// One more file of a result, as another program reads it: `scene.outputs = {{.format = "lammps"}}`. What its
/// format cannot be told, see `bernal export --help`, is of no matter there.
struct Output {
  std::string format;
  std::filesystem::path file = {};  ///< its name in the folder of the result; else the format's own
  std::optional<Unit> unit = {};    ///< of its lengths; else what the program expects
  /// Of the spheres, in kg/m³; without it the scene's `material_density`, else that of glass, 2500.
  std::optional<double> material_density = {};
  /// So many classes of radii, of equal width; else one for every radius, where few occur, or one for all.
  std::optional<int> types = {};
  /// Of an image, one at most: the edge of a voxel in the scene's unit, or how many there are along the
  /// longest edge of the domain's bounds; else 256 of them.
  std::optional<double> voxel = {};
  std::optional<int> resolution = {};
  VoxelValues values = VoxelValues::binary;
  std::string material = {};  ///< of an image of fractions: what alone it is of; empty: all of the spheres
  /// Of a file of triangles: what alone it holds, a layer of the spheres by its name; empty: whole spheres.
  std::string layer = {};
  bool layers = true;  ///< of files of solids and objects: a scene's layers of spheres, each by itself
  ContactTreatment contact = ContactTreatment::none;
  /// Between two spheres over the sum of their radii, to a wall over the radius: what a treatment leaves, or
  /// below what it acts.
  double contact_gap = 0.01;
  double bridge_radius = 0.2;  ///< over the smaller radius of the two that are joined
  double mesh_size = 0.3;      ///< edge of an element on a sphere, over its radius
  double mesh_gap = 2.5;       ///< edge of an element in a narrow gap, over the gap's width
  int mesh_order = 1;
  /// Of a file of triangles: what it holds, and how far a sphere may be from its triangles, over the radius.
  SurfaceChoice surface = SurfaceChoice::spheres;
  double deflection = 0.02;
  Locations locations = {};
};

/// A packing problem as the user states it: plain data. Lengths are in `unit`. What is left out `build` fills
/// in, and it refuses with an Error{bad_scene} what no scene file could say.
struct Scene {
  std::filesystem::path file;  ///< empty for a scene made in C++
  Unit unit = Unit::m;
  std::uint64_t seed = 1;
  SceneContainer container;  ///< the unit cube, if nothing else is said
  SceneSizes sizes;          ///< left at a Constant of 0 where those of the start are all there are
  bool sizes_are_diameters = false;
  /// In place of `sizes`, which is then left at its Constant of 0: see `weights_for_volumes`.
  std::optional<CellSizes> cells = {};
  double scale = 1;      ///< the spheres are so many times as large as `sizes` says
  bool largest = false;  ///< as many times as `Target::count` of them fit: `run` finds out
  /// Without it quantiles where a stage keeps the sizes in a container, and wherever few spheres carry much
  /// of the volume; else random.
  std::optional<Draw> draw = {};
  Target target;
  std::string material = {};                    ///< what the spheres are made of, by name; may be empty
  std::optional<double> material_density = {};  ///< of the spheres, in kg/m³
  std::vector<Zone>
      zones;  ///< parts of the container with spheres of their own; without = {}, as Mixture::of
  std::vector<Layer> layers = {};   ///< of all spheres; those of one class of sizes stand in `Classes`
  std::vector<Inside> inside = {};  ///< packings inside the spheres of a class
  Start start = {};
  std::optional<SceneEngine> engine = {};
  double gap = 0;       ///< least distance between the surfaces of two spheres, or of one and its own image
  double wall_gap = 0;  ///< least distance of a sphere's surface from the walls
  WallArithmetic walls = WallArithmetic::filtered;
  double overlap = 0;              ///< largest overlap ratio that the result may keep
  std::vector<Stage> stages = {};  ///< in order; none: the one that suits any container
  bool stages_are_default = false;
  std::vector<Output> outputs = {};
  Locations locations;  ///< of what stands in no container, sizes, stage or output

  /// Whether there are sizes to draw from, besides those of zones.
  bool draws() const {
    const auto* constant = std::get_if<Constant>(&sizes);
    return cells || !constant || constant->value != 0;
  }
  /// Surfaces that stand in files: those of the container and its obstacles, then those of the zones.
  std::vector<MeshFile*> meshes();
  std::vector<const MeshFile*> meshes() const;
  bool asks_for_gaps() const { return gap > 0 || wall_gap > 0; }
  bool is_periodic() const { return std::holds_alternative<PeriodicBox>(container); }
  int dimension() const {
    if (const auto* box = std::get_if<PeriodicBox>(&container)) return box->dimension;
    if (const auto* box = std::get_if<Box>(&container)) return box->dimension();
    return std::holds_alternative<Polygon>(container) ? 2 : 3;
  }
};

/// A part of the container with sizes, an amount and a material of its own, which nothing mixes with what is
/// around it. What no zone takes up is for the sizes of the scene, if it has any. Where spheres settle, zones
/// lie one upon the other: the spheres of each are poured onto those below, up to the level where it ends.
/// Elsewhere each is packed by itself, between the planes of its place as between walls.
struct Zone {
  std::string name = {};  ///< else that of its material, else "zone 2" of the second
  /// Planes, "z < 20" or "x > 5": the zone lies on that side of each. Of a zone that settles none: it lies on
  /// the zones that come before it.
  std::vector<std::string> place = {};
  std::vector<std::string> solids = {};  ///< of the container's file, by name or by number from 1
  std::optional<int> chamber = {};       ///< of a mesh of several closed spaces: the first is the largest
  /// A closed surface within the container, in the unit of its file; else in that of the container's file,
  /// else in the scene's.
  std::optional<MeshFile> mesh = {};
  /// The sizes, the amount, the material: what [spheres] may say, but for gaps, a start and beds.
  Scene spheres;
  Locations locations = {};
};

/// As scenes have them: "double", "filtered", "exact"; "random", "quantiles".
std::string_view name_of(WallArithmetic);
std::string_view name_of(Draw);

}  // namespace bernal
