#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "measure/power_cells.hpp"

namespace bernal {

/// What finding weights of cells is called among effects.
inline constexpr const char* cells_effect = "cells";

/// All cells of a power diagram as functions of the weights.
struct WeightedCells {
  /// By how much the volume of a cell grows with its own weight, and that of `neighbour` shrinks: the area of
  /// the face between them over twice the distance of the centres.
  struct Slope {
    std::uint32_t neighbour;
    double slope;
  };
  std::vector<double> volumes, surfaces;
  /// Of each cell, over its faces with other spheres; a neighbour stands there once for each of its images.
  std::vector<std::vector<Slope>> slopes;
};

/// Precondition: three dimensions, and one weight a sphere. Cost: as `for_each_power_cell`.
WeightedCells weighted_cells(const Spheres<3>& spheres, const CellBox& box, std::span<const double> weights);

}  // namespace bernal
