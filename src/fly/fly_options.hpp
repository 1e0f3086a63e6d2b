#pragma once

namespace bernal {

struct FlyOptions {
  /// New spheres that are tried between two steps; 0: as many as suit the procedure.
  int batch = 0;
  /// How far a sphere of the mean radius flies between two batches, in mean diameters.
  double dt = 0.01;
  /// The box is full when so many places in a row were tried in vain, for each sphere that is wanted.
  double patience = 1000;
  /// Of all spheres, after which methods that relax stop.
  double sweeps = 20000;
};

}  // namespace bernal
