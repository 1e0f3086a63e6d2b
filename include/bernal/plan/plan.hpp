#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/plan/mesh_price.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The spheres of a scene's start, in its unit.
struct StartSpheres {
  Spheres<dynamic> spheres = Spheres<dynamic>();
  Vector<dynamic> edges = {};  ///< of the periodic box that they lie in; none in a container
  std::string file = {};       ///< where they come from, and the line of the first
  int first_line = 0;
  std::string left_out = {};  ///< what else the packing there has and the scene does not ask for, in words
};

struct PlannedPart;
struct PlannedInside;

/// A scene that has been checked as a whole, with everything it names made and nothing else.
struct Plan {
  Scene scene;
  Domain domain;             ///< in the scene's unit
  bool box_follows = false;  ///< a periodic box whose size is the result: `domain` is a guess
  /// Of a domain that repeats itself nowhere, in its own frame, see `frame_of`: what preparing, running and
  /// measuring ask about the walls. Null for others, whose walls cost nothing to make, and where walls are to
  /// be decided in exact arithmetic, which estimates and measurements can do without; whoever replaces
  /// `domain` sets it to null, and `run` makes another.
  std::shared_ptr<const Container> container;
  std::string container_notes;              ///< what the importer did: reader, welding, repairs; may be empty
  StartSpheres start;                       ///< none where the scene names no start
  std::unique_ptr<SizeDistribution> radii;  ///< that are drawn, in the scene's unit; else those of the start

  /// What the stages are likely to reach, and what the result is likely to be: less, where less is asked for.
  double attainable_packing_fraction = 0, expected_packing_fraction = 0;
  double expected_count = 0;
  /// Of a bed: how much of it is left free, up to its surface, and how high that lies above the lowest point
  /// of the container; of a heap its tip. To a few per cent.
  struct ExpectedBed {
    double porosity, height;
  };
  std::optional<ExpectedBed> expected_bed = {};
  /// Of the run alone, on one thread; the most that it holds at a time, and what the process takes anyway.
  double expected_seconds = 0, expected_memory_bytes = 0;
  /// What a reader should see before the run: where a periodic box that is to be packed closely holds too few
  /// of its largest spheres for that, how many, and how many would do; where a CAD part may not be what is
  /// meant, why; a sentence, or empty.
  std::string caution;
  /// How the scene is understood where it leaves that open, and the line that says otherwise; sentences.
  std::vector<std::string> hints;
  bool places_expected = false;     ///< some stage ends with as many spheres as are expected to fit
  std::vector<PlanItem> items;      ///< what would run, in order
  std::vector<std::string> absent;  ///< effects that the scene does not call for and that are not built
  /// Of a scene with zones, in the order in which they are packed; else none. What the whole says is then
  /// their sum.
  std::vector<PlannedPart> parts;
  /// One for each of `Scene::inside`. What the whole says of spheres is without those that lie inside, what
  /// it says of time and memory with them.
  std::vector<PlannedInside> insides;
};

/// What is packed by itself of a scene with zones: a zone, or a piece of what lies in none.
struct PlannedPart {
  Plan plan = {};                       ///< in a domain of its own; of a layer, in all of the container
  std::uint32_t sphere_class = 0;       ///< of its spheres, see `classes_of`
  bool on_others = false;               ///< a layer, onto the spheres of those before it
  std::optional<double> level = {};     ///< where a layer ends: its height above the lowest point
  Vector<3> shift = Vector<3>::Zero();  ///< from the domain of its plan to the whole: of periodic boxes
};

/// What lies inside the spheres of a class: the plan of one such packing, in the ball that is expected.
struct PlannedInside {
  Plan plan = {};
  std::uint32_t of_class = 0, layer = 0;  ///< as in `PackingsInside`
  std::string name = {};                  ///< of the class; "spheres" where the scene tells none apart
  double ball = 0;                        ///< its radius, in the unit of the spheres' scene
  double filled = 0;                      ///< spheres that are likely to be filled
  std::optional<int> templates = {};      ///< packings that are made; without, one for every sphere

  double packings() const { return templates ? std::min<double>(*templates, filled) : filled; }
};

/// How many spheres there would be if every sphere held what its packing inside holds, those of all levels
/// among them: nothing of it is ever made.
double expected_count_of_all_levels(const Plan&);

/// Of a mesh around the expected spheres, with the defaults of `bernal mesh`; none in other dimensions than
/// three.
std::optional<MeshPrice> price_of_mesh(const Plan&);

/// Completes the scene and makes what it names. Throws Error (bad_scene, bad_mesh) where parts do not fit
/// each other: a sphere larger than the container, a mesh that is no container. Cost: reading the mesh.
Plan build(const Scene& scene);

/// The container or the periodic box that a scene describes, in the scene's unit: what `build` and the
/// certificate share. The size of a periodic box is taken as it
/// stands, even where the packing is to decide how large it becomes and only its proportions matter to
/// `build`; without a size it is the unit cube. Throws as `build`.
Domain domain_of(const Scene& scene);
/// The same, with what the importer and obstacles did in `notes`, and in `caution` what may not be meant: see
/// `MeshReport::cautions`; the scene then says itself what was left to the file.
Domain domain_of(Scene& scene, std::string& notes, std::string& caution);

/// The same for a packing that is there: throws Error{bad_scene} where the scene leaves it to the packing how
/// large the periodic box becomes and does not say how large it became.
Domain packed_domain_of(const Scene& scene);

/// Down, of a bed: the unit vector along which the last stage that settles presses its spheres; where none
/// does, against the last axis. Of two dimensions in the plane z = 0.
Vector<3> down_in(const Scene& scene);

/// Of its bed: down, and that there is one, where the last stage settles.
BedOptions bed_options_of(const Scene& scene);

/// Those of the scene's CAD files that are no longer what the scene names by its `sha256`.
std::vector<std::filesystem::path> changed_files(const Scene& scene);

/// The size distribution of radii that a scene describes, in the scene's unit: what is drawn from, or that of
/// its start where nothing is drawn. Throws as `build`.
std::unique_ptr<SizeDistribution> radii_of(const Scene& scene);

/// What the sizes of so many spheres of a scene are held against; nothing where its start has gone, for
/// a result is not lost with that.
struct SceneRadii {
  std::unique_ptr<SizeDistribution> all, drawn;
  std::vector<double> first;
  AskedRadii asked;  ///< of these
};
SceneRadii asked_radii_of(const Scene& scene, std::size_t count);
/// Of a packing, by its own seed; none where another program made it.
SceneRadii asked_radii_of(const Packing& packing);

}  // namespace bernal
