#pragma once
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/scene/bed_target.hpp"

namespace bernal {

/// The shape of a bed's surface: a level, or a heap, a pyramid of many flanks around a line along gravity
/// through the middle of the container.
class BedTop {
 public:
  /// `down` is a unit vector.
  BedTop(const BedTarget&, const Container&, const Vector<3>& down);

  /// How high, against gravity, the surface through p is: of a heap its tip.
  double height(const Vector<3>& p) const;
  /// The planes that a bed lies in front of whose surface is so high: the level, of a heap at its tip, and
  /// the flanks.
  std::vector<Facet> planes(double height) const;
  const Vector<3>& up() const { return up_; }
  bool is_level() const { return normals_.empty(); }

 private:
  Vector<3> up_, middle_ = Vector<3>::Zero();
  double cosine_ = 1;               // of the flanks' angle
  std::vector<Vector<3>> normals_;  // of the flanks, unit, out of the bed
};

/// The part of a container in front of planes. `volume` is its own. The planes are decided in doubles; all
/// questions else are passed on.
std::shared_ptr<const Container> cut_by_planes(std::shared_ptr<const Container>, std::vector<Facet> planes,
                                               double volume);

/// 32,768 evenly distributed points inside; fewer of a container that is hardly more than nothing. Cost: a
/// question to the walls a point.
std::vector<Vector<3>> even_points_inside(const Container&);

/// How much of a container lies below a surface: by evenly distributed points inside. Error: some
/// thousandths. Cost: that of these points, once.
class Heights {
 public:
  /// `ground`: height of the lowest point of the domain.
  Heights(const Container&, const BedTop&, double ground);

  /// Of the lowest point of the container.
  double ground() const { return ground_; }
  /// Of the surface of that height; at most the container's.
  double volume_below(double height) const;
  /// Of the surface below which the container holds that volume. Precondition: volume > 0.
  double holding(double volume) const;
  /// Of the part below the surface whose points have that mean height: of a bed that is as dense everywhere,
  /// and whose spheres have that mean, weighted by their volumes.
  double volume_below_mean(double height) const;

 private:
  std::vector<double> heights_;  // of the surfaces through the points, ascending
  double ground_;
  double volume_;
};

}  // namespace bernal
