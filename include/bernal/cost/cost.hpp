#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

struct CostOptions {
  double seconds = 600;  ///< on the wall, for all of it; the run that is on when they are over is forgotten
  int seeds = 2;         ///< runs of every setting: with the scene's seed and those that follow it
  int threads = 0;       ///< 0: as many as the machine has
  std::size_t most_settings = 200;  ///< combinations are tried until so many settings are known
  bool fresh = false;               ///< forget what an earlier call measured
  Monitor monitor = {};
};

/// What a scene with some of its values changed reached and took. Medians over the seeds; `…_scatter` is half
/// of what lies between the least and the greatest.
struct CostRow {
  std::string setting;               ///< "alpha = 5, stop = 1e-05"; "as it is" for the scene itself
  std::vector<std::string> changed;  ///< the knobs that are not as in the scene: "alpha", "stop"
  int runs = 0;
  bool slower = false;  ///< a run was cut off: only that it is slower than `seconds` is known
  /// Strict: of the spheres shrunk by the overlap that is left, and of the sizes that are asked for; of the
  /// volume of the scene's own container.
  double phi = 0, phi_scatter = 0;
  std::vector<double> phi_of_seed;  ///< in the order of the seeds; the runs that were not cut off
  /// By how much it is denser than the scene as it is with the same seed: the mean over the seeds, and its
  /// standard error, of which one seed says nothing.
  double phi_change = 0;
  std::optional<double> phi_change_error;
  double size_scale = 1;  ///< all sizes over those that are asked for, see `Packing::size_scale`
  double seconds = 0, seconds_scatter = 0;  ///< of processor time, all threads together, without preparing
  double wall_seconds = 0, prepare_seconds = 0;
  std::optional<double> memory_bytes;   ///< at the peak, beyond what the process had before
  double early_overlap = 0;             ///< largest ratio before the finish
  double max_overlap = 0;               ///< that is left
  std::optional<double> held_from;      ///< smallest gap ratio at which half of the spheres are held
  std::optional<double> contact_ratio;  ///< contacts of those over what just holds them; 1: isostatic
  double coordination = 0;              ///< at gaps of 0.002
  double wall_error = 0;  ///< how far the wall that was used may lie from the exact one, or a sphere sticks
                          ///< out of it, in mean radii
  double spheres = 0;     ///< with the scene's own seed
  Outcome outcome = Outcome::converged;  ///< the worst of the runs
  std::string reason;                    ///< one sentence behind that outcome
  bool certified = false;                ///< all of them
  std::string hash;                      ///< of the spheres with the scene's own seed
  double own_phi = 0, own_seconds = 0;   ///< with the scene's own seed, processor time
  double packed_phi = 0;   ///< of the same run as `bernal pack` states it: with the overlap that is left
  bool is_repeat = false;  ///< with fewer changes of the scene come the same spheres: neither on a front nor
                           ///< recommended
  bool pareto = false;     ///< no setting that is as quick is denser, see `CostReport::phi_step`
  bool pareto_contacts = false;  ///< no setting that is as quick closes its contacts further
};

struct CostReport {
  std::vector<CostRow> rows;  ///< the quickest first
  std::size_t own = 0;        ///< the scene as it is
  std::size_t recommended = 0;
  std::string recommendation;  ///< one sentence
  std::vector<std::string>
      verdicts;      ///< a sentence a knob: what it buys for this scene, or that it buys nothing
  std::string toml;  ///< of the recommended scene, whole
  /// Packing fractions that differ by less count as equal: the standard error, over the seeds, of what a
  /// setting differs from the scene by, of the median setting, and at most 0.005. Of one seed nothing is
  /// known; then it is 1e-5.
  double phi_step = 0;
  std::vector<std::string> refused;          ///< settings that cannot be run, each with why
  std::string ending;                        ///< why no more was measured
  std::size_t runs_made = 0, runs_kept = 0;  ///< in this call, in earlier ones
  /// In one sentence, which runs of earlier calls do not count, as a bernal of other packings made them;
  /// empty if all do.
  std::string outdated;
  bool complete = false;  ///< nothing was left to try
  bool cancelled = false;
  std::vector<std::filesystem::path> files;
};

/// Runs a scene with other values of the keys that buy accuracy in its stages, its accuracy and its container
/// (`schema::Key::ladder`), and says what each costs and buys.
///
/// First the scene as it is, then one key after the other a step at a time, away from the scene's value, then
/// combinations of those that made a difference, near the front that has been found, until the time is over
/// or nothing is left to try. Where the scene leaves open how many spheres there are in a given container,
/// the packing fraction that is asked for is such a key; for a cylinder and a sphere so is the number of
/// faces of a mesh that stands for it.
///
/// The front: settings in the order of their seconds, each of which is denser than all before it by more than
/// `phi_step`; and a second one whose contacts are closed further, by a factor of two of the gap. Only runs
/// count that are certified and reach what they are asked for, if the scene as it is does.
///
/// The recommendation is the quickest setting that, with the same seeds, is as dense as the scene as it is
/// and as the densest setting: within 0.001 in the mean, or within its standard error where that is more, and
/// no more than 0.005. What gives the same spheres as another setting is never recommended in its place.
///
/// Writes cost.csv, cost.md, cost.svg, cost.html and recommended.toml into `folder`, all or none, and beside
/// them trials.csv, which holds every run and makes that none is made twice, and names these files with their
/// digests. Cost: the time that is given. Throws as `build`, Error{bad_argument} where not one run of the
/// scene as it is ends in the time given, and Error{cannot_write}, before anything is run, where a file of
/// somebody else, one that was changed since, or the scene itself has one of the names.
CostReport measure_cost(const Scene& scene, const std::filesystem::path& folder,
                        const CostOptions& options = {});

}  // namespace bernal
