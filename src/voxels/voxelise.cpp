#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/voxels/voxels.hpp"
#include "core/parallel.hpp"
#include "voxels/ball_in_cells.hpp"
#include "voxels/inside.hpp"

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes below are handed over as they lie");

using Index = std::int64_t;

constexpr std::size_t slab_bytes = std::size_t{64} << 20;
/// The work of a ball's fractions in a slab besides its voxels, that of the planes along z, is shared by its
/// layers: a slab has at least this many, up to this size.
constexpr Index layers_of_sums = 8;
constexpr std::size_t slab_bytes_of_sums = std::size_t{512} << 20;
/// A tile fits a core's own cache; sums of fractions have eight bytes and more work at the edges of tiles, so
/// their tiles are larger.
constexpr Index tile_bytes = Index{1} << 20, tile_bytes_of_sums = Index{4} << 20;

/// An image of a sphere, or of a ball within it.
struct Ball {
  Vector<3> center;
  double radius;
  double weight;        ///< in a sum of fractions
  std::uint32_t value;  ///< of a voxel
};

/// Voxels [first, last) along an axis.
struct Span {
  Index first, last;
  bool empty() const { return first >= last; }
};

/// Rows and layers for one thread.
struct Tile {
  Span y, z;
};

class Image {
 public:
  Image(const Spheres<dynamic>& spheres, const Domain& domain, const VoxelGrid& grid, VoxelValues values,
        const VoxelLayers& layers)
      : spheres_(spheres),
        grid_(grid),
        periods_(boundary_in_space(domain).edges),
        values_(values),
        layers_(layers) {
    if (has_walls(domain)) inside_.emplace(domain, grid);
  }

  /// Fills the layers of z with T, an unsigned integer or float.
  template <class T>
  void fill(Span z, T* layers) const {
    const std::vector<Ball> balls = balls_in(z);
    if constexpr (std::integral<T>) fill_walls(z, layers);
    constexpr bool sums = std::floating_point<T>;
    const std::vector<Tile> tiles =
        tiles_of(z, (sums ? tile_bytes_of_sums : tile_bytes) /
                        (grid_.count[0] * static_cast<Index>(sums ? sizeof(double) : sizeof(T))));
    parallel_for(tiles.size(), [&](std::size_t t) {
      if constexpr (sums) {
        sum_tile(tiles[t], z.first, balls, layers);
      } else {
        label_tile(tiles[t], z.first, balls, layers);
      }
    });
  }

 private:
  Index row_length() const { return grid_.count[0]; }
  Index layer_length() const { return grid_.count[0] * grid_.count[1]; }

  /// All images that reach into these layers of the grid, in the order of the spheres.
  std::vector<Ball> balls_in(Span z) const {
    Vector<3> lower, upper;
    for (int k = 0; k < 3; ++k) {
      const bool layers = k == 2;
      lower[k] = grid_.plane(k, layers ? z.first : 0);
      upper[k] = grid_.plane(k, layers ? z.last : grid_.count[static_cast<std::size_t>(k)]);
    }
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.r[i];
      Vector<3> center = Vector<3>::Zero(), first = Vector<3>::Zero(), last = Vector<3>::Zero();
      bool reaches = true;
      for (int k = grid_.dimension - 1; k >= 0 && reaches; --k) {
        center[k] = spheres_.x[static_cast<std::size_t>(k)][i];
        if (periods_[k] > 0) {
          first[k] = std::ceil((lower[k] - r - center[k]) / periods_[k]);
          last[k] = std::floor((upper[k] + r - center[k]) / periods_[k]);
          reaches = first[k] <= last[k];
        } else {
          reaches = center[k] + r >= lower[k] && center[k] - r <= upper[k];
        }
      }
      if (!reaches) continue;
      Vector<3> shift;
      for (shift[2] = first[2]; shift[2] <= last[2]; ++shift[2])
        for (shift[1] = first[1]; shift[1] <= last[1]; ++shift[1])
          for (shift[0] = first[0]; shift[0] <= last[0]; ++shift[0])
            add_balls(center + Vector<3>(shift.cwiseProduct(periods_)), i, balls);
    }
    return balls;
  }

  /// One for the sphere, or one for each of its layers, from the centre out.
  void add_balls(const Vector<3>& center, std::size_t i, std::vector<Ball>& balls) const {
    const bool has_layers =
        !layers_.first.empty() && values_ != VoxelValues::binary && values_ != VoxelValues::labels;
    if (!has_layers) {
      balls.push_back(
          {center, spheres_.r[i], 1, values_ == VoxelValues::labels ? static_cast<std::uint32_t>(i + 1) : 1});
      return;
    }
    for (std::size_t k = layers_.first[i]; k < layers_.first[i + 1]; ++k) {
      const std::uint8_t value = layers_.value[k],
                         next = k + 1 < layers_.first[i + 1] ? layers_.value[k + 1] : 0;
      const double weight = static_cast<double>(value > 0) - static_cast<double>(next > 0);
      if (values_ == VoxelValues::fraction && weight == 0) continue;
      balls.push_back({center, layers_.outer[k], weight, value});
    }
  }

  /// The value of a voxel outside the container.
  template <class T>
  T outside() const {
    constexpr std::uint8_t of_binary = 2;
    return values_ == VoxelValues::binary ? T{of_binary} : static_cast<T>(~T{0});
  }

  /// Tiles of about `rows` rows.
  std::vector<Tile> tiles_of(Span z, Index rows) const {
    rows = std::max<Index>(rows, 1);
    const Index deep = std::min(z.last - z.first,
                                static_cast<Index>(std::max(1.0, std::sqrt(static_cast<double>(rows))))),
                wide = std::max<Index>(1, rows / deep);
    std::vector<Tile> tiles;
    for (Index k = z.first; k < z.last; k += deep)
      for (Index j = 0; j < grid_.count[1]; j += wide)
        tiles.push_back({{j, std::min(j + wide, grid_.count[1])}, {k, std::min(k + deep, z.last)}});
    return tiles;
  }

  template <class T>
  void fill_walls(Span z, T* layers) const {
    parallel_for(static_cast<std::size_t>(z.last - z.first), [&](std::size_t k) {
      T* layer = layers + static_cast<Index>(k) * layer_length();
      std::fill_n(layer, layer_length(), inside_ ? outside<T>() : T{0});
      if (!inside_) return;
      std::vector<InsideRun> runs;
      inside_->layer(z.first + static_cast<Index>(k), runs);
      for (const InsideRun& run : runs)
        std::fill_n(layer + run.row * row_length() + run.first, run.last - run.first + 1, T{0});
    });
  }

  /// The voxels of `within` whose centres x satisfy in(x), which are those up to about `half` from c.
  template <class In>
  Span run_of(int axis, Span within, double c, double half, const In& in) const {
    const double per_edge = 1 / grid_.spacing[axis], at = (c - grid_.corner[axis]) * per_edge - 0.5,
                 reach = half * per_edge;
    const auto low = static_cast<double>(within.first), high = static_cast<double>(within.last);
    auto first = static_cast<Index>(std::clamp(std::ceil(at - reach), low, high));
    auto last = static_cast<Index>(std::clamp(std::floor(at + reach) + 1, low, high));
    // Rounding may have lost or added a voxel at an end.
    while (first > within.first && in(grid_.center(axis, first - 1))) --first;
    while (first < within.last && first <= last && !in(grid_.center(axis, first))) ++first;
    if (first > last || first == within.last || !in(grid_.center(axis, first))) return {0, 0};
    last = std::max(last, first + 1);
    while (last < within.last && in(grid_.center(axis, last))) ++last;
    while (last > first && !in(grid_.center(axis, last - 1))) --last;
    return {first, last};
  }

  template <class T>
  void label_tile(const Tile& tile, Index first_layer, const std::vector<Ball>& balls, T* layers) const {
    const double low = grid_.plane(1, tile.y.first), high = grid_.plane(1, tile.y.last);
    // Backwards, so that the first of several spheres is written last, and of its layers the innermost.
    for (auto ball = balls.rbegin(); ball != balls.rend(); ++ball) {
      const double r = ball->radius, squared = r * r, x = ball->center[0], y = ball->center[1],
                   z = ball->center[2];
      if (y + r < low || y - r > high) continue;
      const Span ks = run_of(2, tile.z, z, r, [&](double at) { return (at - z) * (at - z) <= squared; });
      for (Index k = ks.first; k < ks.last; ++k) {
        const double dz = grid_.center(2, k) - z, zz = dz * dz;
        const Span js = run_of(1, tile.y, y, std::sqrt(squared - zz),
                               [&](double at) { return (at - y) * (at - y) + zz <= squared; });
        T* layer = layers + (k - first_layer) * layer_length();
        for (Index j = js.first; j < js.last; ++j) {
          const double dy = grid_.center(1, j) - y, yz = dy * dy + zz;
          const Span is = run_of(0, {0, grid_.count[0]}, x, std::sqrt(squared - yz),
                                 [&](double at) { return (at - x) * (at - x) + yz <= squared; });
          std::fill(layer + j * row_length() + is.first, layer + j * row_length() + is.last,
                    static_cast<T>(ball->value));
        }
      }
    }
  }

  /// The planes of cells that a ball reaches along an axis, in its radii; returns the cells.
  Span planes_of(int axis, Span within, const Ball& ball, std::vector<double>& planes) const {
    const double c = ball.center[axis], corner = grid_.corner[axis], edge = grid_.spacing[axis];
    const auto low = static_cast<double>(within.first), high = static_cast<double>(within.last);
    const Span cells = {
        static_cast<Index>(std::clamp(std::floor((c - ball.radius - corner) / edge), low, high)),
        static_cast<Index>(std::clamp(std::floor((c + ball.radius - corner) / edge) + 1, low, high))};
    planes.clear();
    for (Index i = cells.first; i <= cells.last; ++i)
      planes.push_back((grid_.plane(axis, i) - c) / ball.radius);
    return cells;
  }

  void sum_tile(const Tile& tile, Index first_layer, const std::vector<Ball>& balls, float* layers) const {
    const Index rows = tile.y.last - tile.y.first, depth = tile.z.last - tile.z.first;
    const Index stride = row_length(), layer = rows * stride;
    std::vector<double> sums(static_cast<std::size_t>(layer * depth), 0.0);
    const double low = grid_.plane(1, tile.y.first), high = grid_.plane(1, tile.y.last);
    const bool flat = grid_.dimension == 2;
    BallInCells cells;
    for (const Ball& ball : balls) {
      const double r = ball.radius;
      if (ball.center[1] + r < low || ball.center[1] - r > high) continue;
      const Span is = planes_of(0, {0, grid_.count[0]}, ball, cells.planes[0]),
                 js = planes_of(1, tile.y, ball, cells.planes[1]),
                 ks = flat ? tile.z : planes_of(2, tile.z, ball, cells.planes[2]);
      if (is.empty() || js.empty() || ks.empty()) continue;
      double* to = &sums[static_cast<std::size_t>((ks.first - tile.z.first) * layer +
                                                  (js.first - tile.y.first) * stride + is.first)];
      if (flat) {
        cells.add_disc(ball.weight * r * r / grid_.measure(), ball.weight, to, stride);
      } else {
        cells.add(ball.weight * r * r * r / grid_.measure(), ball.weight, to, stride, layer);
      }
    }
    for (Index k = 0; k < depth; ++k) {
      const double* from = &sums[static_cast<std::size_t>(k * layer)];
      float* to = layers + (tile.z.first - first_layer + k) * layer_length() + tile.y.first * stride;
      for (Index i = 0; i < layer; ++i) to[i] = static_cast<float>(std::clamp(from[i], 0.0, 1.0));
    }
  }

  const Spheres<dynamic>& spheres_;
  const VoxelGrid& grid_;
  Vector<3> periods_;
  VoxelValues values_;
  const VoxelLayers& layers_;
  std::optional<InsideOfDomain> inside_;
};

/// Each sphere is drawn once an image; a sphere of a packing has at most eight.
void require_few_images(const Spheres<dynamic>& spheres, const Domain& domain) {
  constexpr double most_images = 1e6;
  const Vector<3> periods = boundary_in_space(domain).edges;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    double images = 1;
    for (const double period : periods)
      if (period > 0) images *= 2 + 2 * spheres.r[i] / period;
    if (!(images <= most_images))
      throw Error(
          ErrorCode::bad_packing,
          fmt::format("sphere {} has the radius {:.6g} in periods of {:.6g}, {:.6g} and {:.6g}: no image "
                      "can show that",
                      i, spheres.r[i], periods[0], periods[1], periods[2]));
  }
}

template <class T>
void take_slabs(const Image& image, const VoxelGrid& grid, const TakeLayers& take, const Monitor& monitor) {
  const auto layer = static_cast<std::size_t>(grid.count[0] * grid.count[1]);
  const auto layers_in = [&](std::size_t bytes) { return static_cast<Index>(bytes / (layer * sizeof(T))); };
  Index depth = layers_in(slab_bytes);
  if (std::floating_point<T> && depth < layers_of_sums)
    depth = std::min(layers_of_sums, layers_in(slab_bytes_of_sums));
  depth = std::clamp<Index>(depth, 1, grid.count[2]);
  std::vector<T> layers(layer * static_cast<std::size_t>(depth));
  const Interruptible interruptible(monitor);
  for (Index k = 0; k < grid.count[2]; k += depth) {
    const Index end = std::min(k + depth, grid.count[2]);
    image.fill({k, end}, layers.data());
    const std::size_t bytes = sizeof(T) * layer * static_cast<std::size_t>(end - k);
    take({reinterpret_cast<const char*>(layers.data()), bytes});
    const double done = static_cast<double>(end) / static_cast<double>(grid.count[2]);
    monitor.report({"voxels", done, fmt::format("{} of {} layers", grouped(end), grouped(grid.count[2]))});
  }
}

}  // namespace

void voxelise(const Spheres<dynamic>& spheres, const Domain& domain, const VoxelGrid& grid,
              VoxelValues values, const TakeLayers& take, const Monitor& monitor, const VoxelLayers& layers) {
  if (spheres.size() >= 0xFFFFFFFF)
    throw Error(ErrorCode::bad_argument, "an image has labels for no more than 4,294,967,294 spheres");
  require_few_images(spheres, domain);
  const Image image(spheres, domain, grid, values, layers);
  switch (values) {
    case VoxelValues::binary:
    case VoxelValues::materials:
    case VoxelValues::layers:
      return take_slabs<std::uint8_t>(image, grid, take, monitor);
    case VoxelValues::labels:
      return take_slabs<std::uint32_t>(image, grid, take, monitor);
    case VoxelValues::fraction:
      return take_slabs<float>(image, grid, take, monitor);
  }
}

}  // namespace bernal
