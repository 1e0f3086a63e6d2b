#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/boundary.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/tolerance.hpp"
#include "near/cell_grid.hpp"
#include "plan/stages.hpp"
#include "plan/start.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// Of the skin, the gap that a sphere in the bed needs: half, which stages leave and rely on, less the
/// rounding of centres on their way to the packer's frame, which is a thousandth.
constexpr double least_gap = 0.49;

/// The pair of a start that overlaps most, by the ratio of overlap to the sum of radii.
struct WorstPair {
  std::size_t i = 0, j = 0;
  double ratio = -1;

  void look_at(std::size_t a, std::size_t b, double distance, double sum) {
    const double here = 1 - distance / sum;
    if (here <= ratio) return;
    i = std::min(a, b);
    j = std::max(a, b);
    ratio = here;
  }
};

[[noreturn]] void refuse(const StartSpheres& start, std::size_t i, const std::string& why) {
  throw Error(ErrorCode::bad_packing, why, {start.file, start.first_line + static_cast<int>(i)});
}

/// What frees spheres of their overlap.
constexpr std::string_view relax_frees = "begin with \"relax\", which pushes spheres apart and inside";

[[noreturn]] void refuse_overlap(const StartSpheres& start, const WorstPair& worst, std::string_view stage,
                                 double gap) {
  const std::string how =
      worst.ratio > 0
          ? fmt::format("overlaps that of line {} by a ratio of {:.3g}",
                        start.first_line + static_cast<int>(worst.i), worst.ratio)
          : fmt::format("touches that of line {} to rounding", start.first_line + static_cast<int>(worst.i));
  if (gap > 0) {
    refuse(
        start, worst.j,
        fmt::format("this sphere is nearer to that of line {} than the gap of {:g}, and no pair may be for "
                    "\"{}\": {}",
                    start.first_line + static_cast<int>(worst.i), gap, stage, relax_frees));
  }
  refuse(start, worst.j,
         fmt::format("this sphere {}, and no pair may for \"{}\": {}", how, stage, relax_frees));
}

template <int D>
void take_start_in_box(const Plan& plan, double scale, SpheresInBox& in_box) {
  const Task& task = in_box.task;
  const StartSpheres& start = plan.start;
  const std::size_t n = start.spheres.size();
  in_box.edges = start.edges / scale;
  for (int k = 0; k < D; ++k) {
    const double edge = in_box.edges[k];
    for (std::size_t i = 0; i < n; ++i) {
      double x = start.spheres.x[static_cast<std::size_t>(k)][i] / scale;
      if (task.has_wall(k)) {
        if (!(x > 0 && x < edge))
          refuse(start, i, fmt::format("this sphere does not lie between the walls along axis {}", k));
      } else {
        Boundary<1> axis{Vector<1>::Constant(edge)};
        x = axis.wrap(Vector<1>::Constant(x))[0];
      }
      in_box.spheres.x[static_cast<std::size_t>(k)][i] = x;
    }
  }
  const bool tilted = is_tilted(task.domain);
  if (tilted) {
    const TiltedBoundary<D> cell(in_box.edges, task.tilt(in_box.edges));
    for (std::size_t i = 0; i < n; ++i)
      in_box.spheres.set_center(i, cell.wrap(Vector<D>(start.spheres.center(i) / scale)));
  }
  in_box.begun = n;
  in_box.placed = n == in_box.spheres.size();
  if (task.target_edges && !plan.box_follows) {
    Spheres<D> moved = in_box.spheres.in<D>();
    Vector<D> edges = in_box.edges;
    if (edges != *task.target_edges) resize_box<D>(moved, edges, *task.target_edges, tilted);
    in_box.spheres = std::move(moved);
    in_box.edges = edges;
  }

  const Stage& first = plan.scene.stages.front();
  const bool frees_overlap = table_of(first).traits.frees_box;
  if (tilted) {  // where all stages free spheres of overlap
    in_box.may_overlap = true;
    return;
  }
  Spheres<D> there = in_box.spheres.in<D>();
  there.resize(n);
  for (int k = 0; k < D; ++k)
    for (std::size_t i = 0; i < n && task.has_wall(k); ++i) {
      const double x = there.x[static_cast<std::size_t>(k)][i], r = there.r[i];
      if (x >= r && in_box.edges[k] - x >= r) continue;
      in_box.may_overlap = true;
      if (!frees_overlap)
        refuse(start, i,
               fmt::format("this sphere {} a wall along axis {}; begin with \"relax\"",
                           plan.scene.wall_gap > 0 ? "is nearer than the gap to" : "crosses", k));
    }
  const Vector<D> edges = edges_around_walls<D>(in_box.edges, task.walls);
  const Boundary<D> boundary{edges};
  // Half of what a box is grown by beyond contact is more than its rounding.
  const double rounding = 0.5 * tolerance::growth(edges.maxCoeff() / std::ranges::min(there.r));
  WorstPair worst;
  for (const auto& [i, j] : overlapping<D>(there, edges, task.allowed_overlap)) {
    const double distance = boundary.minimum_image(there.center(i) - there.center(j)).norm();
    const double sum = there.r[i] + there.r[j];
    if (distance < (1 - task.allowed_overlap) * (1 + rounding) * sum) worst.look_at(i, j, distance, sum);
  }
  if (!(worst.ratio > -1)) return;
  in_box.may_overlap = true;
  if (!frees_overlap) refuse_overlap(start, worst, first.name(), plan.scene.gap);
}

/// Those that are clear of the others, and of the walls, stand in the bed from now on.
void take_start_in_bed(const Plan& plan, const Frame& frame, SpheresInBed& in_bed) {
  const StartSpheres& start = plan.start;
  const Stage& first = plan.scene.stages.front();
  const bool frees_overlap = table_of(first).traits.frees_bed;
  Bed& bed = in_bed.bed();
  const Container& container = bed.container();
  const double gap = least_gap * bed.skin();
  const std::size_t n = start.spheres.size();
  Spheres<3> spheres;
  CellGrid<3> grid(container.bounds(), container.boundary(), in_bed.supply->smallest(),
                   in_bed.supply->largest(), n);
  WorstPair worst;
  std::vector<bool> stands(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    const double r = in_bed.supply->radius(static_cast<std::uint32_t>(i));
    Vector<3> c = container.boundary().wrap(frame.to_local(place_in_bed(start.spheres.center(i))));
    if (!container.contains(c, 0))
      refuse(start, i, "this sphere lies outside of the container; check the unit, \"start_unit\" says it");
    stands[i] = container.contains(c, r + gap);
    if (!stands[i]) {
      const std::optional<Vector<3>> touching = in_bed.task.exact_place(c, r);
      stands[i] = touching.has_value();
      if (touching) c = *touching;
      if (!touching && !frees_overlap)
        refuse(start, i,
               plan.scene.wall_gap > 0
                   ? fmt::format("this sphere is nearer to the wall than the gap of {:g}: {}",
                                 plan.scene.wall_gap, relax_frees)
                   : fmt::format("this sphere protrudes from the container by {:.3g} of its radius: {}",
                                 1 - container.clearance(c) / r, relax_frees));
    }
    grid.for_each_near(c, r + gap, [&](std::uint32_t j) {
      const double distance = container.boundary().minimum_image(c - spheres.center(j)).norm();
      const double sum = r + spheres.r[j];
      if (distance >= sum + gap) return;
      worst.look_at(i, j, distance, sum);
      if (stands[j]) stands[i] = false;
    });
    grid.insert(static_cast<std::uint32_t>(i), c, r);
    spheres.push_back(c, r);
    if (stands[i]) bed.insert(c, r, static_cast<std::uint32_t>(i));
  }
  if (worst.ratio > -1 && !frees_overlap) refuse_overlap(start, worst, first.name(), plan.scene.gap);
  in_bed.supply->set_placed(stands);
  in_bed.begun = n;
  if (bed.size() < n) in_bed.crowded_start = std::move(spheres);
}

}  // namespace

void take_start(const Plan& plan, const Frame& frame, SpheresOfRun& spheres, Reporter& report) {
  if (plan.start.spheres.empty()) return;
  const EffectTimer timer(report.effects["start"]);
  if (auto* in_bed = std::get_if<SpheresInBed>(&spheres)) return take_start_in_bed(plan, frame, *in_bed);
  auto& in_box = std::get<SpheresInBox>(spheres);
  with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    take_start_in_box<decltype(dimension)::value>(plan, frame.scale, in_box);
  });
  const Stage& first = plan.scene.stages.front();
  if (!in_box.placed && !table_of(first).traits.joins_start)
    throw Error(ErrorCode::bad_scene,
                fmt::format("\"{}\" finds no places for {} spheres among the {} of the start: begin with "
                            "\"relax\", or draw no others",
                            first.name(), in_box.spheres.size() - in_box.begun, in_box.begun),
                first.locations.whole);
}

}  // namespace bernal
