#pragma once

namespace bernal {

/// Random sequential insertion: spheres come one after the other, each at a uniformly random place where it
/// overlaps nothing (Han, Feng & Owen 2005, section 2: the initial packing).
struct Insert {
  int attempts = 100;              ///< random places tried for a sphere before it has to wait
  double packing_fraction = 0.30;  ///< stop here; random insertion gets slow beyond
};

}  // namespace bernal
