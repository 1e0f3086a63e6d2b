#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cost/rounds.hpp"
#include "scene/entry.hpp"

namespace bernal::cost {

/// One value of a knob.
struct Step {
  std::string text = {};                    ///< "5", "exact"
  std::function<void(Setting&)> turn = {};  ///< gives a setting that has the scene's own value this one
  double wall_deviation = 0;                ///< of the wall that is used from the one that is meant
  std::optional<double> number = {};        ///< where there may be others between two of them
};

/// A key of the scene that buys accuracy with time.
struct Knob {
  std::string name = {};                ///< "alpha"; "refill tolerance" where several stages have such a key
  std::vector<Step> steps = {};         ///< in any order
  std::vector<std::size_t> order = {};  ///< of them from cheap to dear
  std::size_t own = 0;                  ///< the step that the scene has
  /// The step of a number, which must be one that the key accepts; empty where there are no others.
  std::function<Step(double)> step_at = {};
  bool is_whole = false;
  bool is_limit = false;   ///< to be turned only where the scene ends at it
  bool tells_all = false;  ///< what each of its steps takes is said, preparing included
  std::string note = {};   ///< what it is, where it is no key of a scene

  std::size_t place_of(std::size_t step) const;  ///< in the order
  /// A new step half way, the geometric mean to two digits; none where there is no room. Precondition:
  /// neighbours in the order.
  std::optional<std::size_t> insert_between(std::size_t cheaper, std::size_t dearer);
};

/// A scene to vary: as `build` completed it, with its files by absolute names and by what they hold.
struct Subject {
  Scene scene;
  std::shared_ptr<const Domain> domain;  ///< that is meant
  double attainable_packing_fraction = 0;
  double mean_radius = 1;
  double smallest_radius = 0;  ///< all but very few are larger
  bool places_expected = false;
  bool box_follows = false;
  bool is_predicted = false;  ///< the packing fraction that is asked for
  bool with_limits = false;   ///< keys that buy something only where a run ends at them are knobs, too
};
Subject subject_of(const Scene& scene);

/// The knobs that the scene has, in the order of its tables. Meshes that stand for a curved container are
/// written into the folder, and the record names them. Those that cannot be turned in this scene are left
/// out. Cost: a `build` for each that is not of a stage.
std::vector<Knob> knobs_of(const Subject& subject, const std::filesystem::path& folder, TrialRecord& record);

}  // namespace bernal::cost
