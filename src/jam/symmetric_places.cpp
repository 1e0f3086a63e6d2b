#include "jam/symmetric_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace bernal {
namespace {

using Group = std::vector<Eigen::Matrix3d>;

constexpr std::size_t most_elements = 48;
/// Of the container's size: how much the clearances of images may differ by rounding.
constexpr double same = 1e-9;
constexpr int looks = 8;
constexpr int most_orbits = 400;

/// All products of these.
Group generated_by(const Group& generators) {
  Group all = {Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < all.size() && all.size() <= most_elements; ++i)
    for (const Eigen::Matrix3d& generator : generators) {
      const Eigen::Matrix3d product = generator * all[i];
      if (std::ranges::none_of(all, [&](const auto& other) { return (other - product).norm() < 0.1; }))
        all.push_back(product);
    }
  return all;
}

/// Turned about the last axis, at times also about the first, and at times about the diagonal of all three,
/// of which each may be a reflection too.
Group random_group(int dimension, Random& random) {
  const auto about = [&](double angle, const Vector<3>& axis) -> Eigen::Matrix3d {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  };
  constexpr double full = 2 * std::numbers::pi;
  constexpr double reflects = 0.3, also_about_first = 0.4, about_diagonal = 0.4;
  const auto reflected = [&](Eigen::Matrix3d turn) -> Eigen::Matrix3d {
    return random.uniform() < reflects ? Eigen::Matrix3d(-turn) : turn;
  };
  if (dimension == 2) {
    Group generators = {about(full / std::floor(random.uniform(2, 7)), Vector<3>::UnitZ())};
    if (random.uniform() < also_about_first) generators.push_back(about(0.5 * full, Vector<3>::UnitX()));
    return generated_by(generators);
  }
  if (random.uniform() < about_diagonal)
    return generated_by({about(full / 3, Vector<3>::Ones()),
                         reflected(about(full / (random.uniform() < 0.5 ? 2 : 4), Vector<3>::UnitZ()))});
  Group generators = {reflected(about(full / std::floor(random.uniform(2, 7)), Vector<3>::UnitZ()))};
  if (random.uniform() < also_about_first)
    generators.push_back(reflected(about(0.5 * full, Vector<3>::UnitX())));
  return generated_by(generators);
}

}  // namespace

std::optional<std::vector<Vector<3>>> symmetric_places(const Container& container, const Places& places,
                                                       std::size_t count, double radius, Random& random) {
  const Group group = random_group(container.dimension(), random);
  const Vector<3> middle = container.bounds().center();
  const auto image = [&](const Eigen::Matrix3d& element, const Vector<3>& p) -> Vector<3> {
    return middle + element * (p - middle);
  };
  for (int k = 0; k < looks; ++k) {
    const Vector<3> p = places.draw(random);
    for (const Eigen::Matrix3d& element : group)
      if (std::abs(container.clearance(image(element, p)) - container.clearance(p)) >
          same * container.bounds().size().norm())
        return {};
  }
  std::vector<Vector<3>> all;
  for (int k = 0; k < most_orbits && all.size() < count; ++k) {
    Vector<3> p = places.draw(random), sum = Vector<3>::Zero();
    int near = 0;
    for (const Eigen::Matrix3d& element : group)
      if (const Vector<3> other = image(element, p); (other - p).norm() < 2 * radius) sum += other, ++near;
    p = sum / near;
    if (!(container.clearance(p) > 0)) continue;
    std::vector<Vector<3>> orbit;
    for (const Eigen::Matrix3d& element : group) {
      const Vector<3> other = image(element, p);
      if (std::ranges::none_of(orbit, [&](const auto& one) { return (one - other).norm() < radius; }))
        orbit.push_back(other);
    }
    const auto crowds = [&](const Vector<3>& one) { return (one - orbit.front()).norm() < radius; };
    if (all.size() + orbit.size() > count || std::ranges::any_of(all, crowds)) continue;
    all.insert(all.end(), orbit.begin(), orbit.end());
  }
  if (all.size() < count) return {};
  return all;
}

}  // namespace bernal
