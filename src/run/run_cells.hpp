#pragma once
#include "bernal/run/run.hpp"

namespace bernal {

/// The run of a scene that asks for volumes of cells, see `Scene::cells`. Spheres that fill their cells alike
/// are packed; then again, at most `CellSizes::rounds` times, with the mean radii of spheres of a size
/// changed by the cube root of what their own cells, of the weights r², lack, as long as these come nearer to
/// what is wanted. Of the packing whose cells are nearest the volumes are dealt out by rank, the k-th to the
/// sphere with the k-th cell, and the weights found for which the cells have them. The spheres stay where and
/// as they are: so they are certified as always, and the weights are as near to r² as the volumes let them
/// be.
///
/// Precondition: the plan is one of `build`. Cost: the runs, and see `weights_for_volumes`.
Packing run_cells(const Plan& plan, const RunOptions& options);

}  // namespace bernal
