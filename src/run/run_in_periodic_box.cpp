#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "run/fill_task_of.hpp"
#include "run/run_in_domain.hpp"
#include "run/stages.hpp"
#include "work/periodic_work.hpp"

namespace bernal {
namespace {

/// How often a box of given size that is to be filled is tried with another number of spheres.
constexpr int most_attempts = 6;
/// What the second attempt leaves free of the packing fraction that the first one reached, so that it fits;
/// every further attempt leaves twice as much.
constexpr double caution = 5e-4;
/// A first attempt that leaves more than this of the volume free was too small.
constexpr double too_much_room = 5e-3;
constexpr double most_spheres = 2147483647.0;

/// The drawn sequence of radii, in the packer's unit: `count` of them, or as many as fill `volume`.
std::vector<double> drawn_radii(RadiusSequence sequence, int dimension, std::optional<std::int64_t> count,
                                double volume) {
  std::vector<double> radii;
  double filled = 0;
  while (count ? radii.size() < static_cast<std::size_t>(*count) : filled < volume) {
    radii.push_back(sequence.next());
    filled += ball_volume(dimension, radii.back());
  }
  return radii;
}

/// The power of two that takes the scene's lengths to those of the packer.
double unit_for(const std::vector<double>& radii) {
  return std::exp2(std::floor(std::log2(std::ranges::max(radii))));
}

/// The edges that the scene asks for, if it does, in the packer's unit; `edges` are the plan's.
std::optional<Vector<dynamic>> asked_edges(const Plan& plan, double volume_of_spheres,
                                           const Vector<dynamic>& edges) {
  if (!plan.box_follows) return edges;
  const std::optional<double> phi = plan.scene.target.packing_fraction;
  if (!phi) return std::nullopt;
  return edges * std::pow(volume_of_spheres / *phi / edges.prod(), 1.0 / static_cast<double>(edges.size()));
}

/// What a stage cannot do, only it knows; where the scene asks for it, only the run.
StageEnd run_stage(const Stage& stage, PeriodicWork& work) {
  const StageEntry& entry = entry_of(stage);
  try {
    return entry.run_periodic(entry.table.options(stage), work);
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), error.what(), stage.locations.whole);
  }
}

void conclude(Packing& packing, const PeriodicWork& work, StageEnd end, bool fits, std::size_t wanted) {
  const auto n = grouped(packing.spheres.size());
  const std::string account = work.account.empty() ? "" : " " + work.account;
  if (packing.spheres.size() < wanted) {
    packing.outcome = end == StageEnd::cancelled ? Outcome::cancelled
                      : end == StageEnd::full    ? Outcome::full
                                                 : Outcome::hit_limit;
    packing.reason = fmt::format("{}{} of {} spheres are placed, packing fraction {:.4f}{}",
                                 end == StageEnd::cancelled ? "stopped by the user: " : "", n,
                                 grouped(wanted), packing.packing_fraction(), account);
  } else if (end == StageEnd::cancelled) {
    packing.outcome = Outcome::cancelled;
    packing.reason = fmt::format("stopped by the user with {} spheres", n);
  } else if (!fits) {
    packing.outcome = Outcome::full;
    packing.reason = fmt::format(
        "{} spheres need a box {:.4g} times as large by volume as the one asked for; this is the box that "
        "they need",
        n, work.edges.prod() / work.target_edges->prod());
  } else if (end == StageEnd::hit_limit) {
    packing.outcome = Outcome::hit_limit;
    packing.reason = fmt::format("the last stage reached its limit with {} spheres", n);
  } else {
    packing.outcome = Outcome::converged;
    packing.reason = fmt::format("all {} spheres are placed{}", n, account);
  }
}

}  // namespace

void run_in_periodic_box(const Plan& plan, const Monitor& monitor, const Stopwatch& watch, Packing& packing) {
  const Scene& scene = plan.scene;
  const int dimension = scene.dimension();
  const Target& target = scene.target;
  const Box& box = std::get<Box>(plan.domain);
  std::vector<bool> walls = box.periodic;
  walls.flip();
  if (!box.has_walls()) walls.clear();
  const double asked_volume = volume_of(plan.domain);
  EffectLog effects;

  double fraction = target.packing_fraction.value_or(plan.expected_packing_fraction);
  for (int attempt = 1;; ++attempt) {
    std::vector<double> radii = drawn_radii({*plan.radii, packing.seed, *scene.draw}, dimension, target.count,
                                            fraction * asked_volume);
    if (static_cast<double>(radii.size()) >= most_spheres)
      throw Error(ErrorCode::bad_scene, "the box would hold more than 2^31 spheres of these sizes",
                  target.where);
    const double unit = unit_for(radii);
    double volume_of_spheres = 0;
    for (double& r : radii) {
      r /= unit;
      volume_of_spheres += ball_volume(dimension, r);
    }

    PeriodicWork work{.spheres = Spheres<dynamic>(dimension),
                      .edges = box.size / unit,
                      .walls = walls,
                      .allowed_overlap = scene.overlap,
                      .seed = packing.seed,
                      .monitor = monitor,
                      .effects = effects};
    for (auto& column : work.spheres.x) column.assign(radii.size(), 0);
    work.spheres.r = std::move(radii);
    work.target_edges = asked_edges(plan, volume_of_spheres, work.edges);
    work.fill_task = fill_task_of(plan);
    const std::size_t wanted = work.spheres.size();
    work.milestone = [&](std::string_view stage, double done, double max_overlap) {
      const double phi = work.placed_share * volume_of_spheres / work.edges.prod();
      const std::size_t placed = work.placed_share < 1 ? work.placed_count : work.spheres.size();
      packing.history.push_back({std::string(stage), placed, phi, 0, max_overlap, watch.seconds()});
      monitor.report({stage, done,
                      fmt::format("{} spheres, packing fraction {:.4f}, largest overlap {:.1e}",
                                  grouped(placed), phi, max_overlap)});
    };

    StageEnd end = StageEnd::converged;
    for (const Stage& stage : scene.stages) {
      end = run_stage(stage, work);
      if (end == StageEnd::cancelled) break;
    }

    const bool fits = !work.target_edges || work.edges == *work.target_edges;
    const bool roomy = attempt == 1 && fits && work.needed_volume < (1 - too_much_room) * work.edges.prod();
    if (target.is_open() && (!fits || roomy) && attempt < most_attempts && end != StageEnd::cancelled) {
      fraction = volume_of_spheres / work.needed_volume * (1 - std::ldexp(caution, attempt - 1));
      continue;
    }
    packing.spheres = std::move(work.spheres);
    for (auto& column : packing.spheres.x)
      for (double& x : column) x *= unit;
    for (double& r : packing.spheres.r) r *= unit;
    const Vector<dynamic> edges = work.edges * unit;
    packing.domain = periodic_box(edges, work.walls);
    packing.volume = volume_of(packing.domain);
    auto& stated = std::get<PeriodicBox>(packing.scene.container);
    stated.size.assign(edges.begin(), edges.end());
    stated.edge.reset();
    packing.effects = effects.all();
    conclude(packing, work, end, fits, wanted);
    return;
  }
}

}  // namespace bernal
