// How high prisms can stand over the vertices of a surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "core/parallel.hpp"
#include "kernels/closest_point.hpp"
#include "meshes/boundary_layer.hpp"
#include "near/box_tree.hpp"

namespace bernal {
namespace {

/// Columns are lower than asked for down to this share, and else left out.
constexpr double lowest_column = 0.3;
/// And not lower than this share of the longest edge beside them.
constexpr double flattest_column = 0.15;
/// How much heights change along an edge, over its length.
constexpr double steepest_slope = 0.5;

constexpr std::uint32_t on_none = std::numeric_limits<std::uint32_t>::max();

/// Of columns beside triangles without prisms, over the longest edge there. A flat tetrahedron between two
/// triangles, of height e edges, has a determinant of inner faces (see TetrahedraNear) of some 120 e^4 on the
/// surface and 20 e^4 above; what checkMesh asks for, 0.001, sets e. Many layers do not get that high.
double flattest_end(const std::vector<double>& shares) {
  constexpr double on_surface = 0.06, above = 0.09, most = 0.3;
  double least = on_surface / shares[0];
  for (std::size_t k = 1; k < shares.size(); ++k)
    least = std::max(least, above / (shares[k] - shares[k - 1]));
  return std::min(least, most);
}

class PrismColumns {
 public:
  PrismColumns(const ConformingSurface& surface, const BoundaryLayerOptions& options)
      : surface_(surface),
        options_(options),
        tree_(boxes_of(surface), 8),
        // What is asked for counts as high enough on spheres.
        flattest_column_(std::min(flattest_column, 0.5 * options.height / options.sphere_edge)),
        flattest_end_(
            std::min(flattest_end(shares_of_layers(options)), 0.8 * options.height / options.sphere_edge)) {
    find_patches();
    find_edges();
  }

  std::vector<Vector<3>> make() {
    const std::size_t count = surface_.vertices.size();
    height_.assign(count, 0);
    parallel_ranges(count, 256, [&](std::size_t first, std::size_t last) {
      for (std::size_t v = first; v < last; ++v)
        if (patch_[v] != on_none) height_[v] = height_with_room(static_cast<std::uint32_t>(v));
    });
    leave_room_over_triangles();
    constexpr int most_rounds = 50;
    for (int round = 0; round < most_rounds; ++round) {
      drop_lonely();
      const std::vector<double> before_slopes = height_;
      make_slopes();
      const std::vector<std::uint32_t> flat = flat_ends();
      if (flat.empty()) break;
      height_ = before_slopes;
      for (const std::uint32_t v : flat) height_[v] = 0;
    }
    std::vector<Vector<3>> columns(count, Vector<3>::Zero());
    for (std::size_t v = 0; v < count; ++v)
      if (height_[v] > 0) columns[v] = height_[v] * normal_[v];
    return columns;
  }

 private:
  static std::vector<Bounds<3>> boxes_of(const ConformingSurface& surface) {
    std::vector<Bounds<3>> boxes(surface.triangles.size(), Bounds<3>::of_nothing());
    for (std::size_t t = 0; t < boxes.size(); ++t)
      for (const std::uint32_t c : surface.triangles[t]) boxes[t].add(surface.vertices[c]);
    return boxes;
  }

  bool may_have_prisms(const SurfacePatch& patch) const {
    if (patch.kind == SurfacePatch::Kind::sphere) return patch.regions[1] == 0;
    return patch.kind == SurfacePatch::Kind::wall && patch.regions[0] == 0 && patch.name.empty() &&
           (options_.on_flat_walls || patch.shape.is_round());
  }

  /// The patch that each vertex lies inside of, if prisms may stand there, and its normal into the fluid.
  void find_patches() {
    constexpr std::uint32_t unseen = on_none - 1;
    patch_.assign(surface_.vertices.size(), unseen);
    normal_.assign(surface_.vertices.size(), Vector<3>::Zero());
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const std::uint32_t p = surface_.patch[t];
      const bool may = may_have_prisms(surface_.patches[p]);
      const FaceCorners& c = surface_.triangles[t];
      Vector<3> normal = (surface_.vertices[c[1]] - surface_.vertices[c[0]])
                             .cross(surface_.vertices[c[2]] - surface_.vertices[c[0]]);
      if (surface_.patches[p].kind == SurfacePatch::Kind::wall) normal = -normal;
      for (const std::uint32_t v : c) {
        patch_[v] = may && (patch_[v] == unseen || patch_[v] == p) ? p : on_none;
        normal_[v] += normal;
      }
    }
    double sum = 0;
    std::size_t spheres = 0;
    for (const SurfacePatch& patch : surface_.patches)
      if (patch.kind == SurfacePatch::Kind::sphere) {
        sum += patch.shape.radius;
        ++spheres;
      }
    mean_radius_ = spheres > 0 ? sum / static_cast<double>(spheres) : 0;
    for (std::size_t v = 0; v < patch_.size(); ++v) {
      if (patch_[v] == unseen) patch_[v] = on_none;
      if (patch_[v] == on_none) continue;
      const SurfacePatch& patch = surface_.patches[patch_[v]];
      normal_[v].normalize();
      if (!patch.shape.is_round()) continue;
      const Vector<3> outwards = distance_from(patch.shape, surface_.vertices[v]).direction;
      normal_[v] = outwards.dot(normal_[v]) > 0 ? outwards : Vector<3>(-outwards);
    }
  }

  /// The edges of triangles by vertex, and the longest of each.
  void find_edges() {
    first_.assign(surface_.vertices.size() + 1, 0);
    longest_.assign(surface_.vertices.size(), 0);
    for (const FaceCorners& t : surface_.triangles)
      for (const std::uint32_t v : t) first_[v + 1] += 2;
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    beside_.resize(first_.back());
    for (const FaceCorners& t : surface_.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::size_t j : {(k + 1) % 3, (k + 2) % 3}) {
          beside_[next[t[k]]++] = t[j];
          longest_[t[k]] = std::max(longest_[t[k]], length(t[k], t[j]));
        }
  }

  double length(std::uint32_t a, std::uint32_t b) const {
    return (surface_.vertices[b] - surface_.vertices[a]).norm();
  }

  double height_asked_for(std::uint32_t patch) const {
    const SurfacePatch& on = surface_.patches[patch];
    return options_.height * (on.kind == SurfacePatch::Kind::sphere ? on.shape.radius : mean_radius_);
  }

  /// The distance of a point from the nearest triangle of another patch, if that is below `most`.
  double room_at(const Vector<3>& p, std::uint32_t patch, double most) const {
    double least = most * most;
    tree_.for_each_leaf_below(
        least, [&](const auto& node) { return squared_distance(node.bounds, p); },
        [&](const auto& leaf) {
          for (std::uint32_t k = leaf.first; k < leaf.last; ++k) {
            const std::uint32_t t = tree_.order()[k];
            if (surface_.patch[t] == patch) continue;
            const FaceCorners& c = surface_.triangles[t];
            const Vector<3>&a = surface_.vertices[c[0]], &b = surface_.vertices[c[1]],
                  &d = surface_.vertices[c[2]];
            Bounds<3> box = Bounds<3>::of_nothing();
            for (const Vector<3>* corner : {&a, &b, &d}) box.add(*corner);
            if (squared_distance(box, p) >= least) continue;
            least = std::min(least, PreparedTriangle(a, b, d).offset(p).squaredNorm());
          }
        });
    return std::sqrt(least);
  }

  /// What prisms may take of the room at a point beside edges of this length.
  double height_at(const Vector<3>& p, std::uint32_t patch, double edge, double most) const {
    const double kept = edge / options_.per_gap;
    return 0.5 * (room_at(p, patch, 2 * most + kept) - kept);
  }

  double lowest(std::uint32_t v) const {
    return std::max(lowest_column * height_asked_for(patch_[v]), flattest_column_ * longest_[v]);
  }

  double height_with_room(std::uint32_t v) const {
    const double most = height_asked_for(patch_[v]);
    const double height = height_at(surface_.vertices[v], patch_[v], longest_[v], most);
    return height < lowest(v) ? 0 : std::min(height, most);
  }

  /// The middles of triangles may be nearer to others than their corners.
  void leave_room_over_triangles() {
    std::vector<double> room(surface_.triangles.size(), std::numeric_limits<double>::infinity());
    const auto mean = [&](const FaceCorners& c) {
      return (height_[c[0]] + height_[c[1]] + height_[c[2]]) / 3;
    };
    parallel_ranges(room.size(), 256, [&](std::size_t first, std::size_t last) {
      for (std::size_t t = first; t < last; ++t) {
        const FaceCorners& c = surface_.triangles[t];
        const double most = mean(c);
        if (most <= 0) continue;
        const double edge = std::max({length(c[0], c[1]), length(c[1], c[2]), length(c[2], c[0])});
        const Vector<3> middle =
            (surface_.vertices[c[0]] + surface_.vertices[c[1]] + surface_.vertices[c[2]]) / 3;
        room[t] = height_at(middle, surface_.patch[t], 0.5 * edge, most);
      }
    });
    for (std::size_t t = 0; t < room.size(); ++t) {
      const FaceCorners& c = surface_.triangles[t];
      if (room[t] >= mean(c)) continue;
      for (const std::uint32_t v : c)
        if (height_[v] > std::max(room[t], 0.0)) height_[v] = room[t] < lowest(v) ? 0 : room[t];
    }
  }

  /// Columns stay that make up a whole prism with others.
  void drop_lonely() {
    std::vector<char> stays(height_.size(), 0);
    for (const FaceCorners& c : surface_.triangles)
      if (std::ranges::all_of(c, [&](std::uint32_t v) { return height_[v] > 0; }))
        for (const std::uint32_t v : c) stays[v] = 1;
    for (std::size_t v = 0; v < height_.size(); ++v)
      if (stays[v] == 0) height_[v] = 0;
  }

  /// The largest heights below those that are there which change no more than slopes may.
  void make_slopes() {
    struct Reached {
      double height;
      std::uint32_t vertex;
      bool operator>(const Reached& other) const {
        return height != other.height ? height > other.height : vertex > other.vertex;
      }
    };
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> waiting;
    for (std::uint32_t v = 0; v < height_.size(); ++v)
      if (std::any_of(beside_.begin() + static_cast<std::ptrdiff_t>(first_[v]),
                      beside_.begin() + static_cast<std::ptrdiff_t>(first_[v + 1]),
                      [&](std::uint32_t w) { return height_[w] > height_[v]; }))
        waiting.push({height_[v], v});
    while (!waiting.empty()) {
      const auto [height, v] = waiting.top();
      waiting.pop();
      if (height > height_[v]) continue;
      for (std::size_t k = first_[v]; k < first_[v + 1]; ++k) {
        const std::uint32_t w = beside_[k];
        const double most = height + steepest_slope * length(v, w);
        if (height_[w] <= most) continue;
        height_[w] = most;
        waiting.push({most, w});
      }
    }
  }

  /// The vertices with columns of triangles on which layers end too flat for gradients, though higher ones
  /// are asked for.
  std::vector<std::uint32_t> flat_ends() const {
    std::vector<std::uint32_t> flat;
    for (const FaceCorners& c : surface_.triangles) {
      const double edge = std::max({length(c[0], c[1]), length(c[1], c[2]), length(c[2], c[0])});
      bool is_end = false, is_flat = false;
      for (const std::uint32_t v : c) {
        is_end |= height_[v] == 0;
        is_flat |= height_[v] > 0 && height_[v] < flattest_end_ * edge;
      }
      if (!is_end || !is_flat) continue;
      for (const std::uint32_t v : c)
        if (height_[v] > 0) flat.push_back(v);
    }
    return flat;
  }

  const ConformingSurface& surface_;
  const BoundaryLayerOptions& options_;
  BoxTree<3> tree_;                   ///< of all triangles
  std::vector<std::uint32_t> patch_;  ///< of each vertex, see `find_patches`
  std::vector<Vector<3>> normal_;
  std::vector<std::size_t> first_;  ///< of each vertex in the next
  std::vector<std::uint32_t> beside_;
  std::vector<double> longest_, height_;  ///< of each vertex
  double mean_radius_ = 0;
  double flattest_column_;  ///< as the constant
  double flattest_end_;     ///< least height of columns where layers end, over the longest edge of a triangle
};

}  // namespace

std::vector<double> shares_of_layers(const BoundaryLayerOptions& options) {
  std::vector<double> shares;
  double height = 1, sum = 0;
  for (int k = 0; k < options.layers; ++k, height *= options.growth) shares.push_back(sum += height);
  for (double& share : shares) share /= sum;
  return shares;
}

std::vector<Vector<3>> prism_columns(const ConformingSurface& surface, const BoundaryLayerOptions& options) {
  return PrismColumns(surface, options).make();
}

}  // namespace bernal
