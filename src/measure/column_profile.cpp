#include "bernal/measure/column_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "measure/slices.hpp"
#include "measure/volume_in.hpp"

namespace bernal {
namespace {

constexpr double rounding_of_slices = 1e-6;
constexpr double rounding_of_axes = 1e-9;
constexpr double most_of_height = 0.25;  // left out at either end

/// The axis of a column, of unit length; the side that faces against gravity is up.
Vector<3> axis_of(const Domain& domain, const Vector<3>& up) {
  Vector<3> axis = up;
  if (const auto* cylinder = std::get_if<Cylinder>(&domain)) axis = cylinder->axis.normalized();
  if (const auto* revolved = std::get_if<Revolved>(&domain)) axis = revolved->axis.normalized();
  if (std::holds_alternative<Box>(domain)) {
    int nearest = 2;
    for (const int k : {1, 0})
      if (std::abs(up[k]) > std::abs(up[nearest])) nearest = k;
    axis = Vector<3>::Unit(nearest);
  }
  return axis.dot(up) < 0 ? Vector<3>(-axis) : axis;
}

/// Boxes and cylinders have flat ends along their own axes.
bool has_flat_ends(const Domain& domain, const Vector<3>& axis) {
  if (const auto* cylinder = std::get_if<Cylinder>(&domain))
    return std::abs(cylinder->axis.normalized().dot(axis)) > 1 - rounding_of_axes;
  return std::holds_alternative<Box>(domain) && axis.cwiseAbs().maxCoeff() > 1 - rounding_of_axes;
}

/// The same walls around the axis, with the ends moved so far out that nothing between them is near. Absent
/// where there are none.
std::optional<Domain> without_ends(const Domain& domain, const Vector<3>& axis) {
  if (!has_flat_ends(domain, axis)) return {};
  const double far = 2 * bounds_of(domain).diagonal();
  if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    Cylinder longer = *cylinder;
    longer.base -= far * cylinder->axis.normalized();
    longer.height += 2 * far;
    return longer;
  }
  if (const auto* box = std::get_if<Box>(&domain)) {
    Box longer = *box;
    bool has_side = false;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(axis[k]) > 0.5) {
        longer.corner[k] -= far;
        longer.size[k] += 2 * far;
      } else {
        has_side = has_side || box->has_wall(k);
      }
    }
    if (has_side) return longer;
  }
  return {};
}

std::vector<double> porosities_from(const Spheres<3>& spheres, const VolumeBelow& below, const Vector<3>& up,
                                    double from, double thickness, std::size_t layers) {
  // One more on either side takes what is beyond.
  const std::vector<double> filled = filled_slices(spheres, 3, up, from - thickness, thickness, layers + 2);
  std::vector<double> level(layers + 1), porosities(layers);
  parallel_for(layers + 1,
               [&](std::size_t k) { level[k] = below(from + static_cast<double>(k) * thickness); });
  for (std::size_t k = 0; k < layers; ++k) {
    const double room = level[k + 1] - level[k];
    porosities[k] = room > 0 ? 1 - filled[k + 1] / room : 1;
  }
  return porosities;
}

}  // namespace

std::optional<ColumnProfile> column_profile(const Spheres<dynamic>& packed, const Domain& domain,
                                            const ColumnOptions& options) {
  if (dimension_of(domain) != 3 || packed.empty()) return {};
  const Vector<3> up = -options.down.value_or(-Vector<3>::UnitZ()).normalized();
  const Vector<3> axis = options.slab ? Vector<3>(-options.slab->direction) : axis_of(domain, up);
  if (!has_ends_along(domain, axis)) return {};
  const Frame frame = frame_of(domain);
  const Spheres<3> spheres = localised(packed, frame);
  const VolumeBelow below(to_local(domain, frame), -axis);
  const double diameter =
      2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
  const double floor = below.lowest(), lid = below.highest() - floor;
  // A level across another direction than the axis does not end the column.
  const bool has_level = !options.slab && options.level && axis.dot(up) > 1 - rounding_of_slices;
  double bottom = 0, top = has_level ? *options.level / frame.scale : lid;
  if (options.slab) {
    const LowerPart slab = options.slab->to_local(frame);
    const double rounding = rounding_of_slices * diameter;
    if (slab.from - floor > rounding) bottom = slab.from - floor;
    if (lid - (slab.height - floor) > rounding) top = slab.height - floor;
    if (!(bottom < top)) return {};
  }

  ColumnProfile profile;
  profile.axis = axis;
  profile.mean_diameter = frame.scale * diameter;
  profile.bottom = frame.scale * bottom;
  profile.top = frame.scale * top;
  profile.has_lid = !has_level && top == lid;
  const double high = top - bottom;
  const double usual = std::max(options.layer * diameter, high / static_cast<double>(options.most_layers));
  const double slices = std::max(1.0, std::ceil(high / usual - rounding_of_slices));
  const double thickness = options.slab ? high / slices : usual;
  const auto layers = static_cast<std::size_t>(slices);
  const std::vector<double> upwards =
      porosities_from(spheres, below, axis, floor + bottom, thickness, layers);
  for (std::size_t k = 0; k < layers; ++k) {
    const double from = bottom + static_cast<double>(k) * thickness;
    const double to = has_level ? from + thickness : std::min(from + thickness, top);
    profile.along.push_back({frame.scale * from, frame.scale * to, upwards[k]});
  }
  if (has_flat_ends(domain, axis)) {
    const auto in_scene = [&](std::optional<WallProfile::Minimum> least) {
      if (least) least->z *= frame.scale;
      return least;
    };
    if (bottom == 0) profile.floor_minimum = in_scene(first_minimum(upwards, thickness, diameter));
    std::vector<double> down_from_lid = porosities_from(
        spheres, below, axis, floor + top - static_cast<double>(layers) * thickness, thickness, layers);
    std::ranges::reverse(down_from_lid);
    if (profile.has_lid) profile.lid_minimum = in_scene(first_minimum(down_from_lid, thickness, diameter));
  }
  if (const auto around = without_ends(domain, axis)) {
    const double left_out =
        options.slab ? 0 : std::min(ColumnProfile::end_depth * diameter, most_of_height * top);
    const auto in_scene = [&](double height) {
      return frame.scale * (floor + height) + axis.dot(frame.origin);
    };
    WallOptions of_side = options.side;
    of_side.below = LowerPart{-axis, in_scene(top - left_out), in_scene(bottom + left_out)};
    if (auto side = wall_profile(packed, *around, of_side))
      profile.side = {frame.scale * (bottom + left_out), frame.scale * (top - left_out), std::move(*side)};
  }
  return profile;
}

}  // namespace bernal
