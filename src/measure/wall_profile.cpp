#include "bernal/measure/wall_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"
#include "core/parallel.hpp"
#include "measure/depths.hpp"
#include "measure/even_points.hpp"
#include "measure/localised.hpp"
#include "measure/volume_in.hpp"

namespace bernal {
namespace {

constexpr std::size_t spheres_a_part = 256;
constexpr double fewest_points = 8, most_points = 512;  // in a sphere
/// In mean diameters: deeper layers hardly differ, and fewer points suffice.
constexpr double structured = 2;
constexpr double least_reach = WallProfile::core_depth + 1;
/// For a mesh half of the work is for its spheres and half for itself; other walls are faster.
constexpr double mesh_share = 0.5, analytic_share = 4;

/// The volume of spheres in a zone of the container.
struct Filling {
  double volume = 0;
  double variance = 0;  ///< of the volume

  /// Adds a sphere of volume v with `inside` of its `points` points in the zone.
  void add(double v, std::uint32_t inside, std::uint32_t points) {
    const double share = static_cast<double>(inside) / points;
    volume += v * share;
    variance += v * v * share * (1 - share) / points;
  }
  void add(const Filling& other) {
    volume += other.volume;
    variance += other.variance;
  }
};

/// Zones between two depths: the layers, the near-wall zone and the core, which overlap the layers.
struct Zones {
  std::vector<double> edges;  ///< where the layers begin
  double near = 0, core = 0;

  std::size_t count() const { return edges.size() + 2; }
  std::size_t near_zone() const { return edges.size(); }
  std::size_t core_zone() const { return edges.size() + 1; }
  std::size_t layer_of(double z) const {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end(), z);
    return static_cast<std::size_t>(above - edges.begin()) - 1;
  }
  void count(double z, std::vector<std::uint32_t>& points) const {
    ++points[layer_of(z)];
    points[near_zone()] += z < near;
    points[core_zone()] += z >= core;
  }
};

/// The least share of the last layer: in a smaller one the porosity would be that of a single pore or sphere.
constexpr double least_rest = 0.01;

/// Layers of equal thickness down to `reach`, or to half a layer from the deepest point, and one for the
/// rest; all have a volume.
std::vector<double> edges_of(const Depths& depths, double thickness, double reach) {
  constexpr double rounding = 1e-9;
  std::vector<double> edges = {0};
  for (int k = 1;; ++k) {
    const double z = k * thickness;
    if (z > reach + rounding * thickness || z > depths.deepest() - 0.5 * thickness) break;
    if (depths.deeper(z) < least_rest) break;
    if (depths.deeper(z) < depths.deeper(edges.back())) edges.push_back(z);
  }
  return edges;
}

/// The clearance of every centre, as far as the sphere may reach into a layer.
std::vector<double> clearances(const Container& container, const Spheres<3>& spheres, double reach) {
  std::vector<double> found(spheres.size());
  parallel_for(spheres.size(), [&](std::size_t i) {
    found[i] = container.clearance_within(spheres.center(i), reach + spheres.r[i]);
  });
  return found;
}

/// Spreads the volumes of the spheres over the zones; spheres beyond reach count whole. Parts above the level
/// are left out.
std::vector<Filling> fill(const Container& container, const Spheres<3>& spheres,
                          const std::vector<double>& clearance, const Zones& zones, double reach,
                          std::uint32_t points, const std::optional<LowerPart>& below) {
  std::vector<std::vector<Filling>> parts((spheres.size() + spheres_a_part - 1) / spheres_a_part);
  parallel_for(parts.size(), [&](std::size_t part) {
    std::vector<Filling>& filling = parts[part];
    filling.resize(zones.count());
    std::vector<std::uint32_t> inside(zones.count());
    for (std::size_t i = part * spheres_a_part; i < std::min(spheres.size(), (part + 1) * spheres_a_part);
         ++i) {
      throw_if_interrupted();
      const double r = spheres.r[i];
      const double v = below ? ball_in(*below, 3, spheres.center(i), r) : ball_volume(3, r);
      if (!(v > 0)) continue;
      const bool cut = v < ball_volume(3, r);
      std::ranges::fill(inside, 0u);
      const bool beyond = clearance[i] - r >= reach;
      Random random(0, stream(Stream::measure, i));
      const Vector<3> shift = uniform_point<3>(random, {Vector<3>::Zero(), Vector<3>::Ones()});
      const std::uint32_t tried = clearance[i] < structured * zones.near ? points : std::max(2u, points / 4);
      std::uint32_t looked = 0;
      for (std::uint32_t k = 0; !beyond && k < tried; ++k) {
        const Vector<3> away = r * even_point_in_ball(k, shift);
        if (cut && !below->contains(spheres.center(i) + away)) continue;
        ++looked;
        // As clearance is 1-Lipschitz, a tight bound makes the query cheap.
        const double most = std::min(reach, clearance[i] + away.norm());
        zones.count(container.clearance_within(spheres.center(i) + away, most), inside);
      }
      if (looked == 0) zones.count(beyond ? reach : std::min(reach, clearance[i]), inside);
      for (std::size_t zone = 0; zone < filling.size(); ++zone)
        filling[zone].add(v, inside[zone], std::max(looked, 1u));
    }
  });
  std::vector<Filling> sum(zones.count());
  for (const std::vector<Filling>& part : parts)
    for (std::size_t zone = 0; zone < sum.size(); ++zone) sum[zone].add(part[zone]);
  return sum;
}

struct Fraction {
  double value, error;
};

/// Packing fraction of a zone with this share of the container.
Fraction fraction_of(const Filling& filling, double share, double share_error, double volume) {
  if (!(share > 0)) return {0, 0};
  const double value = filling.volume / (share * volume);
  return {value, std::hypot(std::sqrt(filling.variance) / (share * volume), value * share_error / share)};
}

std::optional<WallProfile::Minimum> minimum_of(const WallProfile& profile, double thickness) {
  std::vector<double> porosities;
  for (const WallProfile::Layer& layer : profile.layers) porosities.push_back(layer.porosity);
  porosities.pop_back();  // the last layer may have any thickness
  return first_minimum(porosities, thickness, profile.mean_diameter);
}

/// The volumes of the spheres, in cubed mean radii, and their sums by place.
class Volumes {
 public:
  Volumes(const std::vector<double>& radii, double mean_radius) {
    for (const double r : radii) cubes_.push_back(std::pow(r / mean_radius, 3));
    mean_ = std::accumulate(cubes_.begin(), cubes_.end(), 0.0) / count();
    for (const double cube : cubes_) squares_ += std::pow(cube - mean_, 2);
  }

  /// Segregation in each of `places` places; place_of(i) is that of sphere i, or none of them.
  template <class PlaceOf>
  std::vector<std::optional<WallProfile::Segregation>> of(std::size_t places, PlaceOf&& place_of) const {
    std::vector<double> sum(places, 0), there(places, 0);
    for (std::size_t i = 0; i < cubes_.size(); ++i) {
      const std::size_t place = place_of(i);
      if (place >= places) continue;
      sum[place] += cubes_[i];
      ++there[place];
    }
    std::vector<std::optional<WallProfile::Segregation>> found(places);
    for (std::size_t k = 0; k < places; ++k)
      if (there[k] > 0) found[k] = segregation(sum[k], there[k]);
    return found;
  }

 private:
  WallProfile::Segregation segregation(double sum, double there) const {
    const double n = count();
    // Drawn from n without replacement.
    const double error = n > 1 ? std::sqrt(squares_ / (n - 1) / there * (1 - there / n)) / mean_ : 0;
    return {static_cast<std::uint64_t>(there), sum / there / mean_, error};
  }
  double count() const { return static_cast<double>(cubes_.size()); }

  std::vector<double> cubes_;
  double mean_ = 0, squares_ = 0;
};

Region region_of(double clearance, double r, const Zones& zones) {
  if (clearance - r < zones.near) return Region::near_wall;
  return clearance >= zones.core ? Region::core : Region::between;
}

}  // namespace

std::optional<WallProfile::Minimum> first_minimum(std::span<const double> porosities, double thickness,
                                                  double diameter) {
  const auto middle = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) * thickness; };
  std::size_t lowest = 0;
  for (std::size_t k = 1; k < porosities.size() && middle(k) < diameter; ++k)
    if (porosities[k] < porosities[lowest]) lowest = k;
  if (lowest == 0 || lowest + 1 >= porosities.size()) return {};
  const double before = porosities[lowest - 1], least = porosities[lowest], after = porosities[lowest + 1];
  if (after < least) return {};  // decreasing further
  const double bend = before - 2 * least + after;
  const double shift = bend > 0 ? 0.5 * (before - after) / bend : 0;
  return WallProfile::Minimum{middle(lowest) + shift * thickness, least - 0.25 * (before - after) * shift};
}

std::optional<WallProfile> wall_profile(const Spheres<dynamic>& packed, const Domain& domain,
                                        const WallOptions& options,
                                        const std::shared_ptr<const Container>& made) {
  if (!has_walls(domain) || dimension_of(domain) != 3 || packed.empty()) return {};
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, made);
  const Spheres<3> spheres = localised(packed, frame);
  const auto below = options.below ? std::optional(options.below->to_local(frame)) : std::nullopt;
  const double diameter =
      2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
  const double thickness = options.layer * diameter;
  const double reach = std::max(options.reach, least_reach) * diameter;
  const Depths depths(to_local(domain, frame), *container, reach,
                      static_cast<std::size_t>(mesh_share * options.work), below);
  const double volume = depths.volume();

  WallProfile profile;
  profile.has_core = depths.deepest() >= least_reach * diameter;
  Zones zones;
  zones.edges = edges_of(depths, thickness, reach);
  zones.near = diameter;
  zones.core = profile.has_core ? WallProfile::core_depth * diameter : 0.5 * depths.deepest();

  // A sphere at the search depth lies in the last layer, which begins at most a rounding below it.
  const double looked = std::max(reach, zones.edges.back());
  const std::vector<double> clearance = clearances(*container, spheres, looked);
  double within_reach = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) within_reach += clearance[i] - spheres.r[i] < looked;
  const double work = options.work * (std::holds_alternative<Mesh>(domain) ? mesh_share : analytic_share);
  const auto points =
      static_cast<std::uint32_t>(std::clamp(work / std::max(1.0, within_reach), fewest_points, most_points));
  const std::vector<Filling> filling = fill(*container, spheres, clearance, zones, looked, points, below);

  const auto in_scene = [&](double local) { return frame.scale * local; };
  for (std::size_t k = 0; k < zones.edges.size(); ++k) {
    const bool last = k + 1 == zones.edges.size();
    const double from = zones.edges[k], to = last ? depths.deepest() : zones.edges[k + 1];
    const double share = depths.deeper(from) - (last ? 0 : depths.deeper(to));
    const Fraction solid = fraction_of(filling[k], share, depths.error_of(share), volume);
    profile.layers.push_back({in_scene(from), in_scene(to), share, 1 - solid.value, solid.error});
  }
  profile.mean_diameter = in_scene(diameter);
  profile.mean_porosity =
      below ? 1 - filled_in(*below, 3, spheres) / volume : 1 - packing_fraction(packed, domain);
  const double near_share = 1 - depths.deeper(zones.near), core_share = depths.deeper(zones.core);
  profile.near_wall_packing_fraction = fraction_of(filling[zones.near_zone()], near_share, 0, volume).value;
  const Fraction core =
      fraction_of(filling[zones.core_zone()], core_share, depths.error_of(core_share), volume);
  profile.core_packing_fraction = core.value;
  profile.core_packing_error = core.error;
  profile.core_from = in_scene(zones.core);
  profile.first_minimum = minimum_of(profile, in_scene(thickness));
  for (std::size_t i = 0; i < spheres.size(); ++i)
    profile.regions.push_back(region_of(clearance[i], spheres.r[i], zones));
  const Volumes volumes(spheres.r, 0.5 * diameter);
  profile.segregation =
      volumes.of(1, [&](std::size_t i) { return profile.regions[i] == Region::near_wall ? 0 : 1; }).front();
  const auto by_layer = volumes.of(profile.layers.size(), [&](std::size_t i) {
    return zones.layer_of(std::max(0.0, clearance[i] - spheres.r[i]));
  });
  for (std::size_t k = 0; k < profile.layers.size(); ++k) profile.layers[k].segregation = by_layer[k];
  return profile;
}

}  // namespace bernal
