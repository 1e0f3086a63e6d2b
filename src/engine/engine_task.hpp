#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::engine {

/// Spheres in classes of similar size, each up to `class_width` times as large as its smallest, so that
/// engines find the neighbours of small ones without looking as far as large ones reach.
struct SizeClasses {
  /// So many at most; the last takes all that is larger.
  static constexpr std::size_t most = 24;

  int count = 1;
  double least = 1;                    ///< radius
  std::array<int, most> numbers = {};  ///< of those that occur, from 0

  int of(double r) const { return numbers[octave(r)]; }
  std::size_t octave(double r) const;
};
inline constexpr double class_width = 1.6;

/// The spheres that an engine is given, told one after the other as often as anybody asks, the same every
/// time: nobody needs to hold them.
struct TaskSpheres {
  using Visit = std::function<void(const Vector<3>& center, double r)>;
  using Tell = std::function<void(const Visit&)>;

  std::uint64_t count = 0;
  double least = 0, largest = 0, mean = 0;  ///< of the radii
  SizeClasses classes = {};
  Tell for_each = {};
};
/// Asks twice. Precondition: there are some.
TaskSpheres told(TaskSpheres::Tell tell);
/// These, which are held.
TaskSpheres told(Spheres<3> spheres);

/// How spheres are poured instead: they fall along gravity, with masses r³, stiffness 1 between them and at
/// walls, Coulomb's friction, and damping by the coefficient of restitution, in steps of a tenth of the time
/// that the smallest are in contact, until the mean kinetic energy is a ten-millionth of what a fall by a
/// mean diameter gives. Gravity is such that the weight of the bed presses those at the bottom together by a
/// five-thousandth of the mean radius.
struct Pouring {
  Vector<3> down;  ///< unit vector
  double friction, restitution;
  double layers;  ///< of the bed, about, in mean diameters
  double fall;    ///< the longest, in mean diameters

  double gravity(const TaskSpheres&) const;
  double time_step(const TaskSpheres&) const;
  /// Steps of the longest fall; after that it is asked whether they rest.
  int steps_of_fall(const TaskSpheres&) const;
};

/// What an engine does: spheres that overlap push each other apart, and are pushed by walls, until they lie
/// as soft particles do.
///
/// Motion: m x'' = sum of d n, over contacts of depth d and normal n, with stiffness 1; a damping of m_eff
/// v_n at contacts; steps of 0.3, none of which moves a sphere by more than a tenth of the mean diameter.
/// Masses are max(1, (r / mean r)²), so that those with many contacts do not swing; walls have a stiffness
/// of 4. So nothing depends on the unit of lengths. Measured on 10,000 equal spheres in a periodic box, that
/// grows from a packing fraction of 0.70 to 0.64 in 400 of 1,000 steps: overlap ratios of 1e-3 are left.
struct EngineTask {
  /// Lengths such that the mean radius is about 1; centres in the box, or in the container.
  TaskSpheres spheres = {};
  /// A box with its lower corner at the origin where it repeats itself along all axes; a container of any
  /// other kind; a cylinder along a coordinate axis.
  Domain domain = {};
  /// The edges of a box without walls become so many times as long.
  double growth = 1;
  int steps = 1000;
  bool tells_radii = false;  ///< the result has them beside the places
  std::optional<Pouring> pouring = {};

  /// Of steps: fixed, while the box grows, fixed again.
  int steps_before() const { return growth == 1 ? steps : 2 * steps / 5; }
  int steps_of_growth() const { return growth == 1 ? 0 : 2 * steps / 5; }
  int steps_after() const { return steps - steps_before() - steps_of_growth(); }
  double mass(double r) const;
};

/// The region that the engine's box covers: bounds of the domain, with room beyond walls, so that a sphere
/// that has slipped through one is not lost.
Bounds<3> region_of(const EngineTask& task);

}  // namespace bernal::engine
