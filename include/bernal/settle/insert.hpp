#pragma once

namespace bernal {

/// The arrangement of the initial packing: "The spheres can be randomly distributed or regularly positioned"
/// (Han, Feng & Owen 2005, section 2).
enum class Layout {
  random,   ///< each at a uniformly random position
  lattice,  ///< on a face-centred (for discs, hexagonal) lattice, as wide as possible
};

/// The initial packing: spheres come one by one, each to a position where it overlaps nothing.
struct Insert {
  Layout layout = Layout::random;
  int attempts = 100;              ///< random positions tried for a sphere before it has to wait
  double packing_fraction = 0.30;  ///< stop here; random insertion gets slow beyond
};

}  // namespace bernal
