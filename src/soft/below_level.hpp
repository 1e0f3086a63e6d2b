#pragma once
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"

namespace bernal {

/// The part of a container below a level: what the walls and a plane across `down` enclose. `volume` is its
/// own. The plane is decided in doubles; all questions else are passed on.
std::shared_ptr<const Container> below_level(std::shared_ptr<const Container>, const Vector<3>& down,
                                             double level, double volume);

/// How high a container reaches against `down`, and how much of it lies below: by 32,768 evenly distributed
/// points inside. Error: some thousandths. Cost: a question to the walls a point, once.
class Heights {
 public:
  Heights(const Container&, const Vector<3>& down);

  /// Below a level that is so high above the lowest point; at most that of the container.
  double volume_below(double height_above_ground) const;
  /// Up to which the container holds that volume. Precondition: volume > 0.
  double level_holding(double volume) const;
  /// Of the part below the level whose mean height is that: of a bed with a level top that is as dense
  /// everywhere, and whose spheres have that mean height, weighted by their volumes.
  double volume_below_mean(double height) const;

 private:
  std::vector<double> heights_;  // ascending
  double volume_;
};

}  // namespace bernal
