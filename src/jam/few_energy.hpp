#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "bernal/domain/container.hpp"
#include "jam/enclosure.hpp"

namespace bernal {

/// Few soft spheres in a container that all grow by one factor s under a load P: the function
///   U(x, s) = sum over pairs of o² + 2 · sum over walls of o² - P s,   o = max(0, s a - d),
/// of all centres x and of s. a is the sum of two radii, and at a wall one radius; d is the distance of the
/// centres, and of the centre from a piece of wall. A wall is a mirror, as in `JammingEnergy`: a contact with
/// it is half of that with an image.
///
/// As the load goes to zero, its minima go to arrangements that leave s no room to grow. Where they are at a
/// small load is a good guess of how far: d(min U)/dP = -s, so that s is s - 2 (U + P s) / P there, but for
/// terms of P² (`size_without_load`).
///
/// `JammingEnergy` is the same for many spheres, whose neighbours are listed and whose container shrinks in
/// place of the growth. Here every pair is looked at, which for a hundred spheres is as fast as a list, and
/// needs none. Preconditions: 2 or 3 dimensions, no axis that repeats itself. Cost of a value: N² / 2
/// distances, about 1 ns each, and the near pieces of wall.
class FewEnergy {
 public:
  /// The container outlives this. Radii are above 0.
  FewEnergy(const Container& container, std::vector<double> radii);

  std::size_t size() const { return radii_.size(); }
  int dimension() const { return dimension_; }
  double radius(std::size_t i) const { return radii_[i]; }
  const Container& container() const { return container_; }
  /// About the s that is to be expected: at which the spheres fill half of the container.
  double expected_size() const { return expected_; }

  /// A point of the function: the coordinates of all centres and then s, in a unit that makes it about as
  /// stiff as a centre.
  Eigen::Index unknowns() const { return dimension_ * static_cast<Eigen::Index>(size()) + 1; }
  double size_of(const Eigen::VectorXd& point) const { return point[unknowns() - 1] / unit_; }
  void set_size(Eigen::VectorXd& point, double s) const { point[unknowns() - 1] = s * unit_; }
  Vector<3> center(const Eigen::VectorXd& point, std::size_t i) const;
  void set_center(Eigen::VectorXd& point, std::size_t i, const Vector<3>& center) const;

  /// Sets the load to one under which contacts overlap by about this share of the diameters. Returns P.
  double set_overlap(double overlap);
  double value(const Eigen::VectorXd& point, Eigen::VectorXd& gradient);
  /// Of the point at which `value` was asked last, if that is a minimum.
  double size_without_load(const Eigen::VectorXd& point) const {
    return size_of(point) - 2 * elastic_ / load_;
  }
  /// The part of the second derivative that does not vanish with the overlaps, 2 n n over the contacts, in
  /// the lower triangle. Cost: that of a value.
  void stiffness(const Eigen::VectorXd& point, Eigen::MatrixXd& out);
  /// Of spheres at pieces of wall with borders, so far: some ten distances each.
  std::uint64_t looks_at_pieces() const { return looks_; }
  /// The sum of o² of each sphere.
  std::vector<double> squeeze(const Eigen::VectorXd& point);

  /// The largest s at which nothing overlaps, with the centres where they are; negative where one is outside.
  double largest_size(const Eigen::VectorXd& point) const;

 private:
  struct Near {
    Vector<3> at;
    double reach = -1;
    std::vector<WallPiece<3>> pieces;
  };
  template <class Visit>
  void for_each_overlap(const Eigen::VectorXd& point, Visit&& visit);
  template <class Visit>
  void for_each_wall(std::size_t i, const Vector<3>& p, double reach, Visit&& visit);

  const Container& container_;
  const Enclosure<3> enclosure_;
  const std::vector<double> radii_;
  const int dimension_;
  double expected_, unit_, mean_square_ = 0;
  double load_ = 0, elastic_ = 0;
  std::uint64_t looks_ = 0;
  std::vector<WallPiece<3>> all_walls_;  // where these are few and without borders; else
  std::vector<Near> near_walls_;         // of each sphere
  std::vector<double> squared_;          // distances of one sphere from those before it
  std::vector<Vector<3>> touched_;       // by one sphere
};

}  // namespace bernal
