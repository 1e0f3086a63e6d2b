#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal::cost {

/// What one run of a scene reached and what that cost. Ratios are of the sum of two radii for pairs and of
/// the radius for walls.
struct Trial {
  std::uint64_t seed = 1;
  int threads = 1;
  int packings_number = bernal::packings_number();  ///< of the bernal that ran it
  Outcome outcome = Outcome::cancelled;
  std::string reason;
  bool cut_off = false;  ///< it reached `TrialOptions::limit`: all that is known is that it is slower

  std::uint64_t spheres = 0;
  /// Strict: of the spheres shrunk by the largest overlap that is left, so that none overlaps, and of the
  /// sizes that the scene asks for: phi ((1 - max_overlap) / size_scale)^D, of what is certified.
  double packing_fraction = 0;
  double packed_fraction = 0;  ///< as the packing states it, of its own domain
  double size_scale = 1;       ///< see `Packing::size_scale`
  bool certified = false;      ///< as the scene asks for it, with the overlap that it allows
  double max_overlap = 0;      ///< that the certificate finds; 0 where no pair overlaps
  double early_overlap = 0;    ///< the largest before the finish: the last that a stage reports of itself
  double protrusion = 0;       ///< of the sphere that sticks out of the exact wall most; 0 where none does
  /// Gap of the sphere nearest to a wall, by the certificate; absent where none is near.
  std::optional<double> wall_gap;
  /// The smallest gap ratio at which half of the spheres or more are held by contacts: how far the contacts
  /// are closed. None that is below `max_overlap`: a pair that overlaps is as far from touching as one that
  /// lies so much apart. Absent where they are not at 0.01.
  std::optional<double> held_from;
  /// Contacts of the backbone over those that just hold it, at that gap; 1 is isostatic.
  std::optional<double> contact_ratio;
  std::uint64_t rattlers = 0;  ///< at that gap
  double coordination = 0;     ///< mean number of contacts of a sphere, at gaps of 0.002
  std::string hash;            ///< of the spheres

  double seconds = 0;      ///< of the run on the wall
  double cpu_seconds = 0;  ///< of the run, in all threads: what to compare on a machine that has other work
  double prepare_seconds = 0;  ///< before the run, on the wall: files are read, what the scene names is made
  /// Memory that the run took at its peak beyond what the process had before; absent where the system does
  /// not tell.
  std::optional<double> peak_bytes;
  std::vector<Effect> effects;

  bool converged() const { return outcome == Outcome::converged; }
};

struct TrialOptions {
  std::uint64_t seed = 1;
  int threads = 0;                                         ///< 0: as many as the machine has
  double limit = std::numeric_limits<double>::infinity();  ///< seconds on the wall, then it is cut off
  /// The domain that is meant, where the scene's only stands for it: packing fraction and walls are judged by
  /// this one. Null: the scene's own.
  const Domain* meant = nullptr;
  Monitor monitor = {};
};

/// Builds and runs a scene, certifies and measures what comes out. Nothing is written. Cost: that of the run,
/// and some µs a sphere. Throws as `build`; being cancelled or cut off is an outcome.
Trial run_trial(const Scene& scene, const TrialOptions& options);

}  // namespace bernal::cost
