#include "soft/bed_density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "domain/ball_below.hpp"
#include "domain/places.hpp"

namespace bernal {
namespace {

/// What is left out of a core, in mean diameters, and at most of the height.
constexpr double end_in_diameters = 3, end_of_height = 0.25;
constexpr std::size_t points_to_ask = 1 << 15;
/// Of the size of a container: how near points are that count as near its walls.
constexpr double width_at_wall = 0.02;
/// Sine of the angle with gravity up to which a wall is flattest_upright.
constexpr double flattest_upright = std::numbers::sqrt2 / 2;
constexpr double parallel_to = 1e-9;

/// The cylinder around the middle of the container whose axis is that direction.
std::optional<double> radius_of_column(const Container& container, const Vector<3>& axis) {
  if (container.kind() != "cylinder") return {};
  std::vector<NearFacet> walls;
  container.facets_near(container.bounds().center(), container.bounds().size().norm(), walls);
  for (const auto& [distance, facet] : walls)
    if (facet.kind == Facet::Kind::cylinder && std::abs(facet.b.normalized().dot(axis)) > 1 - parallel_to)
      return facet.radius;
  return {};
}

/// What `Heights` says; of a container whose sections across `down` are all the same, exactly.
class LevelVolumes {
 public:
  LevelVolumes(const Container& container, const Heights& heights, const BedTop& top)
      : heights_(heights), floor_(heights.ground()) {
    if (!top.is_level()) return;
    const Vector<3> down = -top.up();
    const Bounds<3> bounds = container.bounds();
    for (int k = 0; k < 3; ++k) {
      if (std::abs(down[k]) != 1) continue;
      if (container.kind() != "box" && !radius_of_column(container, down)) continue;
      section_ = container.volume() / bounds.size()[k];
      floor_ = down[k] < 0 ? bounds.lower[k] : -bounds.upper[k];
    }
  }

  double floor() const { return floor_; }
  double operator()(double height) const {
    return section_ > 0 ? section_ * height : heights_.volume_below(floor_ + height);
  }
  double height_holding(double volume) const {
    return section_ > 0 ? volume / section_ : heights_.holding(volume) - floor_;
  }
  double mean(double mean_height) const {
    return section_ > 0 ? 2 * section_ * (mean_height - floor_) : heights_.volume_below_mean(mean_height);
  }

 private:
  const Heights& heights_;
  double floor_;
  double section_ = 0;  // 0: they differ
};

/// From the volumes within t and 2 t of the flattest_upright walls, so that their curvature is no error.
double hydraulic_diameter(const Container& container, const Vector<3>& down) {
  const Bounds<3> bounds = container.bounds();
  const double t = width_at_wall * std::cbrt(container.volume());
  Random random(0, stream(Stream::measure));
  const std::vector<Vector<3>> points = points_inside(
      container, points_to_ask, 1, [&](std::size_t) { return uniform_point<3>(random, bounds); });
  double once = 0, twice = 0;
  std::vector<NearFacet> walls;
  for (const Vector<3>& p : points) {
    walls.clear();
    container.facets_near(p, 2 * t, walls);
    const auto nearest = std::ranges::find_if(walls, [&](const NearFacet& near) {
      const Vector<3> away = p - closest_point(near.facet, p);
      return std::abs(away.dot(down)) < flattest_upright * away.norm();
    });
    if (nearest == walls.end()) continue;
    ++twice;
    if (nearest->distance < t) ++once;
  }
  const double area = (4 * once - twice) / (2 * t);  // of a volume that is the number of points
  return area > 0 ? 4 * static_cast<double>(points.size()) / area : bounds.size().norm();
}

}  // namespace

double porosity_poured(double across) { return 0.390 + 1.740 / ((across + 1.140) * (across + 1.140)); }
double porosity_vibrated(double across) { return 0.372 + 0.002 * std::expm1(15.306 / across); }
double porosity_loose(double across) { return 0.400 + 0.010 * std::expm1(10.686 / across); }

std::optional<BedPorosity> porosity_of(const Bed& bed, const Heights& heights, const BedTop& top) {
  double volume = 0, moment = 0;
  for (Bed::Id i = 0; i < bed.size(); ++i) {
    const double own = ball_volume(3, bed[i].r);
    volume += own;
    moment += own * top.height(bed[i].center);
  }
  const LevelVolumes below(bed.container(), heights, top);
  const double up_to_surface = below.mean(moment / volume);
  const double whole = 1 - volume / up_to_surface;
  if (!(whole > 0 && whole < 1)) return {};
  if (!top.is_level()) return BedPorosity{whole, whole};
  const double floor = below.floor(), height = below.height_holding(up_to_surface);
  const double end = std::min(2 * end_in_diameters * bed.mean_radius(), end_of_height * height);
  double inside = 0;
  for (Bed::Id i = 0; i < bed.size(); ++i) {
    const double r = bed[i].r, h = top.height(bed[i].center) - floor;
    inside += ball_below(3, r, height - end - h) - ball_below(3, r, end - h);
  }
  const double core = 1 - inside / (below(height - end) - below(end));
  return BedPorosity{whole, core > 0 && core < 1 ? core : whole};
}

Across across_of(const Container& container, const Vector<3>& down, double mean_diameter) {
  if (const auto radius = radius_of_column(container, down)) return {2 * *radius / mean_diameter, true};
  return {hydraulic_diameter(container, down) / mean_diameter, false};
}

double mean_diameter(const SpheresInBed& in_bed, std::size_t count) {
  double cubes = 0, squares = 0;
  for (const double r : in_bed.drawn(count).spheres.r) {
    cubes += r * r * r;
    squares += r * r;
  }
  return 2 * cubes / squares;
}

std::pair<std::optional<DensityAim>, std::string> aim_of(const BedTarget& bed, const Across& across,
                                                         double denser) {
  if (bed.porosity) return {DensityAim{*bed.porosity, false, "as was asked"}, ""};
  if (!bed.density || *bed.density == BedTarget::Density::poured) return {};
  const bool loose = *bed.density == BedTarget::Density::loose;
  const std::string_view kind = loose ? "loose" : "vibrated";
  if (across.diameters < least_across * (1 - parallel_to))
    return {std::nullopt,
            fmt::format("it is {:.3g} diameters across, and below {:g} no law of {} beds holds: geometry "
                        "decides, chains and rings",
                        across.diameters, least_across, kind)};
  const double equal = loose ? porosity_loose(across.diameters) : porosity_vibrated(across.diameters);
  std::string words = fmt::format("Zou and Yu's law of {} beds, {:.3g} diameters across",
                                  loose ? "loose" : "dense", across.diameters);
  if (!across.is_column || denser != 1)
    words += fmt::format(", a guess: it is of {}", across.is_column ? "equal spheres"
                                                   : denser == 1    ? "columns"
                                                                    : "equal spheres in columns");
  return {DensityAim{1 - std::min(1.0, denser * (1 - equal)), true, words}, ""};
}

}  // namespace bernal
