#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "work/effect_log.hpp"
#include "work/fill_task.hpp"
#include "work/stage_end.hpp"

namespace bernal {

/// What the stages of one run in a periodic box share. All spheres are there from the start; stages give them
/// their places. Lengths are in the packer's unit: the scene's divided by a power of two, so that the largest
/// radius lies in [1, 2).
struct PeriodicWork {
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
  /// Volume of the box that the spheres needed, before it grew to the one that was asked for.
  double needed_volume = 0;
  /// Largest overlap ratio that the result may keep; 0 for none.
  double allowed_overlap = 0;

  const std::uint64_t seed;
  const Monitor& monitor;
  EffectLog& effects;
  /// For the run's history and the progress bar; called at most some hundred times a stage. `fraction` is how
  /// far the stage has come, in [0, 1].
  std::function<void(std::string_view stage, double fraction, double max_overlap)> milestone = {};
  std::uint64_t streams_used = 0;

  /// A fresh stream of random numbers for one round of a stage.
  Random random(Stream purpose) { return {seed, stream(purpose, streams_used++)}; }
  int dimension() const { return spheres.dimension(); }
  double volume_of_spheres() const {
    double sum = 0;
    for (const double r : spheres.r) sum += ball_volume(dimension(), r);
    return sum;
  }
  bool has_wall(int axis) const { return !walls.empty() && walls[static_cast<std::size_t>(axis)]; }
};

}  // namespace bernal
