#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"
#include "core/archive.hpp"
#include "work/bed.hpp"
#include "work/checkpoints.hpp"
#include "work/effect_log.hpp"
#include "work/supply.hpp"

namespace bernal {

/// Why a stage came to its end.
enum class StageEnd {
  converged,  ///< it did what it is for
  full,       ///< no place was left for the next sphere
  hit_limit,  ///< its limit on iterations or rounds came first
  cancelled,
};

/// What decides how a box of given edges is best filled with spheres of given radii.
struct FillTask {
  int dimension = 3;
  double packing_fraction = 0;  ///< that is asked for
  double attainable = 1;        ///< random close packing of these sizes
  double size_ratio = 1;        ///< of the largest radius to the smallest, but for one in 10,000 of each
  /// Mean radius by volume over the mean by number: 1 for equal spheres, exp(3.5 sigma²) for lognormal ones.
  double width_of_sizes = 1;
  bool has_walls = false;
  bool may_overlap = false;  ///< some overlap is allowed to stay
};

template <int D>
double volume_of(const Spheres<D>& spheres) {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(static_cast<int>(spheres.x.size()), r);
  return sum;
}

/// How far a stage has come, for the run's history and the progress bar.
struct Course {
  std::string_view stage;
  std::uint64_t spheres = 0;
  double packing_fraction = 0;
  std::optional<double> potential = {};  ///< mean height in the bed, in the packer's unit
  double max_overlap = 0;                ///< largest overlap ratio of a pair
  std::optional<double> done = {};       ///< in [0, 1], where the stage knows it
  bool for_history = true;               ///< false: for the progress bar alone
};

/// What the stages of one run share: where they report, what is asked for, and the spheres as the last of
/// them left them. Lengths are in the packer's unit, a power of two of the scene's.
///
/// The spheres stand in one of two ways, and a stage works on one of them. In a *bed*, spheres of the drawn
/// sequence come one after the other into a domain of fixed size with walls; in a *box*, which may be scaled,
/// all of them are there from the start and stages give them their places. `stand_in_bed` and `stand_in_box`
/// lead from one to the other.
struct Work {
  /// The first of the drawn sequence, in its order, of which some have places.
  struct Drawn {
    Spheres<3> spheres;
    std::vector<bool> placed;
    void extend(std::size_t count, const Supply& supply);
  };

  // ---- the spheres in a box

  /// Radii as drawn, which no stage changes. Centres in [0, edge) once `placed`.
  Spheres<dynamic> spheres;
  /// Of the box; before the spheres are placed only its proportions mean something.
  Vector<dynamic> edges;
  bool placed = false;
  /// Axes on which the box ends at walls, with whole spheres between them; empty: none.
  std::vector<bool> walls = {};
  /// Those that the box is to end with, where the scene says so.
  std::optional<Vector<dynamic>> target_edges = {};
  /// While a stage puts spheres in their places one after the other: how many have them, and their share of
  /// the volume of all. Otherwise all do.
  std::size_t placed_count = 0;
  double placed_share = 1;
  /// By the plan, for stages that choose their method.
  FillTask fill_task = {};
  /// How a stage went about it, for people: follows "all 200 spheres are placed".
  std::string account = {};
  /// What a stage was to do beside placing spheres, and did not: a sentence; empty where there is nothing.
  std::string missed = {};
  /// All sizes are that many times those that were drawn: a stage closed contacts by letting them grow.
  double size_scale = 1;
  /// In a box, of the first stage: so many of the first spheres come from the start with places in a box of
  /// these edges, and some of them may overlap. Once all have places they are `placed`, too.
  std::size_t begun = 0;
  bool may_overlap = false;
  /// The same in a bed: the start as it is, where not all of it fits.
  Spheres<3> crowded_start = {};
  /// Volume of the box that the spheres needed, before it grew to the one that was asked for.
  double needed_volume = 0;

  // ---- what is asked for

  /// Largest overlap ratio that the result may keep; 0 for none.
  double allowed_overlap = 0;
  Target target = {};
  /// The packing fraction that the stages are likely to reach.
  double attainable = 1;
  /// Random close packing of the sizes without walls, as predicted; 0 where no stage asks.
  double close_packing = 0;
  Domain domain = {};
  /// A place within some roundings of this one at which a sphere of that radius lies inside the domain of the
  /// scene, touching allowed: for those that the walls leave no room. Set by the run.
  std::function<std::optional<Vector<3>>(const Vector<3>& place, double r)> exact_place = {};
  std::shared_ptr<Supply> supply = {};
  std::shared_ptr<const Container> container = {};  ///< null where there is no bed

  // ---- where stages report

  const std::uint64_t seed;
  const Monitor& monitor;
  EffectLog& effects;
  std::function<void(const Course&)> on_course = {};
  std::uint64_t streams_used = 0;
  Checkpoints* checkpoints = nullptr;  ///< none: those that stages make are without use
  /// At a safe point of a stage, within a `Part`: see `Checkpoints::stop`.
  bool stop() { return checkpoints ? checkpoints->stop() : monitor.stop(); }

  /// A fresh stream of random numbers for one round of a stage.
  Random random(Stream purpose) { return {seed, stream(purpose, streams_used++)}; }

  int dimension() const { return spheres.dimension(); }
  double volume_of_spheres() const { return volume_of(spheres); }
  bool has_wall(int axis) const { return !walls.empty() && walls[static_cast<std::size_t>(axis)]; }

  /// Precondition: the spheres stand in a bed.
  Bed& bed() { return *bed_; }
  const Bed& bed() const { return *bed_; }
  bool stands_in_bed() const { return bed_ != nullptr; }
  /// How many of the sequence fill this share of the container.
  std::size_t count_filling(double packing_fraction) const;
  /// How many spheres a stage that places what is expected is to place.
  std::size_t target_count() const;
  /// At least `count` of the sequence, and up to the last that stands in the bed; those have places.
  Drawn drawn(std::size_t count) const;
  /// Work on these of the sequence by themselves, in their order, with nothing in its place: no container
  /// yet, no checkpoints, and nobody is told of its course.
  Work alone(const std::vector<std::uint32_t>& tags) const;
  /// The roomiest place of the container, as far as it is known. Looked for once.
  const Room& roomiest() const;
  /// Of so many of the sequence, or all that stand in the bed if these are more.
  double volume_of_drawn(std::size_t count) const;
  /// Whether the walls leave a sphere of this radius less room than the skin, so that it only fits touching.
  bool is_snug(double r) const { return r + bed().skin() > roomiest().radius; }
  /// Whether a sphere may appear at a place: clear of others by the skin; and of walls, or touching them
  /// exactly if they leave it no other choice.
  bool fits_in_bed(const Vector<3>& place, double r) const;

  /// The first of the sequence in place of all that is in the bed, but for those that do not fit where they
  /// are. Returns whether all do.
  bool put_in_bed(const Spheres<3>& first);
  /// Precondition: there is a container. What stood in a box keeps its places.
  void stand_in_bed();
  /// The first of the sequence, up to the last that stands in the bed, or as many as are wanted where a count
  /// or a packing fraction is; those that have no place are left out.
  void stand_in_box();

  /// To be called some hundred times a stage at most: of the bed; of the box, where `done` says how far the
  /// stage has come; and of spheres that are in neither, because they overlap or are still to grow.
  void milestone(std::string_view stage) const;
  void milestone(std::string_view stage, double done, double max_overlap) const;
  /// The same for who knows the volume of all spheres, which takes O(N) to add up.
  void box_milestone(std::string_view stage, double volume, double done, double max_overlap,
                     bool for_history = true) const;
  void crowd_milestone(std::string_view stage, std::size_t count, double volume, double max_overlap,
                       double done) const;

  /// Of the sequence, in its order, without those that have no place; and without those that may not stand
  /// where they are, if that is asked.
  void insert_in_bed(const Spheres<dynamic>& others,
                     const std::function<bool(const Vector<3>&, double)>& may_stand = {});

  /// What stages leave to each other, besides the spheres.
  void archive_facts(Archive& a) {
    a(edges, placed, placed_count, placed_share, target_edges, account, missed, size_scale, begun,
      may_overlap, crowded_start, needed_volume, streams_used);
  }
  /// The spheres that stand in a bed, which is made if there is none, and those that are still to come.
  void archive_bed(Archive& a);

  std::shared_ptr<Bed> bed_ = {};
  mutable std::optional<Room> roomiest_ = {};
};

/// The state of a stage, or of what it does, while this lives: see `Checkpoints::Part`. In work without
/// checkpoints it is none.
class Resumable {
 public:
  Resumable(const Work& work, std::string_view name, std::function<void(Archive&)> state) {
    if (work.checkpoints) part_.emplace(*work.checkpoints, name, std::move(state));
  }
  bool resumed() const { return part_ && part_->resumed(); }

 private:
  std::optional<Checkpoints::Part> part_;
};

/// Checkpoints are not written while this lives.
class NotResumable {
 public:
  explicit NotResumable(const Work& work) : pause_(work.checkpoints) {}

 private:
  const Checkpoints::Pause pause_;
};

/// The spheres as they stand before a stage, so that a stage which is cut short takes nothing away from what
/// the ones before it left. Cost: a copy of the spheres.
class Keepsake {
 public:
  explicit Keepsake(const Work& work);
  Keepsake() = default;  ///< to be read from an archive

  /// Puts everything back if less of the domain is filled now. What stood in a bed stands in one again.
  void give_back_if_denser(Work& work) const;

  void archive(Archive& a) { a(in_bed_, packing_fraction_, spheres_, edges_, needed_volume_); }

 private:
  bool in_bed_ = false;
  double packing_fraction_ = 0;
  Spheres<dynamic> spheres_;
  Vector<dynamic> edges_;
  double needed_volume_ = 0;
};

}  // namespace bernal
