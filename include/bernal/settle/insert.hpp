#pragma once
#include <optional>

namespace bernal {

/// The arrangement of the initial packing: "The spheres can be randomly distributed or regularly positioned"
/// (Han, Feng & Owen 2005, section 2).
enum class Layout {
  random,   ///< each at a uniformly random position
  lattice,  ///< on a face-centred (for discs, hexagonal) lattice, as wide as possible
  // Crystals, along the coordinate axes: each sphere at the next site from the floor up.
  fcc,  ///< face-centred cubic
  bcc,  ///< body-centred cubic
  hcp,  ///< hexagonal close-packed, its layers across the last axis; of discs the hexagonal lattice
  sc,   ///< simple cubic; of discs the square lattice
};

/// The initial packing: spheres come one by one, each to a position where it overlaps nothing.
struct Insert {
  Layout layout = Layout::random;
  /// Of a crystal: the distance of a site from its nearest ones, in the scene's unit; if absent, the largest
  /// spheres touch.
  std::optional<double> spacing = {};
  int attempts = 100;  ///< random positions tried for a sphere before it has to wait
  /// Stop here; random insertion gets slow beyond the 0.3 that it is if absent. Crystals then take all sites.
  std::optional<double> packing_fraction = {};

  bool is_crystal() const { return layout != Layout::random && layout != Layout::lattice; }
  double until() const { return packing_fraction.value_or(is_crystal() ? 1 : 0.30); }
};

}  // namespace bernal
