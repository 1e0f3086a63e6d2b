#include "meshes/hold_volume.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bernal {
namespace {

constexpr double most_of_room = 0.2;
constexpr double largest_factor = 3;

double solid_angle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

class Facets {
 public:
  Facets(std::span<const Vector<3>> boundary, const PatchMesh& mesh, double radius,
         const std::function<double(const Vector<3>&)>& room)
      : mesh_(mesh), first_(boundary.size()), points_(boundary.begin(), boundary.end()) {
    points_.insert(points_.end(), mesh.added.begin(), mesh.added.end());
    measure(radius);
    for (std::size_t k = first_; k < points_.size(); ++k)
      most_.push_back(rise_[k] > 0 ? most_of_room * std::max(0.0, room(points_[k])) : 0);
  }

  /// The points with the largest factor up to the limit that holds no more than the true volume.
  std::vector<Vector<3>> raised() const {
    double low = 0, high = largest_factor, missing = volume_ - volume_with(0);
    if (!(missing > 0)) return mesh_.added;
    if (volume_with(high) > volume_) {
      // The volume is nearly linear in the factor: regula falsi from a bracket, then halving.
      for (int k = 0; k < 60 && high - low > 1e-15 * high; ++k) {
        const double at_low = volume_ - volume_with(low), at_high = volume_ - volume_with(high);
        double middle = low + (high - low) * at_low / (at_low - at_high);
        if (k % 2 == 1 || !(middle > low && middle < high)) middle = 0.5 * (low + high);
        (volume_with(middle) > volume_ ? high : low) = middle;
      }
      high = low;
    }
    std::vector<Vector<3>> made;
    for (std::size_t k = first_; k < points_.size(); ++k) made.push_back(place(k, high));
    return made;
  }

 private:
  void measure(double radius) {
    rise_.assign(points_.size(), 0);
    std::vector<double> area(points_.size(), 0);
    for (const FaceCorners& t : mesh_.triangles) {
      const Vector<3>&a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
      const double twice = (b - a).cross(c - a).norm();
      const double mean =
          ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm()) / (24 * radius);
      for (const std::uint32_t corner : t) {
        rise_[corner] += twice * mean;
        area[corner] += twice;
      }
      volume_ += radius * radius * radius * solid_angle(a, b, c) / 3;
    }
    for (std::size_t k = 0; k < rise_.size(); ++k) rise_[k] = area[k] > 0 ? rise_[k] / area[k] : 0;
  }

  Vector<3> place(std::size_t k, double factor) const {
    const Vector<3>& p = points_[k];
    return k < first_ ? p : Vector<3>(p + std::min(factor * rise_[k], most_[k - first_]) * p.normalized());
  }

  double volume_with(double factor) const {
    double six = 0;
    for (const FaceCorners& t : mesh_.triangles)
      six += place(t[0], factor).dot(place(t[1], factor).cross(place(t[2], factor)));
    return six / 6;
  }

  const PatchMesh& mesh_;
  std::size_t first_;  ///< of the points that move
  std::vector<Vector<3>> points_;
  std::vector<double> rise_, most_;
  double volume_ = 0;
};

}  // namespace

void hold_volume(std::span<const Vector<3>> boundary, PatchMesh& mesh, double radius,
                 const std::function<double(const Vector<3>&)>& room) {
  if (!mesh.added.empty()) mesh.added = Facets(boundary, mesh, radius, room).raised();
}

}  // namespace bernal
