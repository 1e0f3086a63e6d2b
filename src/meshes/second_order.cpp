#include "meshes/second_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "meshes/mesh_quality.hpp"

namespace bernal {
namespace {

using Barycentric = std::array<double, 4>;

/// The derivative of the place by the coordinates of the tetrahedron (0, x, y, z), in columns.
Eigen::Matrix3d derivative(const VolumeMesh& mesh, std::size_t t, const Barycentric& at) {
  // Shape functions: corner i has l_i (2 l_i - 1), the middle of i and j has 4 l_i l_j; l_0 = 1 - x - y - z.
  std::array<Vector<3>, 4> by{};  // derivatives by the four barycentric coordinates
  for (std::size_t i = 0; i < 4; ++i) by[i] = (4 * at[i] - 1) * mesh.vertices[mesh.tetrahedra[t][i]];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(edges_of_tetrahedron[e][0]),
               j = static_cast<std::size_t>(edges_of_tetrahedron[e][1]);
    const Vector<3>& middle = mesh.node(mesh.middles_of_tetrahedron[t][e]);
    by[i] += 4 * at[j] * middle;
    by[j] += 4 * at[i] * middle;
  }
  Eigen::Matrix3d columns;
  for (int k = 0; k < 3; ++k) columns.col(k) = by[static_cast<std::size_t>(k) + 1] - by[0];
  return columns;
}

double sicn_of(const Eigen::Matrix3d& columns) {
  const Vector<3> origin = Vector<3>::Zero();
  return sicn(origin, columns.col(0), columns.col(1), columns.col(2));
}

constexpr std::uint32_t none = 0xFFFFFFFF;

struct RoundEdge {
  std::int64_t sphere = -1;  ///< -1: on the side of a cylinder
  bool has_plane = false, is_on_neck = false;
  Vector<3> normal = Vector<3>::Zero();  ///< of the plane that it lies on, too
};

std::uint64_t key_of_edge(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

using RoundEdges = std::unordered_map<std::uint64_t, RoundEdge>;

RoundEdges round_edges(const VolumeMesh& mesh, bool is_cylinder) {
  using Kind = SurfacePatch::Kind;
  RoundEdges edges;
  const auto is_side = [&](const SurfacePatch& patch) {
    return is_cylinder && patch.kind == Kind::wall && patch.index == 0;
  };
  for (const bool is_first : {true, false})
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const SurfacePatch& patch = mesh.patches[mesh.patch[t]];
      if ((patch.kind == Kind::sphere || is_side(patch)) != is_first) continue;
      const FaceCorners& c = mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t key = key_of_edge(c[k], c[(k + 1) % 3]);
        if (is_first) {
          // What lies on both a sphere and the side, a neck begins at.
          const auto [edge, is_new] = edges.try_emplace(key);
          const std::int64_t sphere = is_side(patch) ? -1 : std::int64_t{patch.index};
          if (!is_new && edge->second.sphere != sphere) edge->second.is_on_neck = true;
          edge->second.sphere = sphere;
          continue;
        }
        const auto found = edges.find(key);
        if (found == edges.end()) continue;
        if (patch.kind == Kind::neck) {
          found->second.is_on_neck = true;
          continue;
        }
        found->second.has_plane = true;
        found->second.normal = (mesh.vertices[c[1]] - mesh.vertices[c[0]])
                                   .cross(mesh.vertices[c[2]] - mesh.vertices[c[0]])
                                   .normalized();
      }
    }
  return edges;
}

/// The point of the sphere that is nearest to the middle, in the plane if there is one.
Vector<3> on_sphere(const Vector<3>& middle, const Vector<3>& center, double radius, const RoundEdge& edge) {
  if (!edge.has_plane) return center + radius * (middle - center).normalized();
  const double height = (middle - center).dot(edge.normal);
  const Vector<3> foot = center + height * edge.normal;
  const double squared = radius * radius - height * height;
  const Vector<3> away = middle - foot;
  if (!(squared > 0 && away.squaredNorm() > 0)) return middle;
  return foot + std::sqrt(squared) * away.normalized();
}

using NumbersOfMiddles = std::unordered_map<std::uint64_t, std::uint32_t>;

/// Adds the pairs of middles to those of corners, and returns by axis where they begin.
std::array<std::size_t, 3> pair_middles(VolumeMesh& mesh, const NumbersOfMiddles& number) {
  std::array<std::size_t, 3> first{};
  std::vector<std::uint32_t> upper(mesh.vertices.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto& pairs = mesh.periodic[axis];
    first[axis] = pairs.size();
    if (pairs.empty()) continue;
    std::ranges::fill(upper, none);
    for (const auto& [low, high] : pairs) upper[low] = high;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const SurfacePatch& patch = mesh.patches[mesh.patch[t]];
      if (patch.kind != SurfacePatch::Kind::period_end || patch.index != 2 * axis) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
        if (upper[a] == none || upper[b] == none) continue;
        const auto there = number.find(key_of_edge(upper[a], upper[b]));
        if (there != number.end()) pairs.push_back({mesh.middles_of_triangle[t][k], there->second});
      }
    }
    const auto middles = pairs.begin() + static_cast<std::ptrdiff_t>(first[axis]);
    std::sort(middles, pairs.end());
    pairs.erase(std::unique(middles, pairs.end()), pairs.end());
  }
  return first;
}

/// Middles of edges, each with the ends of its edge.
struct Middles {
  std::vector<std::array<std::uint32_t, 2>> ends;
  std::vector<std::uint8_t> is_straight;

  void straighten(VolumeMesh& mesh, std::uint32_t node) {
    const std::size_t k = node - mesh.vertices.size();
    mesh.middles[k] = (mesh.vertices[ends[k][0]] + mesh.vertices[ends[k][1]]) / 2;
    is_straight[k] = 1;
  }
};

/// Gives both middles the coordinates of the lower one but for the one along the axis, and lets both be
/// straight where one is. Returns whether one has become straight.
bool make_equal(VolumeMesh& mesh, Middles& middles, std::size_t axis,
                const std::array<std::uint32_t, 2>& pair) {
  const std::size_t low = pair[0] - mesh.vertices.size(), high = pair[1] - mesh.vertices.size();
  const bool changes = middles.is_straight[low] != middles.is_straight[high];
  if (changes) middles.straighten(mesh, middles.is_straight[low] ? pair[1] : pair[0]);
  Vector<3> there = mesh.middles[low];
  there[static_cast<int>(axis)] = mesh.middles[high][static_cast<int>(axis)];
  mesh.middles[high] = there;
  return changes;
}

/// The point of the side that is nearest to the middle.
Vector<3> on_side(const Vector<3>& middle, const Cylinder& cylinder) {
  const Vector<3> axis = cylinder.axis.normalized(), from = middle - cylinder.base;
  const Vector<3> foot = cylinder.base + from.dot(axis) * axis;
  return foot + cylinder.radius * (middle - foot).normalized();
}

}  // namespace

double curved_sicn(const VolumeMesh& mesh, std::size_t tetrahedron) {
  double least = sicn_of(derivative(mesh, tetrahedron, {0.25, 0.25, 0.25, 0.25}));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j) {
      Barycentric at{};
      at[i] += 0.5;
      at[j] += 0.5;
      least = std::min(least, sicn_of(derivative(mesh, tetrahedron, at)));
    }
  return least;
}

double least_curved_sicn(const VolumeMesh& mesh) {
  double least = 1;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) least = std::min(least, curved_sicn(mesh, t));
  return least;
}

std::vector<double> curved_volumes_of_regions(const VolumeMesh& mesh) {
  // The determinant of the derivative is a polynomial of degree 3: five points are exact, of which the
  // centroid has a negative weight. Source: Stroud, Approximate Calculation of Multiple Integrals (1971).
  std::vector<double> volumes(mesh.regions.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    double sum = -0.8 * derivative(mesh, t, {0.25, 0.25, 0.25, 0.25}).determinant();
    for (std::size_t i = 0; i < 4; ++i) {
      Barycentric at = {1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 6};
      at[i] = 0.5;
      sum += 0.45 * derivative(mesh, t, at).determinant();
    }
    volumes[mesh.region[t]] += sum / 6;
  }
  return volumes;
}

CurvedEdges make_second_order(VolumeMesh& mesh, const Spheres<dynamic>& spheres, const Domain& domain) {
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  const RoundEdges curved = round_edges(mesh, cylinder != nullptr);
  const Boundary<3> boundary = boundary_of<3>(domain);
  CurvedEdges made;
  NumbersOfMiddles number;
  Middles middles;
  number.reserve(mesh.vertices.size() * 7);
  const auto middle_of = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        number.try_emplace(key_of_edge(a, b), static_cast<std::uint32_t>(mesh.node_count()));
    if (!is_new) return found->second;
    Vector<3> middle = (mesh.vertices[a] + mesh.vertices[b]) / 2;
    if (const auto edge = curved.find(found->first); edge != curved.end() && !edge->second.is_on_neck) {
      if (edge->second.sphere < 0) {
        middle = on_side(middle, *cylinder);
      } else {
        const auto sphere = static_cast<std::size_t>(edge->second.sphere);
        // The image of the centre that is nearest.
        const Vector<3> center = middle - boundary.minimum_image(middle - Vector<3>(spheres.center(sphere)));
        middle = on_sphere(middle, center, spheres.r[sphere], edge->second);
      }
      ++made.curved;
    }
    mesh.middles.push_back(middle);
    middles.ends.push_back({a, b});
    return found->second;
  };
  mesh.middles_of_tetrahedron.resize(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e)
      mesh.middles_of_tetrahedron[t][e] =
          middle_of(mesh.tetrahedra[t][static_cast<std::size_t>(edges_of_tetrahedron[e][0])],
                    mesh.tetrahedra[t][static_cast<std::size_t>(edges_of_tetrahedron[e][1])]);
  mesh.middles_of_triangle.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      mesh.middles_of_triangle[t][k] = middle_of(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
  const std::array<std::size_t, 3> first_pair = pair_middles(mesh, number);
  middles.is_straight.assign(mesh.middles.size(), 0);
  // Straight edges of one may turn its neighbours: until all are right.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = first_pair[axis]; k < mesh.periodic[axis].size(); ++k)
        changed |= make_equal(mesh, middles, axis, mesh.periodic[axis][k]);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      if (curved_sicn(mesh, t) > 0) continue;
      for (const std::uint32_t node : mesh.middles_of_tetrahedron[t]) {
        if (middles.is_straight[node - mesh.vertices.size()]) continue;
        middles.straighten(mesh, node);
        changed = true;
      }
    }
  }
  for (std::size_t k = 0; k < middles.ends.size(); ++k)
    made.kept_straight +=
        middles.is_straight[k] && curved.contains(key_of_edge(middles.ends[k][0], middles.ends[k][1]));
  return made;
}

}  // namespace bernal
