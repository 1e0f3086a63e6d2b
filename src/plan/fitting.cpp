#include "plan/fitting.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "plan/estimate.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"
#include "scene/entry.hpp"
#include "sizes/cut_above.hpp"
#include "work/bed.hpp"
#include "work/room.hpp"
#include "work/supply.hpp"

namespace bernal {
namespace {

/// Of the largest sphere that fits, the radii that a tail may be cut at.
constexpr double cuts[] = {1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1};
/// Of the volume: what is less is no matter.
constexpr double negligible = 1e-3;
/// Of random close packing, what walls and corners leave of it where a container is some spheres thick: what
/// is not filled needs no room.
constexpr double filled = 0.8;
/// Of the mean thickness V / A of a mesh or polygon: spheres up to this fit somewhere, without a look.
constexpr double surely_fitting = 0.5;
/// That a mesh is looked at in where it is open whether a sphere fits: half a second.
constexpr int many_cells = 200'000;
/// Of a mesh's largest sphere, what rounding may hide.
constexpr double hidden = 1e-9;

struct LargestRadius {
  double operator()(const Box& b) const {
    return 0.5 * (b.is_tilted() ? shortest_period(b) : b.size.minCoeff());
  }
  double operator()(const Cylinder& c) const { return std::min(c.radius, 0.5 * c.height); }
  double operator()(const Sphere& s) const { return s.radius; }
  double operator()(const Mesh& m) const {
    const double by_volume = std::cbrt(3 * volume_of(m) / (4 * std::numbers::pi));
    return std::min(0.5 * bounds_of(m).size().minCoeff(), by_volume);
  }
  double operator()(const Revolved& s) const {
    const double by_volume = std::cbrt(3 * volume_of(s) / (4 * std::numbers::pi));
    return std::min(0.5 * bounds_of(s).size().minCoeff(), by_volume);
  }
  double operator()(const Polygon& p) const {
    const double by_area = std::sqrt(volume_of(p) / std::numbers::pi);
    return std::min(0.5 * bounds_of<dynamic>(p).size().minCoeff(), by_area);
  }
};

/// Infinite where nothing repeats itself.
double shortest_period(const Domain& container) {
  const Boundary<3> boundary = boundary_of<3>(container);
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k)) shortest = std::min(shortest, boundary.edges[k]);
  return shortest;
}

}  // namespace

void require_long_periods(const Scene& scene, const Domain& container, double radius) {
  const double least = Bed::least_period * 2 * radius, shortest = shortest_period(container);
  if (shortest >= least) return;
  const bool has_limit = std::visit(
      [](const auto& kind) {
        return requires { kind.max; };
      },
      scene.sizes);
  // Rounded down, so that what is said is enough.
  const double largest = (scene.sizes_are_diameters ? 2 : 1) * shortest / (Bed::least_period * 2);
  const double step = std::pow(10.0, std::floor(std::log10(largest)) - 3);
  throw Error(ErrorCode::bad_scene,
              fmt::format("the container repeats itself every {:.6g} {}, in which spheres meet two images of "
                          "others; for these sizes make that at least {:.6g} {}{}",
                          shortest, name_of(scene.unit), least, name_of(scene.unit),
                          has_limit ? fmt::format(", or give them a \"max\" of {:.4g} {}",
                                                  step * std::floor(largest / step), name_of(scene.unit))
                                    : ""),
              scene.container.locations.whole);
}

double largest_fitting_radius(const Domain& shape) { return std::visit(LargestRadius{}, shape); }

namespace {

/// The largest radius that is known to fit, and the one that none exceeds.
struct Largest {
  double known, bound;
};
Largest largest_in(const Domain& shape, const std::shared_ptr<const Container>& made, int most_cells = 4000) {
  const double bound = largest_fitting_radius(shape);
  if (!is_faceted(shape)) return {bound, bound};
  const Frame frame = frame_of(shape);
  const LargestRoom room = largest_room(*local_container(shape, made), most_cells);
  return {room.radius * frame.scale, std::min(bound, (1 + hidden) * room.bound * frame.scale)};
}

/// The same, so closely that it is known whether that radius fits, if many cells tell: in thin walls all have
/// to become small.
Largest closely_largest(const Domain& shape, const std::shared_ptr<const Container>& made, double radius) {
  const Largest largest = largest_in(shape, made);
  return radius > largest.known && radius <= largest.bound ? largest_in(shape, made, many_cells) : largest;
}

/// What tells whether a sphere of that radius may fit, at no more cost than that takes.
Largest largest_for(const Domain& container, const std::shared_ptr<const Container>& made, double radius) {
  if (is_faceted(container) && radius > surely_fitting * volume_of(container) / area_of(container))
    return closely_largest(container, made, radius);
  return {largest_fitting_radius(container), largest_fitting_radius(container)};
}

}  // namespace

double largest_to_fit(const Plan& plan) {
  constexpr std::int64_t quickly_drawn = 100'000;
  const Scene& scene = plan.scene;
  const double most = plan.radii->max();
  if (!std::isfinite(most) || scene.is_periodic() || !scene.draw || !scene.target.count ||
      *scene.target.count > quickly_drawn || most <= largest_for(plan.domain, plan.container, most).bound)
    return most;
  const Supply::Source source{.radii = *plan.radii,
                              .dimension = scene.dimension(),
                              .seed = scene.seed,
                              .draw = *scene.draw,
                              .first = plan.start.spheres.r};
  return Supply(source, volume_of(plan.domain), scene.target).largest();
}

bool may_fit(const Plan& plan) {
  const Scene& scene = plan.scene;
  const double most = largest_to_fit(plan), radius = std::isfinite(most) ? most : plan.radii->quantile(0.5);
  const double allowed = has_walls(plan.domain) ? 0 : scene.overlap, least = (1 - allowed) * radius;
  if (least > largest_for(plan.domain, plan.container, least).bound) return false;
  return !any_in_bed(scene) || shortest_period(plan.domain) >= Bed::least_period * 2 * radius;
}

void require_fitting(const Scene& scene, const Domain& container,
                     const std::shared_ptr<const Container>& made, double radius, std::string_view remedy) {
  const Largest largest = largest_for(container, made, radius);
  if (radius <= largest.bound) return;
  const double shown = scene.sizes_are_diameters ? 2 : 1;
  const auto [one, many] =
      scene.sizes_are_diameters ? std::pair("diameter", "diameters") : std::pair("radius", "radii");
  const auto text = [&](double r) {  // with as many digits as tell the two apart
    const bool same = fmt::format("{:.6g}", radius) == fmt::format("{:.6g}", largest.known);
    return fmt::format("{:.{}g} {}", shown * (r - coat_of(scene)), same ? 17 : 6, name_of(scene.unit));
  };
  const std::string_view gaps = scene.asks_for_gaps() ? " with the gaps that are asked for" : "";
  if (scene.asks_for_gaps() && !(largest.known > coat_of(scene)))
    throw Error(ErrorCode::bad_scene,
                fmt::format("no sphere fits into the {}{}: use smaller gaps or check the units",
                            name_of(container), gaps),
                scene.locations.of(scene.wall_gap > 0 ? "wall_gap" : "gap"));
  throw Error(
      ErrorCode::bad_scene,
      fmt::format(
          "a sphere of {} {} does not fit into the {}{}, which takes {} up to {}: {} or check the units", one,
          text(radius), name_of(container), gaps, many, text(largest.known), remedy),
      scene.sizes.locations.whole);
}

double largest_known_radius(const Domain& container, const std::shared_ptr<const Container>& made,
                            double wanted) {
  return closely_largest(container, made, wanted).known;
}

void refuse_thin_container() {
  throw Error(ErrorCode::bad_argument,
              "the container is so thin, and so oblique to the axes, that random places in it are not to be "
              "found: turn it so that its length lies along an axis");
}

double tail_cut(const Scene& scene, const Domain& container, const SizeDistribution& radii,
                const std::shared_ptr<const Container>& made) {
  if (std::isfinite(radii.max())) return radii.max();
  const double median = radii.quantile(0.5), largest = largest_in(container, made).known;
  if (median > largest) require_fitting(scene, container, made, median);
  const auto volume_above = [&](double r) { return radii.moment_above(dimension_of(container), r); };
  const double all = volume_above(0);
  const Frame frame = frame_of(container);
  std::shared_ptr<const Container> local = made;
  std::vector<double> coverable(std::size(cuts), -1);
  const auto fit = [&](double cut) {
    const double volume = all - volume_above(cut);
    for (std::size_t k = 0; k < std::size(cuts); ++k) {
      const double r = cuts[k] * largest;
      const double wanted = r < cut ? (volume_above(r) - volume_above(cut)) / volume : 0;
      if (wanted < negligible) continue;
      if (!local) local = local_container(container, made);
      if (coverable[k] < 0) coverable[k] = coverable_share(*local, r / frame.scale);
      if (filled * wanted > coverable[k]) return false;
    }
    return true;
  };
  double cut = largest;
  for (const double share : cuts) {
    if (share * largest < median) break;
    cut = share * largest;
    if (fit(cut)) break;
  }
  return cut;
}

Frame frame_for(const Scene& scene, const Domain& container, const SizeDistribution& radii) {
  constexpr double resolutions_a_radius = 1e6, rare = 1e-9;
  const Frame frame = frame_of(container);
  const bool ends = radii.min() > 0;
  const double smallest = ends ? radii.min() : radii.quantile(rare);
  const double least = resolutions_a_radius * frame.scale;
  if (least * frame.resolution <= smallest) return frame;
  const std::string_view unit = name_of(scene.unit);
  const double shown = scene.sizes_are_diameters ? 2 : 1;
  const double here = std::numeric_limits<double>::epsilon();  // the resolution beside the origin
  if (least * here > smallest)
    throw Error(ErrorCode::bad_scene,
                fmt::format("the sizes reach down {}: {} {:.2g} {}, {:.0e} of the container, where spheres "
                            "cannot be told apart; {}",
                            ends ? "too far" : "without limit", ends ? "to" : "one in 10^9 is below",
                            shown * smallest, unit, smallest / frame.scale,
                            ends ? "use larger ones or check the units"
                                 : "give the distribution a \"min\", or a smaller spread"),
                scene.sizes.locations.whole);
  throw Error(
      ErrorCode::bad_scene,
      fmt::format("the container is so far from the origin that its coordinates are only good to "
                  "{:.1g} {}, and the smallest sphere measures {:.2g} {}: move it closer or use larger "
                  "spheres",
                  frame.resolution * frame.scale, unit, shown * smallest, unit),
      scene.container.locations.whole);
}

void require_readable_places(const Plan& plan) {
  constexpr double uncertain = 10;  // a box that has not been packed yet
  const Bounds<dynamic> bounds = bounds_of<dynamic>(plan.domain);
  const double farthest = std::max(bounds.upper.cwiseAbs().maxCoeff(), bounds.lower.cwiseAbs().maxCoeff());
  const double most = schema::largest_length / (plan.box_follows ? uncertain : 1);
  if (farthest <= most) return;
  const std::string_view unit = name_of(plan.scene.unit);
  if (plan.box_follows)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("so many of these sizes at such a packing fraction and with such gaps need a box about "
                    "{:.3g} {} long, and more than {:.0e} is not: check the units",
                    farthest, unit, most),
        plan.scene.asks_for_gaps() ? plan.scene.locations.of("gap") : plan.scene.target.where);
  throw Error(
      ErrorCode::bad_scene,
      fmt::format("the container reaches {:.3g} {} from the origin, and farther than {:.0e} no place may be: "
                  "move it, or check the units",
                  farthest, unit, most),
      plan.scene.container.locations.whole);
}

void require_drawable_count(const Plan& plan) {
  constexpr double times_too_many = 1000, cheap_to_draw = 1e7;
  const double asked = plan.scene.target.count ? static_cast<double>(*plan.scene.target.count) : 0;
  if (asked > cheap_to_draw && asked > times_too_many * plan.expected_count)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("{:.3g} spheres are asked for, and about {:.3g} fit: check the units, or ask for a "
                    "packing fraction",
                    asked, plan.expected_count),
        plan.scene.target.where);
}

void require_memory(const Plan& plan) {
  const double there =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const bool too_many = !(plan.expected_count < Supply::most_spheres);
  if (!too_many && plan.expected_memory_bytes <= there) return;
  throw Error(ErrorCode::bad_scene,
              fmt::format("about {:.2g} spheres, {:.3g} GB of memory, where {}: check the units, use larger "
                          "spheres or ask for fewer",
                          plan.expected_count, plan.expected_memory_bytes / 1e9,
                          too_many ? "no more than 2^31 have numbers"
                                   : fmt::format("this machine has {:.3g} GB", there / 1e9)),
              plan.scene.target.where);
}

}  // namespace bernal
