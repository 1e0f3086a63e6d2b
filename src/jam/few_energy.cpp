#include "jam/few_energy.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "bernal/core/dimension.hpp"

namespace bernal {
namespace {

/// Of the container, what spheres of the expected size fill.
constexpr double expected_share = 0.5;
/// So many pieces of wall without borders are looked at all together.
constexpr std::size_t few_walls = 16;
/// In radii: how much farther than a sphere reaches its pieces of wall are found, to be kept while it moves.
constexpr double kept_margin = 0.03;

double expected_size_of(const std::vector<double>& radii, const Container& container) {
  double volume = 0;
  for (const double r : radii) volume += ball_volume(container.dimension(), r);
  return std::pow(expected_share * container.volume() / volume, 1.0 / container.dimension());
}

}  // namespace

FewEnergy::FewEnergy(const Container& container, std::vector<double> radii)
    : container_(container),
      enclosure_(container),
      radii_(std::move(radii)),
      dimension_(container.dimension()),
      expected_(expected_size_of(radii_, container)) {
  for (const double r : radii_) mean_square_ += r * r / static_cast<double>(size());
  unit_ = std::sqrt(2 * static_cast<double>(size()) * mean_square_);
  squared_.resize(size());
  const Vector<3> middle = container.bounds().center();
  std::vector<NearFacet> facets;
  const double everywhere = std::numeric_limits<double>::infinity();
  const bool are_few =
      container.inset() == 0 && container.clearance(middle) > 0 &&
      container.few_facets_near(middle, everywhere, few_walls, facets) &&
      std::ranges::none_of(facets, has_border, [](const NearFacet& n) { return n.facet.kind; });
  if (are_few)
    for (const NearFacet& near : facets) all_walls_.push_back(near.facet);
  else
    near_walls_.resize(size());
}

Vector<3> FewEnergy::center(const Eigen::VectorXd& point, std::size_t i) const {
  Vector<3> p = Vector<3>::Zero();
  for (int k = 0; k < dimension_; ++k) p[k] = point[dimension_ * static_cast<Eigen::Index>(i) + k];
  return p;
}

void FewEnergy::set_center(Eigen::VectorXd& point, std::size_t i, const Vector<3>& center) const {
  for (int k = 0; k < dimension_; ++k) point[dimension_ * static_cast<Eigen::Index>(i) + k] = center[k];
}

/// In equilibrium P is the sum of 2 o a over the contacts; of these there are D for each sphere.
double FewEnergy::set_overlap(double overlap) {
  const double diameters = 8 * dimension_ * static_cast<double>(size()) * mean_square_;
  return load_ = overlap * diameters * expected_;
}

/// Calls visit(normal, distance) for the pieces nearer than that; where two touch at one place, for one.
template <class Visit>
void FewEnergy::for_each_wall(std::size_t i, const Vector<3>& p, double reach, Visit&& visit) {
  for (const WallPiece<3>& piece : all_walls_)
    if (const WallView<3> view = view_of<3>(piece, p); view.distance < reach)
      visit(view.normal, view.distance);
  if (near_walls_.empty()) return;
  Near& near = near_walls_[i];
  if (!((p - near.at).norm() + reach <= near.reach)) {
    near.at = p;
    near.reach = (1 + kept_margin) * reach;
    near.pieces.clear();
    enclosure_.pieces_near(p, near.reach, near.pieces);
  }
  touched_.clear();
  looks_ += near.pieces.size();
  for (const WallPiece<3>& piece : near.pieces) {
    const WallView<3> view = view_of<3>(piece, p);
    if (!(view.distance < reach)) continue;
    const Vector<3> way = view.distance * view.normal;
    if (std::ranges::any_of(touched_, [&](const Vector<3>& other) {
          return (other - way).squaredNorm() <= enclosure_.same_place() * enclosure_.same_place();
        }))
      continue;
    touched_.push_back(way);
    visit(view.normal, view.distance);
  }
}

/// Calls visit(i, j, away, distance, a) for the pairs, i > j, and for the walls, where j is i; `away` points
/// to i, and is as long as the distance for pairs and a unit vector for walls.
template <class Visit>
void FewEnergy::for_each_overlap(const Eigen::VectorXd& point, Visit&& visit) {
  const double s = size_of(point);
  const double* const x = point.data();
  for (std::size_t i = 0; i < size(); ++i) {
    const auto n = static_cast<std::size_t>(dimension_);
    const Vector<3> p = center(point, i);
    if (n == 3)
      for (std::size_t j = 0; j < i; ++j) {
        const double dx = p[0] - x[3 * j], dy = p[1] - x[3 * j + 1], dz = p[2] - x[3 * j + 2];
        squared_[j] = dx * dx + dy * dy + dz * dz;
      }
    else
      for (std::size_t j = 0; j < i; ++j) {
        const double dx = p[0] - x[2 * j], dy = p[1] - x[2 * j + 1];
        squared_[j] = dx * dx + dy * dy;
      }
    for (std::size_t j = 0; j < i; ++j) {
      const double a = radii_[i] + radii_[j];
      if (squared_[j] >= s * s * a * a || !(squared_[j] > 0)) continue;
      visit(i, j, Vector<3>(p - center(point, j)), std::sqrt(squared_[j]), a);
    }
    for_each_wall(i, p, s * radii_[i], [&](const Vector<3>& normal, double distance) {
      visit(i, i, normal, distance, radii_[i]);
    });
  }
}

double FewEnergy::value(const Eigen::VectorXd& point, Eigen::VectorXd& gradient) {
  gradient.setZero();
  const double s = size_of(point);
  double by_size = -load_;
  elastic_ = 0;
  for_each_overlap(point,
                   [&](std::size_t i, std::size_t j, const Vector<3>& away, double distance, double a) {
                     const double weight = i == j ? 2 : 1, overlap = s * a - distance;
                     elastic_ += weight * overlap * overlap;
                     by_size += 2 * weight * overlap * a;
                     const double force = 2 * weight * overlap / (i == j ? 1 : distance);
                     for (int k = 0; k < dimension_; ++k) {
                       gradient[dimension_ * static_cast<Eigen::Index>(i) + k] -= force * away[k];
                       if (i != j) gradient[dimension_ * static_cast<Eigen::Index>(j) + k] += force * away[k];
                     }
                   });
  gradient[unknowns() - 1] = by_size / unit_;
  return elastic_ - load_ * s;
}

void FewEnergy::stiffness(const Eigen::VectorXd& point, Eigen::MatrixXd& out) {
  out.setZero(unknowns(), unknowns());
  const Eigen::Index last = unknowns() - 1;
  for_each_overlap(point,
                   [&](std::size_t i, std::size_t j, const Vector<3>& away, double distance, double a) {
                     const double weight = i == j ? 4 : 2;
                     const Vector<3> normal = i == j ? away : Vector<3>(away / distance);
                     const Eigen::Index at_i = dimension_ * static_cast<Eigen::Index>(i),
                                        at_j = dimension_ * static_cast<Eigen::Index>(j);
                     for (int k = 0; k < dimension_; ++k) {
                       for (int l = 0; l < dimension_; ++l) {
                         const double stiffness = weight * normal[k] * normal[l];
                         out(at_i + k, at_i + l) += stiffness;
                         if (i == j) continue;
                         out(at_j + k, at_j + l) += stiffness;
                         out(at_i + k, at_j + l) -= stiffness;
                       }
                       const double by_size = weight * normal[k] * a / unit_;
                       out(last, at_i + k) -= by_size;
                       if (i != j) out(last, at_j + k) += by_size;
                     }
                     out(last, last) += weight * a * a / (unit_ * unit_);
                   });
}

std::vector<double> FewEnergy::squeeze(const Eigen::VectorXd& point) {
  std::vector<double> of_each(size(), 0);
  const double s = size_of(point);
  for_each_overlap(point, [&](std::size_t i, std::size_t j, const Vector<3>&, double distance, double a) {
    const double overlap = s * a - distance;
    of_each[i] += overlap * overlap;
    of_each[j] += overlap * overlap;  // twice at a wall
  });
  return of_each;
}

double FewEnergy::largest_size(const Eigen::VectorXd& point) const {
  double s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector<3> p = center(point, i);
    s = std::min(s, container_.clearance(p) / radii_[i]);
    for (std::size_t j = 0; j < i; ++j)
      s = std::min(s, (p - center(point, j)).norm() / (radii_[i] + radii_[j]));
  }
  return s;
}

}  // namespace bernal
