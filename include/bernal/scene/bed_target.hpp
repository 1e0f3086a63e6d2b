#pragma once
#include <optional>

namespace bernal {

/// A bed under gravity as a scene asks for it. What is left out is as it comes.
struct BedTarget {
  /// How densely: settled without friction; as beds that were vibrated are; as ones that friction holds
  /// loose.
  enum class Density { poured, vibrated, loose };
  /// Its surface: as it comes; no sphere above a level; no sphere above a cone whose axis runs through the
  /// middle of the container.
  enum class Top { free, level, heap };

  std::optional<Density> density = {};
  std::optional<Top> top = {};
  std::optional<double> heap_angle = {};  ///< of the cone with the level, in degrees
  /// Share of the bed's volume, up to its surface, that is left free, in place of the density's. Where there
  /// is no bed, in periodic boxes without a floor, for discs and for stages that make none, `complete` makes
  /// it the target's packing fraction.
  std::optional<double> porosity = {};
  /// Of its surface above the lowest point of the container, in place of a count; or that in mean diameters.
  std::optional<double> height = {}, layers = {};

  /// The height that either of these means, in the scene's unit: by `build`; 0 where none is given.
  double above_ground = 0;

  /// The largest angle of friction for loose beds, in degrees: a coefficient of 1.
  static constexpr double most_friction = 45;
  /// The angle up to which friction may hold the spheres, in degrees: above 0 only for beds that are to be
  /// loose, or as porous as may need it.
  double friction() const { return porosity || density == Density::loose ? most_friction : 0; }

  bool gives_height() const { return height || layers; }
  /// Whether the scene asks for a bed at all.
  bool is_asked() const { return density || top || porosity || gives_height(); }
  /// Whether it is to be denser or looser than settling leaves it.
  bool asks_for_density() const { return porosity || (density && *density != Density::poured); }
  bool operator==(const BedTarget&) const = default;
};

}  // namespace bernal
