#include "cells/voxel_labels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "measure/power_cells.hpp"
#include "voxels/inside.hpp"

namespace bernal {
namespace {

using Index = std::int64_t;

constexpr std::uint32_t outside = 0xFFFFFFFF, unlabelled = 0;
constexpr std::size_t slab_bytes = std::size_t{64} << 20;
constexpr std::size_t rows_a_tile = 16;
/// Of the reach of a cell: so far beyond a face a centre is taken to lie on it.
constexpr double on_a_face = 1e-12;

/// A cell as planes about its centre, and the box around it, in the lengths of the grid.
struct Planes {
  Vector<3> center, lower, upper;
  std::vector<ConvexCell::Plane> planes;
  double slack = 0;
};

std::vector<Planes> planes_of_cells(const Spheres<dynamic>& spheres, const Domain& domain) {
  const Frame frame = frame_of(domain);
  const Bounds<3> bounds = bounds_of(to_local(domain, frame));
  const CellBox box{dimension_of(domain), bounds, localised(boundary_in_space(domain), frame)};
  std::vector<Planes> all(spheres.size());
  for_each_power_cell(localised(spheres, frame), box, spheres.size(),
                      [&](std::uint32_t i, const Vector<3>& center, const ConvexCell& cell) {
                        if (cell.empty()) return;
                        Planes& made = all[i];
                        made.center = frame.to_scene(center);
                        made.planes = cell.planes();
                        for (ConvexCell::Plane& plane : made.planes) plane.offset *= frame.scale;
                        made.lower = made.upper = cell.corners()[0];
                        for (const Vector<3>& corner : cell.corners()) {
                          made.lower = made.lower.cwiseMin(corner);
                          made.upper = made.upper.cwiseMax(corner);
                        }
                        made.lower *= frame.scale;
                        made.upper *= frame.scale;
                        made.slack = on_a_face * frame.scale * std::sqrt(cell.squared_reach());
                      });
  return all;
}

class LabelImage {
 public:
  LabelImage(const Spheres<dynamic>& spheres, const Domain& domain, const VoxelGrid& grid)
      : grid_(grid), periods_(boundary_in_space(domain).edges), cells_(planes_of_cells(spheres, domain)) {
    if (has_walls(domain)) inside_.emplace(domain, grid);
  }

  /// Layers [first, last), a tile of rows a thread.
  void fill(Index first, Index last, std::uint32_t* layers) const {
    const Index rows = grid_.count[1] * (last - first);
    std::fill_n(layers, rows * grid_.count[0], unlabelled);
    const std::vector<Image> images = images_in(first, last);
    const auto tiles = (static_cast<std::size_t>(grid_.count[1]) + rows_a_tile - 1) / rows_a_tile;
    parallel_for(tiles, [&](std::size_t tile) {
      const auto from = static_cast<Index>(tile * rows_a_tile);
      const Index to = std::min(from + static_cast<Index>(rows_a_tile), grid_.count[1]);
      for (const Image& image : images) draw(image, from, to, first, last, layers);
    });
    if (inside_) cut_off(first, last, layers);
  }

 private:
  struct Image {
    std::uint32_t cell;
    Vector<3> center;
  };

  /// The voxels whose centres are between two coordinates, as far as there are any.
  std::pair<Index, Index> between(int axis, double low, double high) const {
    const auto count = static_cast<double>(grid_.count[static_cast<std::size_t>(axis)]);
    const double first = std::ceil((low - grid_.corner[axis]) / grid_.spacing[axis] - 0.5),
                 last = std::floor((high - grid_.corner[axis]) / grid_.spacing[axis] - 0.5);
    return {static_cast<Index>(std::clamp(first, 0.0, count)),
            static_cast<Index>(std::clamp(last + 1, 0.0, count))};
  }

  /// In the order of the cells, so that the first has what is on a face.
  std::vector<Image> images_in(Index first, Index last) const {
    std::vector<Image> images;
    const double low = grid_.center(2, first), high = grid_.center(2, last - 1);
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      const Planes& cell = cells_[i];
      if (cell.planes.empty()) continue;
      Vector<3> shift;
      const auto reach = [&](int k) { return periods_[k] > 0 ? 1 : 0; };
      for (int z = -reach(2); z <= reach(2); ++z)
        for (int y = -reach(1); y <= reach(1); ++y)
          for (int x = -reach(0); x <= reach(0); ++x) {
            shift = Vector<3>(x, y, z).cwiseProduct(periods_) + cell.center;
            if (grid_.dimension == 3 &&
                (shift[2] + cell.lower[2] > high + cell.slack || shift[2] + cell.upper[2] < low - cell.slack))
              continue;
            images.push_back({i, shift});
          }
    }
    return images;
  }

  void draw(const Image& image, Index from, Index to, Index first, Index last, std::uint32_t* layers) const {
    const Planes& cell = cells_[image.cell];
    const auto rows = between(1, image.center[1] + cell.lower[1] - cell.slack,
                              image.center[1] + cell.upper[1] + cell.slack);
    auto depths = between(2, image.center[2] + cell.lower[2] - cell.slack,
                          image.center[2] + cell.upper[2] + cell.slack);
    if (grid_.dimension == 2) depths = {0, 1};
    for (Index k = std::max(first, depths.first); k < std::min(last, depths.second); ++k)
      for (Index j = std::max(from, rows.first); j < std::min(to, rows.second); ++j) {
        const double y = grid_.center(1, j) - image.center[1],
                     z = grid_.dimension == 2 ? 0 : grid_.center(2, k) - image.center[2];
        double low = cell.lower[0] - cell.slack, high = cell.upper[0] + cell.slack;
        for (const ConvexCell::Plane& plane : cell.planes) {
          const double room = plane.offset + cell.slack - plane.normal[1] * y - plane.normal[2] * z;
          if (plane.normal[0] > 0)
            high = std::min(high, room / plane.normal[0]);
          else if (plane.normal[0] < 0)
            low = std::max(low, room / plane.normal[0]);
          else if (room < 0)
            high = -std::numeric_limits<double>::infinity();
        }
        if (!(low <= high)) continue;
        const auto run = between(0, image.center[0] + low, image.center[0] + high);
        std::uint32_t* const row = layers + ((k - first) * grid_.count[1] + j) * grid_.count[0];
        for (Index x = run.first; x < run.second; ++x)
          if (row[x] == unlabelled) row[x] = image.cell + 1;
      }
  }

  void cut_off(Index first, Index last, std::uint32_t* layers) const {
    const Index layer = grid_.count[0] * grid_.count[1];
    parallel_for(static_cast<std::size_t>(last - first), [&](std::size_t k) {
      std::uint32_t* const voxels = layers + static_cast<Index>(k) * layer;
      std::vector<InsideRun> runs;
      inside_->layer(first + static_cast<Index>(k), runs);
      Index done = 0;
      std::ranges::sort(runs, {}, [](const InsideRun& run) { return std::pair(run.row, run.first); });
      for (const InsideRun& run : runs) {
        const Index begin = run.row * grid_.count[0] + run.first;
        if (begin > done) std::fill(voxels + done, voxels + begin, outside);
        done = std::max(done, run.row * grid_.count[0] + run.last + 1);
      }
      std::fill(voxels + done, voxels + layer, outside);
    });
  }

  const VoxelGrid& grid_;
  Vector<3> periods_;
  std::vector<Planes> cells_;
  std::optional<InsideOfDomain> inside_;
};

}  // namespace

void label_cells(const Spheres<dynamic>& spheres, const Domain& domain, const VoxelGrid& grid,
                 const TakeLayers& take, const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  const LabelImage image(spheres, domain, grid);
  const Index layer = grid.count[0] * grid.count[1];
  const Index deep =
      std::max<Index>(1, static_cast<Index>(slab_bytes / sizeof(std::uint32_t)) / std::max<Index>(layer, 1));
  std::vector<std::uint32_t> layers;
  for (Index first = 0; first < grid.count[2]; first += deep) {
    const Index last = std::min(first + deep, grid.count[2]);
    layers.resize(static_cast<std::size_t>((last - first) * layer));
    image.fill(first, last, layers.data());
    take({reinterpret_cast<const char*>(layers.data()), layers.size() * sizeof(std::uint32_t)});
  }
}

}  // namespace bernal
