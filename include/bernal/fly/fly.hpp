#pragma once
#include <optional>

namespace bernal {

/// How a box of given edges is filled with spheres of given radii.
enum class FillMethod {
  automatic,   ///< classes or relaxation, as suits the sizes
  flight,      ///< from event to event, with pushed trial centres
  patent,      ///< the patent's collision filling
  classes,     ///< the largest first, the smaller between them
  relaxation,  ///< all at once, overlapping, pushed apart
};

/// A periodic box of given size is filled with spheres of given radii, which fly and collide ("Modelling of
/// composites filled with hyperspheres in n-dimensional space", Sun, Qian, Shi & Liu 2023).
struct Fly {
  FillMethod method = FillMethod::automatic;
  /// To fill the box to, where the scene's target does not say it.
  std::optional<double> packing_fraction = {};
  int batch = 0;  ///< new spheres that are tried between two steps; 0: as many as suit the procedure
  /// Way between two batches, in mean diameters; without it what suits the procedure.
  std::optional<double> dt = {};
  double patience = 1000;  ///< full when so many places in a row, for each sphere wanted, were not free
  int sweeps = 20000;      ///< of all spheres, after which methods that relax stop
};

}  // namespace bernal
