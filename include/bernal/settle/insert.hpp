#pragma once

namespace bernal {

/// "The spheres can be randomly distributed or regularly positioned" (Han, Feng & Owen 2005, section 2: the
/// initial packing).
enum class Layout {
  random,   ///< each at a uniformly random place
  lattice,  ///< on those of a face-centred lattice, of discs a hexagonal one, as wide as can be
};

/// The initial packing: spheres come one after the other, each to a place where it overlaps nothing.
struct Insert {
  Layout layout = Layout::random;
  int attempts = 100;              ///< random places tried for a sphere before it has to wait
  double packing_fraction = 0.30;  ///< stop here; random insertion gets slow beyond
};

}  // namespace bernal
