#include "meshes/sections.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <thread>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "bernal/core/error.hpp"
#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "meshes/section_surface.hpp"
#include "meshes/triangle_sides.hpp"

namespace bernal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t most_meshers = 4;  // at once
constexpr auto nothing = SurfacePatch::nothing;

/// Faces of tetrahedra that were kept which lie inside of the bed. Their normals point out of these.
struct FreeFace {
  FaceCorners corners;
  std::int32_t region;
};

/// What is kept of a section, or all of it.
struct Section {
  PartOfSurface part;
  VolumeMesh mesh;  ///< its regions are those of the surface
  std::vector<FreeFace> faces;
  std::vector<std::array<std::uint32_t, 2>> filled;  ///< triangles of the part, and their sides
  double peak_bytes = 0;
};

/// Gives tetrahedra with all corners in the interval the regions that triangles say, and takes the others
/// away, with those that no triangle tells about.
void keep_between(Section& section, int axis, double low, double high) {
  VolumeMesh& mesh = section.mesh;
  const std::size_t count = mesh.tetrahedra.size();
  const auto sides = found_sides(mesh);
  const auto behind = neighbours_of(mesh);
  std::vector<std::array<bool, 4>> is_triangle(count, {false, false, false, false});
  for (const auto& of_triangle : sides)
    for (const TriangleSide& side : of_triangle)
      if (side.is_there()) is_triangle[side.tetrahedron][side.face] = true;
  std::vector<std::uint8_t> inside(count, 0);
  for (std::size_t t = 0; t < count; ++t)
    inside[t] = std::ranges::all_of(mesh.tetrahedra[t], [&](std::uint32_t corner) {
      return mesh.vertices[corner][axis] >= low && mesh.vertices[corner][axis] <= high;
    });
  const auto goes_on = [&](std::uint32_t t, std::size_t k) {
    return !is_triangle[t][k] && behind[t][k] != TriangleSide::none && inside[behind[t][k]];
  };
  DisjointSets parts(count);
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 4 && inside[t]; ++k)
      if (goes_on(t, k)) parts.unite(t, behind[t][k]);
  constexpr std::int32_t unknown = -2;
  std::vector<std::int32_t> region(count, unknown);
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const std::size_t side : {0, 1}) {
      const TriangleSide& at = sides[i][side];
      if (!at.is_there() || !inside[at.tetrahedron]) continue;
      std::int32_t& of_part = region[parts.find(at.tetrahedron)];
      const std::int32_t said = mesh.patches[mesh.patch[i]].regions[side];
      if (of_part != unknown && of_part != said)
        throw Error(ErrorCode::bad_mesh,
                    "a section of the mesh has two regions in one: is the surface closed?");
      of_part = said;
    }
  for (std::uint32_t t = 0; t < count; ++t) {
    inside[t] = inside[t] && region[parts.find(t)] >= 0;
    if (inside[t]) mesh.region[t] = static_cast<std::uint32_t>(region[parts.find(t)]);
  }
  for (std::uint32_t i = 0; i < sides.size(); ++i)
    for (std::uint32_t side : {0U, 1U})
      if (sides[i][side].is_there() && inside[sides[i][side].tetrahedron])
        section.filled.push_back({i, side});
  std::size_t kept = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!inside[t]) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (!is_triangle[t][k] && !goes_on(t, k))
        section.faces.push_back({face_of(mesh, t, k), static_cast<std::int32_t>(mesh.region[t])});
    mesh.tetrahedra[kept] = mesh.tetrahedra[t];
    mesh.region[kept++] = mesh.region[t];
  }
  mesh.tetrahedra.resize(kept);
  mesh.region.resize(kept);
}

class SectionFiller {
 public:
  SectionFiller(const ConformingSurface& surface, const SectionCuts& cuts, const TetgenOptions& options,
                const Monitor& monitor)
      : surface_(surface), cuts_(cuts), options_(options), monitor_(monitor), parts_(surface, cuts.axis) {
    mesh_.vertices = surface.vertices;
    is_filled_.resize(surface.triangles.size(), {false, false});
  }

  VolumeMesh run(double& peak_bytes) {
    fill_every_second(0, [&](std::size_t s) { return free_section(s); });
    fill_every_second(1, [&](std::size_t s) { return closed_section(s); });
    peak_bytes = peak_bytes_;
    mesh_.triangles = surface_.triangles;
    mesh_.patch = surface_.patch;
    mesh_.patches = surface_.patches;
    mesh_.regions = surface_.regions;
    mesh_.periodic = surface_.periodic;
    return std::move(mesh_);
  }

 private:
  double low_of(std::size_t s) const { return s == 0 ? -infinity : cuts_.at[s - 1]; }
  double high_of(std::size_t s) const { return s == cuts_.at.size() ? infinity : cuts_.at[s]; }
  double middle_of(std::size_t s) const {
    const double low = low_of(s), high = high_of(s);
    return std::isfinite(low) && std::isfinite(high) ? (low + high) / 2 : std::isfinite(low) ? high : low;
  }
  double place_of(const FaceCorners& c) const {
    return (mesh_.vertices[c[0]][cuts_.axis] + mesh_.vertices[c[1]][cuts_.axis] +
            mesh_.vertices[c[2]][cuts_.axis]) /
           3;
  }

  /// Fills the sections from `first` by twos, and then takes them over in their order.
  template <class Fill>
  void fill_every_second(std::size_t first, const Fill& fill) {
    std::vector<Section> made((cuts_.count() - first + 1) / 2);
    say_done();
    const std::thread::id caller = std::this_thread::get_id();
    const auto threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const std::size_t at_once = std::min({most_meshers, threads, made.size()});
    tbb::task_arena arena(static_cast<int>(at_once));
    arena.execute([&] {
      parallel_for(made.size(), [&](std::size_t k) {
        made[k] = fill(first + 2 * k);
        ++done_;
        if (std::this_thread::get_id() == caller) say_done();
      });
    });
    std::vector<double> peaks;
    for (const Section& section : made) peaks.push_back(section.peak_bytes);
    std::ranges::sort(peaks, std::greater());
    double peak_bytes = 0;
    for (std::size_t k = 0; k < at_once; ++k) peak_bytes += peaks[k];
    peak_bytes_ = std::max(peak_bytes_, peak_bytes);
    for (std::size_t k = 0; k < made.size(); ++k) {
      take_over(made[k], first + 2 * k);
      made[k] = {};
    }
  }

  void say_done() const {
    monitor_.report({"fill", 0.95 * static_cast<double>(done_) / static_cast<double>(cuts_.count()),
                     fmt::format("{} of {} sections", done_.load(), cuts_.count())});
  }

  Section free_section(std::size_t s) const {
    Section section;
    section.part = parts_.near(low_of(s), high_of(s));
    section.mesh = run_tetgen(section.part.surface, options_, section.peak_bytes, quiet());
    keep_between(section, cuts_.axis, low_of(s), high_of(s));
    return section;
  }

  Section closed_section(std::size_t s) const {
    Section section;
    const double low = middle_of(s - 1), high = s + 1 < cuts_.count() ? middle_of(s + 1) : infinity;
    PartBuilder builder(mesh_.vertices);
    ConformingSurface& part = builder.part().surface;
    part.patches = surface_.patches;
    part.regions = surface_.regions;
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> half_filled;  // by patch and side
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
      std::array<std::int32_t, 2> regions = surface_.patches[surface_.patch[t]].regions;
      std::uint32_t patch = surface_.patch[t];
      for (const std::uint32_t side : {0U, 1U})
        if (is_filled_[t][side] && regions[side] != nothing) {
          regions[side] = nothing;
          const auto [entry, is_new] = half_filled.try_emplace({patch, side}, 0);
          if (is_new) {
            entry->second = static_cast<std::uint32_t>(part.patches.size());
            part.patches.push_back(part.patches[patch]);
            part.patches.back().regions = regions;
          }
          patch = entry->second;
        }
      if (regions[0] == nothing && regions[1] == nothing) continue;
      const double place = place_of(surface_.triangles[t]);
      if (place >= low && place < high) {
        builder.add(surface_.triangles[t], patch);
        builder.part().triangles.push_back(t);
      }
    }
    std::map<std::int32_t, std::uint32_t> of_free_faces;  // patch by region
    for (const std::size_t beside : {s - 1, s + 1})
      if (beside < cuts_.count())
        for (const FreeFace& face : faces_[beside])
          if (const double place = place_of(face.corners); place >= low && place < high) {
            const auto [entry, is_new] = of_free_faces.try_emplace(face.region, 0);
            if (is_new) {
              entry->second = static_cast<std::uint32_t>(part.patches.size());
              part.patches.push_back(
                  {.kind = SurfacePatch::Kind::period_end, .regions = {nothing, face.region}});
            }
            builder.add(face.corners, entry->second);
          }
    section.part = std::move(builder.part());
    section.mesh = run_tetgen(section.part.surface, options_, section.peak_bytes, quiet());
    take_regions_of_triangles(section.mesh);
    return section;
  }

  /// For what runs beside others: it may be told to stop, and reports nothing.
  Monitor quiet() const { return {.on_progress = {}, .cancelled = monitor_.cancelled}; }

  void take_over(Section& section, std::size_t s) {
    std::vector<std::uint32_t> number = section.part.vertex;
    number.resize(section.mesh.vertices.size(), not_of_whole);
    const auto numbered = [&](auto corners) {
      for (std::uint32_t& corner : corners) {
        if (number[corner] == not_of_whole) {
          number[corner] = static_cast<std::uint32_t>(mesh_.vertices.size());
          mesh_.vertices.push_back(section.mesh.vertices[corner]);
        }
        corner = number[corner];
      }
      return corners;
    };
    for (const TetrahedronCorners& corners : section.mesh.tetrahedra)
      mesh_.tetrahedra.push_back(numbered(corners));
    mesh_.region.insert(mesh_.region.end(), section.mesh.region.begin(), section.mesh.region.end());
    for (const auto& [triangle, side] : section.filled)
      if (triangle < section.part.triangles.size()) is_filled_[section.part.triangles[triangle]][side] = true;
    if (faces_.size() <= s) faces_.resize(s + 1);
    for (const FreeFace& face : section.faces) faces_[s].push_back({numbered(face.corners), face.region});
  }

  const ConformingSurface& surface_;
  const SectionCuts& cuts_;
  const TetgenOptions& options_;
  const Monitor& monitor_;
  SurfaceParts parts_;
  VolumeMesh mesh_;
  std::vector<std::array<bool, 2>> is_filled_;  ///< of each triangle, by side
  std::vector<std::vector<FreeFace>> faces_;    ///< by section
  double peak_bytes_ = 0;
  std::atomic<std::size_t> done_ = 0;
};

}  // namespace

SectionCuts section_cuts(const ConformingSurface& surface, std::size_t most_triangles) {
  const std::size_t triangles = surface.triangles.size();
  SectionCuts cuts;
  if (triangles <= most_triangles) return cuts;
  Vector<3> low = surface.vertices[0], high = low;
  for (const Vector<3>& p : surface.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  (high - low).maxCoeff(&cuts.axis);
  const double extent = (high - low)[cuts.axis];
  const double thinnest = 2 * SurfaceParts(surface, cuts.axis).largest_extent();
  std::size_t count = (triangles + most_triangles - 1) / most_triangles | 1;
  if (thinnest > 0) count = std::min(count, static_cast<std::size_t>(std::min(1e6, extent / thinnest)));
  if (count < 3) return cuts;
  count = count % 2 == 1 ? count : count - 1;
  std::vector<double> places(triangles);
  for (std::size_t t = 0; t < triangles; ++t)
    places[t] = surface.vertices[surface.triangles[t][0]][cuts.axis];
  for (std::size_t k = 1; k < count; ++k) {
    const auto at = places.begin() + static_cast<std::ptrdiff_t>(k * triangles / count);
    std::ranges::nth_element(places, at);
    const double least = cuts.at.empty() ? low[cuts.axis] + thinnest : cuts.at.back() + thinnest;
    if (*at < least) continue;
    cuts.at.push_back(*at);
  }
  while (!cuts.at.empty() && (cuts.at.back() > high[cuts.axis] - thinnest || cuts.at.size() % 2 == 1))
    cuts.at.pop_back();
  return cuts;
}

VolumeMesh fill_in_sections(const ConformingSurface& surface, const SectionCuts& cuts,
                            const TetgenOptions& options, double& peak_bytes, const Monitor& monitor) {
  return SectionFiller(surface, cuts, options, monitor).run(peak_bytes);
}

}  // namespace bernal
