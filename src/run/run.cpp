#include "bernal/run/run.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "core/parallel.hpp"
#include "plan/estimate.hpp"
#include "plan/fitting.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/shortfall.hpp"
#include "plan/stages.hpp"
#include "plan/start.hpp"
#include "run/begin_packing.hpp"
#include "run/checkpoint_owner.hpp"
#include "run/conclude.hpp"
#include "run/exact_place.hpp"
#include "run/run_cells.hpp"
#include "run/run_insides.hpp"
#include "run/run_largest.hpp"
#include "run/run_record.hpp"
#include "run/run_stages.hpp"
#include "run/run_zones.hpp"
#include "run/take_coats_off.hpp"
#include "scene/layers_of_scene.hpp"
#include "sizes/cut_above.hpp"
#include "work/counted_container.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {
namespace {

/// How often a box of given size that is to be filled is tried with another number of spheres.
constexpr int most_attempts = 6;
/// What the second attempt leaves free of the packing fraction that the first one reached, so that it fits;
/// every further attempt leaves twice as much.
constexpr double caution = 5e-4;
/// A first attempt that leaves more than this of the volume free was too small.
constexpr double too_much_room = 5e-3;

/// That of a box, which stays where it is: the power of two below the largest radius is its unit.
Frame frame_of_box(const Vector<dynamic>& edges, double largest_radius) {
  Frame frame;
  frame.scale = std::exp2(std::floor(std::log2(largest_radius)));
  const double farthest = edges.maxCoeff() / frame.scale;
  frame.resolution = std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest;
  return frame;
}

/// Of sizes up to the largest sphere that fits: those beyond are not drawn.
double random_close_packing_of(const Plan& plan) {
  const SizeDistribution& radii = *plan.radii;
  const int dimension = plan.scene.dimension();
  if (std::isfinite(radii.max())) return close_packing_fraction(radii, dimension);
  return close_packing_fraction(CutAbove(radii, tail_cut(plan.scene, plan.domain, radii, plan.container)),
                                dimension);
}

/// One run of a plan's stages. What they pack has room for the gaps that the scene asks for; what is handed
/// over has not.
class Run {
 public:
  Run(const Plan& plan, const RunOptions& options, Packing& packing, std::vector<Vector<3>> few_places = {})
      : stated_(plan),
        with_room_(needs_room(plan) ? std::optional(plan_with_room(plan)) : std::nullopt),
        plan_(with_room_ ? *with_room_ : plan),
        scene_(plan_.scene),
        monitor_(options.monitor),
        engine_folder_(options.engine_folder),
        packing_(packing),
        few_places_(std::move(few_places)),
        any_in_bed_(any_in_bed(plan.scene)),
        record_(packing),
        exact_place_(plan_, frame_),
        checkpoints_(options.monitor, options.checkpoints,
                     options.checkpoints.folder.empty() ? CheckpointOwner()
                                                        : checkpoint_owner(plan.scene, packing.seed),
                     [this](Archive& a) { record_.archive(a, report_); }) {}

  /// As far as the first stage begins.
  void check() {
    Task task;
    Reporter report = begin_report();
    start(any_in_bed_ ? Supply::densest : plan_.expected_packing_fraction, task, report, false);
  }

  void go() {
    try {
      attempt();
    } catch (const Cancelled&) {  // before there was anything to keep
      packing_.spheres = Spheres<dynamic>(dimension_of(plan_.domain));
      packing_.outcome = Outcome::cancelled;
      packing_.reason = "stopped by the user before the first sphere was placed";
      state_edges();
    }
    packing_.reason = in_dimension(packing_.scene.dimension(), packing_.reason);
    packing_.seconds = record_.seconds();
  }

 private:
  void attempt() {
    double fraction = any_in_bed_ ? Supply::densest : plan_.expected_packing_fraction;
    int attempt = 1;
    // What is told of the run so far comes first, that effects are in its order, and last, as it was.
    const Checkpoints::Part part(checkpoints_, "run", [&](Archive& a) {
      a(attempt, fraction);
      record_.archive(a, report_);
    });
    for (;; ++attempt) {
      Task task;
      Reporter report = begin_report();
      SpheresOfRun spheres = start(fraction, task, report);
      report_ = &report;
      const StageEnd end = run_stages(scene_, spheres, report, checkpoints_, pressed_);
      report_ = nullptr;
      if (const std::optional<double> other = other_fraction(spheres, end, attempt)) {
        fraction = *other;
        continue;
      }
      hand_over(spheres);
      packing_.expected_of_sizes = expected_of_sizes(packing_);
      conclude(packing_, spheres, report, end, ending());
      return;
    }
  }

  Ending ending() const {
    const bool packs = any_stage(scene_, &StageTraits::reaches, Reaches::close_packing) ||
                       any_stage(scene_, &StageTraits::reaches, Reaches::settled);
    const bool close = packs && any_in_bed_ && scene_.target.is_open();
    return {.plan = stated_,
            .places_expected = table_of(scene_.stages.back()).traits.places_expected,
            .unit = frame_.scale,
            .attainable = plan_.attainable_packing_fraction,
            .close_packing = close ? random_close_packing_of(plan_) : 0,
            .pressed = pressed_};
  }

  Reporter begin_report() {
    return {.seed = packing_.seed,
            .monitor = monitor_,
            .effects = record_.effects(),
            .on_progress = [this](const StageProgress& progress) { tell(progress); },
            .checkpoints = checkpoints_.keeps() ? &checkpoints_ : nullptr};
  }

  /// The drawn sequence and the frame that follows from it; places have the spheres of a start, or those that
  /// an engine has moved. Says what the task of the stages is, which outlives the spheres.
  SpheresOfRun start(double fraction, Task& task, Reporter& report, bool with_engine = true) {
    const Interruptible listening(monitor_);
    task = {.target = scene_.target,
            .allowed_overlap = scene_.overlap,
            .attainable = plan_.attainable_packing_fraction,
            .close_packing = scene_.target.bed.density ? random_close_packing_of(plan_) : 0,
            .fill_task = fill_task_of(plan_)};
    const int dimension = dimension_of(plan_.domain);
    const Vector<dynamic> edges = bounds_of<dynamic>(plan_.domain).size();
    Supply::Source source{*stated_.radii, dimension, packing_.seed, *scene_.draw};
    source.first = stated_.start.spheres.r;
    source.coat = coat_of(scene_);
    double volume = volume_of(plan_.domain);
    std::shared_ptr<Supply> supply;
    if (scene_.is_periodic()) {
      if (any_in_bed_ && !std::isfinite(source.radii.max()))
        source.cut = tail_cut(scene_, plan_.domain, *plan_.radii);
      supply = supply_from(source, volume, fraction);
      frame_ = frame_of_box(edges, supply->largest());
    } else {
      frame_ = frame_for(scene_, plan_.domain, *plan_.radii);
      task.domain = to_local(plan_.domain, frame_);
      std::shared_ptr<const Container> made = plan_.container;
      if (!made) made = make_container(task.domain, scene_.walls, frame_.resolution);
      task.container = counted(std::move(made));
      volume = std::pow(frame_.scale, dimension) * task.container->volume();
      if (!std::isfinite(source.radii.max()))
        source.cut = tail_cut(scene_, plan_.domain, *plan_.radii, plan_.container);
      supply = supply_from(source, volume, fraction);
    }
    if (!plan_.box_follows) {
      const double allowed = has_walls(plan_.domain) ? 0 : scene_.overlap;
      require_fitting(scene_, plan_.domain, plan_.container, (1 - allowed) * supply->largest());
    }
    if (any_in_bed_) require_long_periods(scene_, plan_.domain, supply->largest());
    if (!scene_.layers.empty())
      require_layers_fit(scene_, supply->smallest() - source.coat, supply->largest() - source.coat);
    supply->divide_by(frame_.scale);
    task.frame = frame_;
    task.target.bed.above_ground /= frame_.scale;
    task.few_places = few_places_;
    if (any_in_bed_)
      task.exact_place = [this](const Vector<3>& place, double r) { return exact_place_.near(place, r); };
    if (with_room_)
      share_ = share_of_drawn(*supply, dimension) * volume_of(plan_.domain) / volume_of(stated_.domain);
    if (scene_.is_periodic()) describe_box(task, edges / frame_.scale);
    SpheresOfRun spheres = begin(task, std::move(supply), edges / frame_.scale);
    take_start(plan_, frame_, spheres, report);
    if (scene_.engine && with_engine) take_engine(plan_, engine_folder_, spheres, report);
    return spheres;
  }

  /// Walls that stages may ask.
  std::shared_ptr<const CountedContainer> counted(std::shared_ptr<const Container> walls) {
    auto asked = std::make_shared<CountedContainer>(std::move(walls));
    record_.count(asked);
    return asked;
  }

  /// A packing fraction is asked of the scene's own spheres and its own domain.
  std::shared_ptr<Supply> supply_from(const Supply::Source& source, double volume, double fraction) const {
    const bool stated = with_room_ && scene_.target.packing_fraction;
    return std::make_shared<Supply>(source, stated ? volume_of(stated_.domain) : volume, stated_.scene.target,
                                    fraction);
  }

  /// What stages are asked about a periodic box, as the plan has it, of these edges.
  void describe_box(Task& task, const Vector<dynamic>& edges) {
    const Box& box = std::get<Box>(plan_.domain);
    task.domain = Box{box.corner / frame_.scale, edges, box.periodic, scaled(box.tilt, 1 / frame_.scale)};
    if (box.has_walls()) {
      task.walls = box.periodic;
      task.walls.flip();
    }
    if (any_in_bed_) task.container = counted(make_container(task.domain, scene_.walls, frame_.resolution));
    if (any_in_bed_ || !plan_.box_follows) task.target_edges = edges;
  }

  /// An empty bed, or all spheres of the sequence in a box of these proportions, without places. Where the
  /// scene asks for a packing fraction the task then says with which edges the box is to end.
  SpheresOfRun begin(Task& task, std::shared_ptr<Supply> supply, const Vector<dynamic>& edges) {
    if (table_of(scene_.stages.front()).traits.stands_in_bed(scene_))
      return SpheresInBed(task, std::move(supply), record_.effects());
    SpheresInBox in_box{.task = task,
                        .supply = std::move(supply),
                        .spheres = Spheres<dynamic>(dimension_of(plan_.domain)),
                        .edges = edges};
    in_box.begin_with(in_box.supply->wanted());
    if (const std::optional<double> phi = scene_.target.packing_fraction; phi && plan_.box_follows)
      task.target_edges = edges_filled_to(*phi, in_box);
    return in_box;
  }

  /// Edges of the box's proportions that the spheres fill to what the scene asks for.
  Vector<dynamic> edges_filled_to(double phi, const SpheresInBox& in_box) const {
    const double dimension = in_box.dimension();
    const Vector<dynamic>& edges = in_box.edges;
    const double volume = in_box.volume_of_spheres() / phi;
    if (!with_room_) return edges * std::pow(volume / edges.prod(), 1.0 / dimension);
    const double drawn = in_box.volume_of_spheres() * share_of_drawn(*in_box.supply, in_box.dimension());
    const Vector<dynamic> around = edges_around(scene_, edges * frame_.scale) / frame_.scale;
    const double stated = drawn / *stated_.scene.target.packing_fraction;
    return edges_within(scene_, frame_.scale * around * std::pow(stated / around.prod(), 1.0 / dimension)) /
           frame_.scale;
  }

  /// Where it is left open how many spheres a box of given size takes, and the stages put all in their places
  /// or none: what to try next, unless the last try will do.
  std::optional<double> other_fraction(const SpheresOfRun& spheres, StageEnd end, int attempt) const {
    if (any_in_bed_ || !scene_.target.is_open() || plan_.box_follows || end == StageEnd::cancelled) return {};
    const auto& in_box = std::get<SpheresInBox>(spheres);
    const bool fits = in_box.edges == *in_box.task.target_edges;
    const bool roomy =
        attempt == 1 && fits && in_box.needed_volume < (1 - too_much_room) * in_box.edges.prod();
    if ((fits && !roomy) || attempt == most_attempts) return {};
    return in_box.volume_of_spheres() / in_box.needed_volume * (1 - std::ldexp(caution, attempt - 1));
  }

  /// Back into the scene's unit and place, in the order of the drawn sequence.
  void hand_over(SpheresOfRun& in_frame) {
    const Supply& supply = *supply_of(in_frame);
    auto* in_box = std::get_if<SpheresInBox>(&in_frame);
    packing_.spheres = in_box ? std::move(in_box->spheres) : bed_of(in_frame)->spheres_as_packed();
    Spheres<dynamic>& spheres = packing_.spheres;
    for (int k = 0; k < spheres.dimension(); ++k) {
      const double origin = k < 3 ? frame_.origin[k] : 0;
      for (double& x : spheres.x[static_cast<std::size_t>(k)]) x = origin + frame_.scale * x;
    }
    packing_.size_scale = with_room_
                              ? take_coats_off(spheres.r, in_box ? in_box->tags : bed_of(in_frame)->tags(),
                                               supply, coat_of(scene_) / frame_.scale)
                              : supply.scale();
    for (double& r : spheres.r) r *= frame_.scale;
    if (with_room_) shift(spheres);
    if (!in_box) {
      wrap(spheres, packing_.domain);
    } else {
      const bool as_stated = !plan_.box_follows && in_box->edges == *in_box->task.target_edges;
      Vector<dynamic> edges = in_box->edges * frame_.scale;
      if (with_room_)
        edges = as_stated ? Vector<dynamic>(std::get<Box>(stated_.domain).size) : edges_around(scene_, edges);
      packing_.domain =
          periodic_box(edges, in_box->task.walls, scaled(in_box->task.tilt(in_box->edges), frame_.scale));
      packing_.volume = volume_of(packing_.domain);
    }
    state_edges();
    record_.conclude();
  }

  /// Along axes at whose end there are walls, what is between these begins at zero for the stages.
  void shift(Spheres<dynamic>& spheres) const {
    if (const auto* box = std::get_if<PeriodicBox>(&scene_.container))
      for (const int k : box->walls)
        for (double& x : spheres.x[static_cast<std::size_t>(k)]) x += shift_of(scene_);
  }

  /// Of a periodic box, in the scene that the packing is of.
  void state_edges() {
    if (!scene_.is_periodic()) return;
    const auto& [corner, edges, periodic, tilt] = std::get<Box>(packing_.domain);
    auto& stated = std::get<PeriodicBox>(packing_.scene.container);
    stated.size.assign(edges.begin(), edges.end());
    std::ranges::copy_n(tilt.begin(), std::ssize(stated.tilt), stated.tilt.begin());
    stated.edge.reset();
  }

  void tell(const StageProgress& progress) {
    const double fraction = share_ * progress.packing_fraction;
    if (progress.for_history)
      packing_.history.push_back(
          {std::string(progress.stage), progress.spheres, fraction,
           progress.potential ? frame_.scale * *progress.potential + frame_.origin[scene_.dimension() - 1]
                              : 0,
           progress.max_overlap, record_.seconds()});
    const double expected = stated_.expected_packing_fraction;
    const double share = expected > 0 ? std::min(fraction / expected, 0.99) : 0;
    const std::string overlap = progress.max_overlap > 0
                                    ? fmt::format(", largest overlap {:.1e}", progress.max_overlap)
                                    : std::string();
    monitor_.report(
        {progress.stage, progress.done.value_or(share),
         in_dimension(scene_.dimension(), fmt::format("{} spheres, packing fraction {:.4f}{}",
                                                      grouped(progress.spheres), fraction, overlap))});
  }

  const Plan& stated_;
  const std::optional<Plan> with_room_;
  const Plan& plan_;
  const Scene& scene_;
  const Monitor& monitor_;
  const std::filesystem::path& engine_folder_;
  Packing& packing_;
  const std::vector<Vector<3>> few_places_;
  const bool any_in_bed_;
  RunRecord record_;
  Reporter* report_ = nullptr;            // while stages act
  std::optional<Pressing> pressed_ = {};  // the spheres, last, by a stage that settles
  Frame frame_;
  double share_ = 1;  // of packing fractions, that is left without coats
  ExactPlace exact_place_;
  Checkpoints checkpoints_;
};

}  // namespace

Packing run(const Plan& plan, const RunOptions& options) {
  if (plan.scene.engine && plan.scene.engine->process().slabs > 1)
    throw Error(ErrorCode::bad_scene,
                "spheres in \"slabs\" are packed into files, by bernal pack, and nobody holds them; leave "
                "\"slabs\" out to have them all",
                plan.scene.engine->locations.of("slabs"));
  if (!plan.insides.empty()) return run_with_insides(plan, options);
  return run_spheres(plan, options);
}

Packing run_spheres(const Plan& plan, const RunOptions& options, std::vector<Vector<3>> few_places) {
  if (plan.scene.largest) return run_largest(plan, options);
  if (!plan.parts.empty()) return run_zones(plan, options);
  if (plan.scene.cells) return run_cells(plan, options);
  Packing packing = begin_packing(plan, options.seed, options.threads);
  packing.domain = plan.domain;
  packing.container = plan.container;
  packing.volume = volume_of(plan.domain);
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(std::max(1, packing.threads)));
  Run(plan, options, packing, std::move(few_places)).go();
  packing.classes = classes_by_size(packing);
  return packing;
}

void check_start(const Plan& plan) {
  if (plan.start.spheres.empty()) return;
  Packing packing = begin_packing(plan, {}, 0);
  packing.domain = plan.domain;
  packing.container = plan.container;
  const RunOptions options;
  Run(plan, options, packing).check();
}

void remove_checkpoints(const std::filesystem::path& folder) { CheckpointFolder::remove_from(folder); }

}  // namespace bernal
