#pragma once
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/scene/bed_target.hpp"

namespace bernal {

/// The shape of a bed's surface: a level, or a heap. A heap is a pyramid with many flanks; its axis goes
/// along gravity through the middle of the container.
class BedTop {
 public:
  /// `down` is a unit vector.
  BedTop(const BedTarget&, const Container&, const Vector<3>& down);

  /// The height, against gravity, of the surface through p: that of its tip, if it is a heap.
  double height(const Vector<3>& p) const;
  /// The planes of the surface with this height: the level, or the flanks of a heap and the level at its tip.
  /// The bed is in front of them.
  std::vector<Facet> planes(double height) const;
  const Vector<3>& up() const { return up_; }
  bool is_level() const { return normals_.empty(); }

 private:
  Vector<3> up_, middle_ = Vector<3>::Zero();
  double cosine_ = 1;               // of the angle of the flanks
  std::vector<Vector<3>> normals_;  // unit normals of the flanks, out of the bed
};

/// The part of a container in front of planes; `volume` is that of the part. The planes are decided in
/// doubles; the container answers for its own walls.
std::shared_ptr<const Container> cut_by_planes(std::shared_ptr<const Container>, std::vector<Facet> planes,
                                               double volume);

/// 32,768 evenly distributed points inside a container; fewer if it fills hardly any of its bounds. Cost: a
/// question to the walls for each point.
std::vector<Vector<3>> even_points_inside(const Container&);

/// The volume of a container below a surface, from evenly distributed points inside. Error: some thousandths.
/// Cost: that of `even_points_inside`, once.
class Heights {
 public:
  /// `ground`: height of the lowest point of the domain.
  Heights(const Container&, const BedTop&, double ground);

  /// The height of the lowest point.
  double ground() const { return ground_; }
  /// The volume below the surface with this height.
  double volume_below(double height) const;
  /// The height of the surface below which the container has this volume. Precondition: volume > 0.
  double holding(double volume) const;
  /// The volume below the surface under which points have this mean height. If a bed is equally dense
  /// everywhere, and this is the mean height of its spheres weighted by volume, it is the volume of the bed.
  double volume_below_mean(double height) const;

 private:
  std::vector<double> heights_;  // of the surfaces through the points, ascending
  double ground_;
  double volume_;
};

}  // namespace bernal
