#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/vector.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/plan/plan.hpp"

namespace bernal {

/// Roundings of a place in a container at which a sphere certainly stands.
class ExactPlace {
 public:
  /// Both outlive this. Places are those of the frame.
  ExactPlace(const Plan& plan, const Frame& frame) : plan_(plan), frame_(frame) {}

  /// The place as it is and with what is nearly in the middle there, each coordinate a few doubles up or down
  /// in the scene's unit: the first at which that unit's walls, exactly, leave the sphere room. Of a solid of
  /// revolution about a coordinate axis then places as far from that axis, in the four half planes through it
  /// along the other two: only there are distances from it doubles.
  std::optional<Vector<3>> near(const Vector<3>& place, double r);

 private:
  /// What is nearly at a place, as a length in the scene's unit.
  double nearly() const;
  std::optional<Vector<3>> rounded_near(const Vector<3>& at, double r) const;
  /// The nearest first; in the middle between two upright walls where the place nearly is.
  std::vector<Vector<3>> in_half_planes(const Vector<3>& at) const;

  const Plan& plan_;
  const Frame& frame_;
  std::unique_ptr<Container> of_scene_;  // made when it is needed
};

}  // namespace bernal
