#include "bernal/slabs/pack_in_slabs.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/engine/engine_error.hpp"
#include "core/parallel.hpp"
#include "engine/engine_plan.hpp"
#include "engine/run_engine.hpp"
#include "files/staged_folder.hpp"
#include "plan/shortfall.hpp"
#include "run/begin_packing.hpp"
#include "run/engine_box.hpp"
#include "slabs/drawn_spheres.hpp"
#include "slabs/slab_relaxation.hpp"
#include "slabs/write_slabs.hpp"
#include "soft/growing_box.hpp"
#include "soft/relax.hpp"

namespace bernal {
namespace {

/// Growths of the box until it is given up: an engine's result takes some tens.
constexpr int most_growths = 400;
/// Of a sphere: in a slab and in the result, and about those of the texts that the engine reads and writes.
constexpr std::uint64_t bytes_on_disk = 2 * 32 + 180;

int longest_axis(const Vector<3>& edges) {
  int axis = 0;
  edges.maxCoeff(&axis);
  return axis;
}

/// One run. Lengths are in the engine's unit.
class SlabRun {
 public:
  SlabRun(const Plan& plan, const std::filesystem::path& folder, const SlabOptions& options,
          PackedInSlabs& result)
      : plan_(plan),
        scene_(plan.scene),
        monitor_(options.monitor),
        engine_folder_(options.engine_folder),
        folder_(folder),
        result_(result),
        drawn_{plan, result.packing.seed, static_cast<std::uint64_t>(*plan.scene.target.count)},
        sizes_(drawn_.sizes()),
        unit_(unit_of_engine(sizes_.mean)),
        proportions_(bounds_of<dynamic>(plan.domain).size()),
        scale_(engine_box(proportions_, sizes_.volume, sizes_.largest, plan.attainable_packing_fraction)) {
    require_wide_box();
  }

  void go() {
    StagedFolder staged(folder_);
    staged.require_room(bytes_on_disk * drawn_.count);
    SlabStore store(staged.written("slabs"), scene_.engine->process().slabs, longest_axis(proportions_));
    let_engine_work(store);
    const Vector<3> edges = relax(store);
    result_.packing.seconds = watch_.seconds();
    monitor_.report({"write", 0, "slab by slab"});
    const Vector<dynamic> stated = edges * unit_;
    result_.packing.domain = periodic_box(stated);
    result_.packing.volume = volume_of(result_.packing.domain);
    write_slabs(store, edges, unit_, plan_, folder_, staged, monitor_, result_, [this] { conclude(); });
  }

 private:
  void require_wide_box() const {
    const int slabs = scene_.engine->process().slabs;
    const Vector<3> edges = scale_.last * proportions_ / sizes_.largest;
    const int axis = longest_axis(proportions_);
    const auto most = static_cast<int>(std::min(1e6, edges[axis] / SlabPacking::thinnest_slab));
    const Location where = scene_.engine->locations.of("slabs");
    if (edges.minCoeff() < SlabPacking::narrowest_box)
      throw Error(
          ErrorCode::bad_scene,
          fmt::format("the box is {:.3g} of the largest radius wide, and slabs take one of at least {:g}; "
                      "leave \"slabs\" out, so few spheres need none",
                      edges.minCoeff(), SlabPacking::narrowest_box),
          where);
    if (slabs <= most) return;
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the box is {:.3g} of the largest radius long, and each of {} slabs takes {:g}; {}",
                    edges[axis], slabs, SlabPacking::thinnest_slab,
                    most > 1 ? fmt::format("give at most {}", most) : "leave \"slabs\" out"),
        where);
  }

  void let_engine_work(SlabStore& store) {
    Stopwatch watch;
    const Vector<3> edges = proportions_ * (scale_.first / unit_);
    const engine::EngineTask task{.spheres = engine::told(drawn_.in_box(edges, unit_)),
                                  .domain = Box{Vector<3>::Zero().eval(), edges, {true, true, true}},
                                  .growth = scale_.last / scale_.first,
                                  .steps = scene_.engine->process().steps,
                                  .tells_radii = true};
    engine::run_engine(*scene_.engine, task, engine_folder_, monitor_,
                       [&](const std::filesystem::path& dump) { sort_into(store, dump); });
    result_.packing.effects.push_back({std::string(engine::engine_effect), 1, watch.seconds()});
    add_milestone(std::holds_alternative<Lammps>(*scene_.engine) ? "lammps" : "liggghts",
                  scale_.last * proportions_ / unit_, 0);
  }

  void sort_into(SlabStore& store, const std::filesystem::path& dump) const {
    RadiiByNumber given, there;
    std::uint64_t number = 0;
    drawn_.for_each_radius(unit_, [&](double r) { given.add(number++, r); });
    store.clear();
    engine::read_places(dump, drawn_.count, true,
                        [&](const Bounds<3>& box, const engine::PlacedByEngine& sphere) {
                          if (sphere.number % (1 << 16) == 0) throw_if_interrupted();
                          there.add(sphere.number, sphere.r);
                          SlabSphere placed{.at = {}, .r = sphere.r};
                          for (int k = 0; k < 3; ++k) {
                            double at = (sphere.center[k] - box.lower[k]) / (box.upper[k] - box.lower[k]);
                            at -= std::floor(at);
                            placed.at[static_cast<std::size_t>(k)] = at < 1 ? at : 0;
                          }
                          store.add(placed);
                        });
    store.close();
    if (!(given == there))
      throw EngineError("the engine's result has other radii than it was given", {dump.string()});
  }

  /// The edges of the box in which nothing overlaps.
  Vector<3> relax(SlabStore& store) {
    Stopwatch watch;
    const Relax& options = *scene_.stages.front().as<Relax>();
    const GrowingBox box{
        .stop = least_overlap(options, scene_.overlap),
        .sweeps = sweeps_a_cycle(options, std::min<std::size_t>(drawn_.count, enough_for_sweeps)),
        .beta = options.beta};
    BoxGrowth growth;
    const auto look = [&] {
      if (monitor_.stop()) throw Cancelled();
      tell_of(box, growth);
    };
    SlabPacking packing(store, proportions_ * (scale_.last / unit_), sizes_.largest / unit_,
                        sizes_.mean / unit_, look);
    const auto at_limit = [&] { return growth.cycle > most_growths; };
    const StageEnd end = grow_apart<3>(
        packing, box, growth, at_limit, [](int, double molr) { return molr; },
        [&](double, double molr) { add_milestone("relax", packing.edges(), molr); });
    is_relaxed_ = end == StageEnd::converged;
    const double touching = contact_factor_of(store, packing.edges(), sizes_.largest / unit_, look);
    if (!std::isfinite(touching))
      throw Error(ErrorCode::bad_packing,
                  "two spheres have one centre when the relaxation has reached its limit; "
                  "give the engine more \"steps\" or another \"seed\"");
    result_.packing.effects.push_back({"relaxation", 1, watch.seconds()});
    result_.packing.effects.push_back(packing.lists_built());
    // As `edges_free_of_overlap`; centres are rounded once more in their slabs.
    const double factor = std::clamp(1.0, touching * (1 - scene_.overlap), touching);
    const Vector<3> edges = packing.edges() * factor;
    return edges * (1 + 2 * tolerance::growth(edges.maxCoeff() / (sizes_.least / unit_)));
  }

  void tell_of(const GrowingBox& box, const BoxGrowth& growth) const {
    const double done = std::clamp(std::log(growth.molr) / std::log(box.stop), 0.0, 0.99);
    monitor_.report({"relax", done,
                     fmt::format("{} spheres in {} slabs, largest overlap {:.1e}", grouped(drawn_.count),
                                 scene_.engine->process().slabs, growth.molr)});
  }

  void add_milestone(std::string_view stage, const Vector<3>& edges, double molr) {
    const double volume = sizes_.volume / (unit_ * unit_ * unit_);
    result_.packing.history.push_back(
        {std::string(stage), drawn_.count, volume / edges.prod(), 0, molr, watch_.seconds()});
  }

  /// Once the packing fraction is known.
  void conclude() {
    Packing& packing = result_.packing;
    const double phi = result_.packing_fraction, expected = plan_.attainable_packing_fraction;
    packing.outcome = !is_relaxed_ ? Outcome::hit_limit : Outcome::converged;
    packing.reason = is_relaxed_
                         ? fmt::format("all {} spheres are placed, in {} slabs", grouped(drawn_.count),
                                       scene_.engine->process().slabs)
                         : fmt::format("the last stage reached its limit of {} growths with {} spheres",
                                       most_growths, grouped(drawn_.count));
    if (!is_relaxed_ || !is_loose(expected - phi, expected, drawn_.count)) return;
    packing.outcome = Outcome::loose;
    packing.reason += fmt::format(
        "; the packing fraction, {:.4f}, is {:.3f} below the {:.3f} to be expected of "
        "these sizes: more \"steps\" of the engine make it denser",
        phi, expected - phi, expected);
  }

  const Plan& plan_;
  const Scene& scene_;
  const Monitor& monitor_;
  const std::filesystem::path engine_folder_, folder_;
  PackedInSlabs& result_;
  const Stopwatch watch_;
  const DrawnSpheres drawn_;
  const DrawnSpheres::Sizes sizes_;  // in the scene's unit
  const double unit_;
  const Vector<3> proportions_;
  const EngineBox scale_;
  bool is_relaxed_ = false;
};

}  // namespace

bool is_in_slabs(const Scene& scene) { return scene.engine && scene.engine->process().slabs > 1; }

void check_slabs(const Plan& plan) {
  PackedInSlabs none;
  none.packing.seed = plan.scene.seed;
  SlabRun(plan, {}, {}, none);
}

PackedInSlabs pack_in_slabs(const Plan& plan, const std::filesystem::path& folder,
                            const SlabOptions& options) {
  PackedInSlabs result{.packing = begin_packing(plan, options.seed, options.threads)};
  Packing& packing = result.packing;
  packing.spheres = Spheres<dynamic>(3);
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(std::max(1, packing.threads)));
  const Interruptible listening(options.monitor);
  SlabRun(plan, folder, options, result).go();
  return result;
}

}  // namespace bernal
