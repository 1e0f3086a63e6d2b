#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/version.hpp"

namespace bernal {

/// How a run ended.
enum class Outcome {
  converged,  ///< what the scene asked for is there
  loose,      ///< all spheres are there, but jammed well below random close packing of their sizes
  full,       ///< a count or packing fraction was asked that the stages could not reach: no place is left
  hit_limit,  ///< a limit on iterations ended it
  cancelled,  ///< the user did
  imported,   ///< another program made it: nothing was asked of it
};
std::string_view name_of(Outcome);
/// Whether the stages came to their own end with all spheres that were asked for.
inline bool is_packed(Outcome outcome) { return outcome == Outcome::converged || outcome == Outcome::loose; }

/// Whether a run ended without what the scene asks for, so that nobody should take its packing for that.
inline bool falls_short(Outcome outcome) {
  return outcome != Outcome::converged && outcome != Outcome::imported;
}

/// One line of `bernal explain`: something that would run, and what it costs.
struct PlanItem {
  std::string name;  ///< "walls", "neighbour lists", "compress", …
  std::string what;  ///< one phrase
  std::string cost;  ///< "O(N)", "O(N log T)", …
  /// What it is expected to cost a run on one thread, by the stages' own models: three times in four within a
  /// factor of two. 0 where that is nothing or `if_needed`.
  double seconds = 0, bytes = 0;
  bool part = false;       ///< its seconds are among those of another line, as in `Packing::effects`
  bool if_needed = false;  ///< it runs only where the others do not reach what is asked for
};

/// What one effect (insertion, compression, walls, neighbour lists, …) cost in a run. Seconds of one may be
/// among those of another; those of walls are summed over threads. Of single events (collisions, questions to
/// walls, …) one in 64 is timed and the sum scaled.
struct Effect {
  std::string name;
  std::uint64_t calls = 0;
  double seconds = 0;
};

/// The state of the packing after a stage or a round of one: the run's history, for the report.
struct Milestone {
  std::string stage;
  std::uint64_t spheres = 0;
  double packing_fraction = 0;
  double potential = 0;    ///< mean height of the spheres along the compression direction, scene units
  double max_overlap = 0;  ///< largest overlap ratio of a pair that a relaxation has left so far
  double seconds = 0;      ///< since the start of the run
};

/// Where a run keeps its state now and then, so that it can go on from there after the process has ended,
/// however that was: to the same bits as if nothing had happened, for any number of threads before and after.
struct CheckpointOptions {
  /// That will hold the result: checkpoints stand in a folder of their own within. Empty: none are written.
  std::filesystem::path folder = {};
  /// Seconds between two, at least; more where writing takes more than a fiftieth of the time. One more is
  /// written when the monitor says stop.
  double every = 60;
  /// Goes on from the latest of the same scene, seed and packings number, if there is one.
  bool resume = false;
  /// Told in a sentence what people should know at once: that it goes on, or starts anew, or cannot write.
  std::function<void(const std::string&)> tell = {};
  /// Asked at every safe point in place of the clock: whether one is to be written now.
  std::function<bool()> due = {};
};

struct Packing;

/// The packings inside the spheres of one class, as `Scene::inside` asks for: each of `spheres` holds one of
/// `templates`, turned about its centre.
struct PackingsInside {
  std::uint32_t of_class = 0, layer = 0;  ///< places in `classes_of(scene)` and in the layers of that class
  /// Packed in balls about the origin, in the unit of their own scene; the scene that packs them has that
  /// ball as its container.
  std::vector<std::shared_ptr<const Packing>> templates = {};
  std::vector<std::uint32_t> spheres = {};            ///< that are filled, ascending
  std::vector<std::uint32_t> which = {};              ///< of `templates`, one a filled sphere
  std::vector<std::array<double, 4>> rotations = {};  ///< unit quaternions w, x, y, z, one a filled sphere
};

/// What is there of the volumes that a scene asks of the cells of its packing, see `Scene::cells`.
struct PackedCells {
  /// The volumes that the scene states are scaled by this, so that their sum is the volume of the box.
  double scale = 1;
  /// Below which this share of the cells lies, in the scene's unit to the power of three: as it is wanted, of
  /// the cells by the radii of the spheres, and of those by the weights.
  struct Quantile {
    double share, wanted, by_radii, reached;
  };
  std::vector<Quantile> quantiles = {};
  /// Kolmogorov's, from the distribution that the scene states: the largest difference of the shares below
  /// any volume. Of N cells it is 1/(2N) at least.
  double distance_by_radii = 0, distance = 0;
  double error = 0;            ///< the largest deviation of a volume from the one that is wanted of it
  double mean_sphericity = 0;  ///< of the cells, see `CellWeights`
  int rounds = 0;              ///< in which the spheres were packed again with other sizes
  int steps = 0;               ///< of Newton's method
};

/// The result of a run: plain data. Lengths are in the scene's unit and frame. `spheres` has the dimension of
/// the domain.
struct Packing {
  Spheres<dynamic> spheres;  ///< centres in one period, see `wrap`
  /// Of each sphere, its place in `classes_of(scene)`; empty where the scene tells no spheres apart.
  std::vector<std::uint32_t> classes = {};
  std::vector<PackingsInside> inside = {};  ///< one for each of `Scene::inside`
  /// Of the cells that the scene asks for, one a sphere, see `CellWeights`; without such their weights are
  /// the squared radii. `with_weights` has spheres of these cells.
  std::vector<double> weights = {};
  std::optional<PackedCells> cells = {};  ///< of the run that found the weights
  Domain domain;
  /// Of the domain, see `Plan::container`, so that measuring need not make it again; may be null.
  std::shared_ptr<const Container> container = {};
  double volume = 0;                     ///< of the domain
  double expected_packing_fraction = 0;  ///< by the plan, before the run
  std::string caution = {};              ///< the plan's
  std::vector<std::string> hints = {};   ///< the plan's
  /// Random close packing of the very sizes that are there, by the rod model, see `predict_packing_fraction`;
  /// nothing where that says nothing: between walls, in other than three dimensions.
  std::optional<double> expected_of_sizes = {};
  /// In kg/m³, where the scene asks for one: what was asked, and what is there, of a bed up to its surface.
  struct BulkDensity {
    double asked = 0, reached = 0;
  };
  std::optional<BulkDensity> bulk_density = {};
  /// All sizes are so many times those that were drawn: in a container `polish` lets them grow until they
  /// jam.
  double size_scale = 1;
  Scene scene;
  std::uint64_t seed = 1;
  int threads = 1;
  Program program;  ///< that made it
  Outcome outcome = Outcome::converged;
  std::string reason;  ///< one sentence behind the outcome
  std::vector<Effect> effects;
  std::vector<Milestone> history;
  double seconds = 0;  ///< of all processes that it took
  int resumed = 0;     ///< how often it went on from a checkpoint

  double packing_fraction() const;
};

/// What spheres of that packing fraction weigh together, in kg, by the scene's `material_density`, else by
/// those of their layers, or where the scene has zones by those of its classes; nothing where these are not
/// said, and in other than three dimensions.
std::optional<double> mass_of(const Packing&, double packing_fraction);

}  // namespace bernal
