#include "jam/lattice_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "settle/crystal.hpp"

namespace bernal {
namespace {

/// Of the spacing: places nearer to a wall are none.
constexpr double least_clearance = 0.25;
/// Bounds of the spacing, in radii of spheres that fill half of the container, and how often it is halved.
constexpr double least_spacing = 0.5, most_spacing = 4;
constexpr int halvings = 14;
constexpr double most_cells = 40'000;
constexpr double stretch = 0.1;

CrystalCell random_cell(int dimension, Random& random) {
  constexpr Layout kinds[] = {Layout::sc, Layout::fcc, Layout::bcc, Layout::hcp};
  return cell_of(kinds[static_cast<std::size_t>(random.uniform() * (dimension == 3 ? 4 : 2))], dimension);
}

Eigen::Matrix3d turn(int dimension, Random& random) {
  constexpr double turned_anyhow = 0.4, right = 0.5 * std::numbers::pi;
  const auto about = [](double angle, int axis) {
    return Eigen::AngleAxisd(angle, Vector<3>::Unit(axis)).toRotationMatrix();
  };
  const bool anyhow = random.uniform() < turned_anyhow;
  if (dimension == 2) return anyhow ? about(4 * right * random.uniform(), 2) : Eigen::Matrix3d::Identity();
  if (anyhow) {
    const Vector<4> q = uniform_direction<4>(random);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  }
  const auto k = static_cast<int>(6 * random.uniform());
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  if (k % 3 > 0) turned = about(right, k % 3 - 1);
  return k >= 3 ? Eigen::Matrix3d(turned * about(0.5 * right, 2)) : turned;
}

struct Site {
  double clearance;
  Vector<3> place;
};

/// A lattice that is turned and shifted, of any spacing.
class Sites {
 public:
  Sites(const Container& container, Random& random)
      : container_(container),
        lattice_(random_cell(container.dimension(), random)),
        to_space_(turn(container.dimension(), random)) {
    const int dimension = container.dimension();
    for (int k = 0; k < dimension; ++k) shift_[k] = random.uniform();
    if (random.uniform() < 0.5)
      for (int k = 0; k < dimension; ++k) shift_[k] = 0.25 * std::floor(4 * shift_[k]);
    Vector<3> stretched = lattice_.edges;
    if (random.uniform() < 0.5)
      for (int k = 0; k < dimension; ++k) stretched[k] *= std::exp(random.uniform(-stretch, stretch));
    to_space_ = to_space_ * stretched.asDiagonal();
  }

  /// How many cells of that spacing it takes to cover the container, and how many those are along each axis.
  double cells(double spacing, Vector<3>& along) const {
    const Vector<3> half = 0.5 * container_.bounds().size();
    const Eigen::Matrix3d to_cells = (spacing * to_space_).inverse();
    along = (to_cells.cwiseAbs() * half).array().ceil() + 2;  // the shift and a place in a cell are below 1
    if (container_.dimension() == 2) along[2] = 0;
    return (2 * along.array() + 1).prod() * static_cast<double>(lattice_.sites.size());
  }

  std::vector<Site> with(double spacing) const {
    Vector<3> along;
    cells(spacing, along);
    std::vector<Site> sites;
    const Vector<3> middle = container_.bounds().center(), half = 0.5 * container_.bounds().size();
    for (double i = -along[0]; i <= along[0]; ++i)
      for (double j = -along[1]; j <= along[1]; ++j)
        for (double k = -along[2]; k <= along[2]; ++k)
          for (const Vector<3>& place : lattice_.sites) {
            const Vector<3> in_cells = place + shift_ + Vector<3>(i, j, k);
            Vector<3> at = middle + spacing * (to_space_ * in_cells);
            if (container_.dimension() == 2) at[2] = 0;
            if (((at - middle).cwiseAbs() - half).maxCoeff() > 0) continue;
            if (const double clearance = container_.clearance(at); clearance > least_clearance * spacing)
              sites.push_back({clearance, at});
          }
    return sites;
  }

 private:
  const Container& container_;
  const CrystalCell lattice_;
  Eigen::Matrix3d to_space_;
  Vector<3> shift_ = Vector<3>::Zero();
};

}  // namespace

std::optional<std::vector<Vector<3>>> lattice_places(const Container& container, std::size_t count,
                                                     double radius, Random& random) {
  const Sites lattice(container, random);
  const bool deepest = random.uniform() < 0.5;
  double wide = least_spacing * radius, too_wide = most_spacing * radius;
  if (Vector<3> along; lattice.cells(std::sqrt(wide * too_wide), along) > most_cells) return {};
  for (int k = 0; k < halvings; ++k) {
    const double spacing = std::sqrt(wide * too_wide);
    Vector<3> along;
    const bool enough = lattice.cells(spacing, along) > most_cells || lattice.with(spacing).size() >= count;
    (enough ? wide : too_wide) = spacing;
  }
  if (Vector<3> along; lattice.cells(wide, along) > most_cells) return {};
  std::vector<Site> sites = lattice.with(wide);
  if (sites.size() < count) return {};
  if (deepest)
    std::ranges::stable_sort(sites, std::ranges::greater(), &Site::clearance);
  else
    for (std::size_t i = 0; i + 1 < sites.size(); ++i)
      std::swap(sites[i], sites[i + random() % (sites.size() - i)]);
  std::vector<Vector<3>> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(sites[i].place);
  return places;
}

std::optional<std::vector<Vector<3>>> grid_places(const Container& container, std::size_t count) {
  const Bounds<3> bounds = container.bounds();
  Vector<3> cells = Vector<3>::Ones(), size = bounds.size();
  if (container.dimension() == 2) size[2] = 0;
  while (cells.prod() < static_cast<double>(count)) {
    int widest = 0;  // the axis along which one more cell leaves the most to each
    (size.array() / (cells.array() + 1)).maxCoeff(&widest);
    ++cells[widest];
  }
  std::vector<Vector<3>> places;
  for (double i = 0; i < cells[0]; ++i)
    for (double j = 0; j < cells[1]; ++j)
      for (double k = 0; k < cells[2] && places.size() < count; ++k) {
        const Vector<3> middle_of_cell = (Vector<3>(i, j, k).array() + 0.5) / cells.array();
        const Vector<3> place = bounds.lower + middle_of_cell.cwiseProduct(size);
        if (!(container.clearance(place) > 0)) return {};
        places.push_back(place);
      }
  return places;
}

}  // namespace bernal
