#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "core/lower_case.hpp"
#include "files/sha256.hpp"
#include "plan/start.hpp"
#include "scene/complete_sizes.hpp"
#include "scene/given_files.hpp"
#include "scene/read_spheres.hpp"
#include "scene/stage_table.hpp"
#include "scene/unpublished.hpp"
#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse(const Scene& scene, std::string_view key, const std::string& why) {
  throw Error(ErrorCode::bad_scene, why, scene.locations.of(key));
}

std::vector<double> edges_of(const PeriodicBox& box) {
  if (!box.edge) return box.size;
  return std::vector<double>(static_cast<std::size_t>(box.dimension), *box.edge);
}

/// What a packing has besides its spheres, where the scene that begins from them does not say it again.
std::string left_out_of(const Scene& there, const Scene& scene) {
  std::vector<std::string_view> parts;
  if (!there.inside.empty() && scene.inside.empty()) parts.push_back("what lies inside of them");
  if (has_layers(there) && !has_layers(scene)) parts.push_back("their layers");
  if (!classes_of(there).empty() && classes_of(scene).empty()) parts.push_back("their classes");
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Tilts of a box whose edges have become others.
std::vector<double> carried_tilt(const PeriodicBox& box, const std::vector<double>& edges) {
  std::vector<double> tilt = box.tilt;
  const std::vector<double> before = edges_of(box);
  for (std::size_t k = 0; k < tilt.size(); ++k) {
    const std::size_t axis = k < 2 ? 0 : 1;
    tilt[k] *= edges[axis] / before[axis];
  }
  return tilt;
}

/// That a packing has a tilt in the proportions of the container's.
void require_tilt_of_start(const Scene& scene, const PeriodicBox& there, double in_our_unit) {
  constexpr double rounding = 1e-9;
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  const std::vector<double>& edges = scene.start.box;
  if (!box || box->dimension != there.dimension || edges.empty()) return;
  const std::vector<double> ours = edges_of(*box).empty() ? box->tilt : carried_tilt(*box, edges);
  for (std::size_t k = 0; k < 3; ++k) {
    const double stated = k < ours.size() ? ours[k] : 0;
    const double of_start = k < there.tilt.size() ? in_our_unit * there.tilt[k] : 0;
    if (std::abs(stated - of_start) <= rounding * std::ranges::max(edges)) continue;
    if (std::ranges::all_of(there.tilt, [](double length) { return length == 0; }))
      refuse(scene, "start",
             "the box of the start is upright, and the container is tilted; leave its \"tilt\" out");
    std::vector<double> tilt = there.tilt;
    for (double& length : tilt) length *= in_our_unit;
    refuse(scene, "start",
           fmt::format("the box of the start is tilted otherwise than the container: {:.10g}; give the "
                       "container that \"tilt\"",
                       fmt::join(tilt, ", ")));
  }
}

/// Of a packing, in a folder or in none, its spheres are meant, and the box that they lie in. Returns what is
/// left out.
std::string look_into_packing(Scene& scene) {
  Start& start = scene.start;
  std::error_code unknown;
  if (!start.packing && !std::filesystem::is_directory(*start.file, unknown)) return {};
  const Scene there = start.packing ? start.packing->scene : scene_in(*start.file);
  const double in_our_unit = conversion_factor(there.unit, scene.unit);
  if (const auto* box = std::get_if<PeriodicBox>(&there.container); box && start.box.empty()) {
    for (const double edge : edges_of(*box)) start.box.push_back(in_our_unit * edge);
    require_tilt_of_start(scene, *box, in_our_unit);
  }
  if (!start.unit) start.unit = there.unit;
  if (!start.packing) *start.file = only_spheres_file_in(*start.file);
  return left_out_of(there, scene);
}

/// The spheres as they stand there, and the digest of the very bytes that they come from.
std::pair<NamedColumns, std::string> spheres_of(const Scene& scene) {
  const Start& start = scene.start;
  if (start.packing)
    return {{start.packing->spheres, {}, 1}, sha256_of_bytes(*content_given(scene, *start.file))};
  Sha256 digest;
  NamedColumns read =
      read_spheres(where_it_stands(*start.file), [&](std::string_view bytes) { digest.add(bytes); });
  return {std::move(read), digest.digits()};
}

/// The box that the spheres lie in, where it repeats itself.
void complete_box(Scene& scene) {
  auto* box = std::get_if<PeriodicBox>(&scene.container);
  std::vector<double>& edges = scene.start.box;
  if (!box) {
    edges.clear();
    return;
  }
  if (edges.empty()) edges = edges_of(*box);
  if (edges.empty())
    refuse(scene, "start",
           "the start does not say how large its periodic box is: give \"start_box\" in [spheres], or the "
           "\"size\" of the container with scalable = true");
  if (static_cast<int>(edges.size()) != box->dimension)
    refuse(scene, "start",
           fmt::format("the box of the start has {} dimension{}, but the scene has {}", edges.size(),
                       edges.size() == 1 ? "" : "s", box->dimension));
  if (box->scalable) {
    if (!box->tilt.empty()) box->tilt = carried_tilt(*box, edges);
    box->size = edges;
    box->edge.reset();
  } else if (table_of(scene.stages.front()).traits.stands_in_bed(scene) && edges != edges_of(*box)) {
    refuse(scene, scene.locations.keys.contains("start_box") ? "start_box" : "start",
           fmt::format("the box of the start, {} {}, is not the container, {}, whose walls stay where they "
                       "are: give the container that size",
                       fmt::format("{:.10g}", fmt::join(edges, " x ")), name_of(scene.unit),
                       fmt::format("{:.10g}", fmt::join(edges_of(*box), " x "))));
  }
}

void pin_digest(Scene& scene, const std::string& digest) {
  Start& start = scene.start;
  if (!start.sha256.empty() && in_lower_case(start.sha256.front()) != digest)
    refuse(scene, "start_sha256",
           fmt::format("{} is not the file that is meant: its SHA-256 is {}; leave \"start_sha256\" out to "
                       "take it as it is",
                       start.file->string(), digest));
  start.sha256 = {digest};
}

void complete_count(Scene& scene, std::size_t there) {
  complete_count_of_list(scene, there);
  std::optional<std::int64_t>& count = scene.target.count;
  const auto n = static_cast<std::int64_t>(there);
  if (!count && !scene.draws()) count = n;
  if (!count || *count == n) return;
  if (*count < n)
    refuse(scene, "count",
           fmt::format("the start has {} spheres, and \"count\", which is of all, says {}", grouped(there),
                       grouped(static_cast<std::uint64_t>(*count))));
  if (!scene.draws())
    refuse(scene, "count",
           fmt::format("the start has only {} spheres, and there are no sizes to draw others from: give "
                       "\"diameter\" or \"radius\" in [spheres] too",
                       grouped(there)));
}

}  // namespace

StartSpheres read_start(Scene& scene) {
  if (!scene.start.file) return {};
  std::error_code unknown;
  if (!scene.start.packing && !std::filesystem::exists(*scene.start.file, unknown))
    refuse(scene, "start",
           fmt::format("there is no file or folder {}; its name is relative to the scene's file",
                       scene.start.file->string()));
  const std::string left_out = look_into_packing(scene);
  Start& start = scene.start;
  auto [read, digest] = spheres_of(scene);
  const std::string file = start.file->string();
  if (!read.unit.empty() && start.unit && read.unit != name_of(*start.unit))
    refuse(scene, "start_unit",
           fmt::format("{} says itself that it is in {}; leave \"start_unit\" out", file, read.unit));
  if (!read.unit.empty()) start.unit = unit_named(read.unit);
  const int dimension = read.spheres.dimension();
  if (dimension != scene.dimension())
    refuse(scene, "start",
           fmt::format("the spheres of {} have {} dimension{}, but the scene has {}", file, dimension,
                       dimension == 1 ? "" : "s", scene.dimension()));
  if (read.spheres.empty()) throw Error(ErrorCode::bad_packing, "there are no spheres in it", {file});
  pin_digest(scene, digest);
  complete_box(scene);
  complete_count(scene, read.spheres.size());
  if (!scene.draws()) scene.sizes.locations.whole = scene.locations.of("start");

  const double factor = conversion_factor(start.unit.value_or(scene.unit), scene.unit);
  StartSpheres made{std::move(read.spheres), {}, file, read.first_line, left_out};
  if (factor != 1) {
    for (auto& column : made.spheres.x)
      for (double& x : column) x *= factor;
    for (double& r : made.spheres.r) r *= factor;
  }
  start.unit = start.unit.value_or(scene.unit);
  if (!start.box.empty()) made.edges = Eigen::Map<const Eigen::VectorXd>(start.box.data(), dimension);
  return made;
}

std::unique_ptr<SizeDistribution> radii_there(const std::vector<double>& radii) {
  std::map<double, double> counts;
  for (const double r : radii) counts[r] += 1;
  std::vector<double> sizes, shares;
  for (const auto& [size, count] : counts) {
    sizes.push_back(size);
    shares.push_back(count);
  }
  if (sizes.size() == 1) return make_constant(sizes.front());
  return make_classes(std::move(sizes), std::move(shares), Basis::number);
}

SceneRadii asked_radii_of(const Scene& scene, std::size_t count) {
  SceneRadii made;
  if (!scene.zones.empty()) return made;  // each has sizes of its own
  if (scene.cells) return made;           // sizes are what the cells make of them
  Scene copy = scene;
  try {
    made.first = read_start(copy).spheres.r;
    if (scene.draws()) made.drawn = radii_of(scene);
  } catch (const Error&) {
    return {};
  }
  if (made.first.empty()) {
    made.all = std::move(made.drawn);
  } else if (made.drawn && count > made.first.size()) {
    std::vector<std::unique_ptr<SizeDistribution>> parts;
    parts.push_back(radii_there(made.first));
    parts.push_back(radii_of(scene));
    made.all =
        make_mixture(std::move(parts),
                     {static_cast<double>(made.first.size()), static_cast<double>(count - made.first.size())},
                     Basis::number);
  } else {
    made.all = radii_there(made.first);
  }
  const SizeDistribution& drawn = made.drawn ? *made.drawn : *made.all;
  const Draw draw = scene.draw.value_or(usual_draw(
      drawn, static_cast<double>(count) - static_cast<double>(made.first.size()), scene.dimension()));
  made.asked = {made.all.get(), scene.seed, draw, made.drawn.get(), made.first};
  return made;
}

SceneRadii asked_radii_of(const Packing& packing) {
  if (packing.outcome == Outcome::imported) return {};
  SceneRadii made = asked_radii_of(packing.scene, packing.spheres.size());
  made.asked.seed = packing.seed;
  return made;
}

}  // namespace bernal
