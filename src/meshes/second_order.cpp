#include "meshes/second_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
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

std::uint64_t key_of_edge(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

/// The surfaces that an edge of triangles lies on: patches and flat triangles, each kind of patch once.
struct EdgeOnSurfaces {
  static constexpr std::size_t most = 4;
  std::array<std::uint32_t, most> triangle{};
  std::size_t count = 0;

  void add(const VolumeMesh& mesh, std::uint32_t t) {
    for (std::size_t k = 0; k < count; ++k)
      if (mesh.patch[triangle[k]] == mesh.patch[t]) return;
    if (count < most) triangle[count++] = t;
  }
};

using EdgesOnSurfaces = std::unordered_map<std::uint64_t, EdgeOnSurfaces>;

/// The edges that lie on some round surface, with a triangle of each patch around.
EdgesOnSurfaces round_edges(const VolumeMesh& mesh) {
  EdgesOnSurfaces edges;
  for (const bool is_first : {true, false})
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.patches[mesh.patch[t]].shape.is_round() != is_first) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t key = key_of_edge(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
        const auto found = is_first ? edges.try_emplace(key).first : edges.find(key);
        if (found == edges.end()) continue;
        found->second.add(mesh, t);
      }
    }
  return edges;
}

/// What a triangle stands for: of a flat one its plane.
RoundSurface surface_of(const VolumeMesh& mesh, std::uint32_t t) {
  const RoundSurface& shape = mesh.patches[mesh.patch[t]].shape;
  if (shape.kind != RoundSurface::Kind::flat) return shape;
  const FaceCorners& c = mesh.triangles[t];
  const Vector<3>&p = mesh.vertices[c[0]], &q = mesh.vertices[c[1]], &r = mesh.vertices[c[2]];
  return {.kind = RoundSurface::Kind::plane, .center = p, .axis = (q - p).cross(r - p).normalized()};
}

/// Where fillets begin they touch spheres and walls, so that distances from both do not tell where that
/// circle is: they become cylinders about their axes through the vertex.
void part_from_fillets(std::vector<RoundSurface>& surfaces, const Vector<3>& vertex) {
  if (surfaces.size() < 2) return;
  for (RoundSurface& surface : surfaces) {
    if (surface.kind != RoundSurface::Kind::torus) continue;
    const Vector<3> from = vertex - surface.center;
    surface.kind = RoundSurface::Kind::cylinder;
    surface.radius = (from - from.dot(surface.axis) * surface.axis).norm();
    surface.bend = {};
  }
}

/// For each vertex a patch that is a sphere on which it lies, of those inside of spheres and around them.
std::vector<std::uint32_t> spheres_of_vertices(const VolumeMesh& mesh) {
  std::vector<std::uint32_t> of(mesh.vertices.size(), none);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const SurfacePatch& patch = mesh.patches[mesh.patch[t]];
    if (patch.kind != SurfacePatch::Kind::sphere && patch.kind != SurfacePatch::Kind::layer) continue;
    if (patch.shape.kind != RoundSurface::Kind::sphere) continue;
    for (const std::uint32_t c : mesh.triangles[t]) of[c] = mesh.patch[t];
  }
  return of;
}

/// Half way between two spheres about one centre, if the ends of an edge lie on such.
std::optional<RoundSurface> between_spheres(const VolumeMesh& mesh, std::uint32_t a, std::uint32_t b) {
  if (a == none || b == none || a == b) return {};
  const RoundSurface &one = mesh.patches[a].shape, &other = mesh.patches[b].shape;
  if (one.center != other.center || one.radius == other.radius) return {};
  RoundSurface between = one;
  between.radius = (one.radius + other.radius) / 2;
  return between;
}

/// The edges between two spheres about one centre that lie on flat triangles, with one of each patch around.
EdgesOnSurfaces edges_across_layers(const VolumeMesh& mesh, const std::vector<std::uint32_t>& sphere) {
  EdgesOnSurfaces edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.patches[mesh.patch[t]].shape.is_round()) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (between_spheres(mesh, sphere[a], sphere[b])) edges[key_of_edge(a, b)].add(mesh, t);
    }
  }
  return edges;
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

/// Gives upper middles the coordinates of the lower ones but for the one along the axis.
void make_equal(VolumeMesh& mesh, const std::array<std::size_t, 3>& first_pair) {
  // Those at the ends of several axes get them one axis after another, so that the last one is right, too.
  for (int round = 0; round < 3; ++round)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = first_pair[axis]; k < mesh.periodic[axis].size(); ++k) {
        const auto& [lower, upper] = mesh.periodic[axis][k];
        Vector<3> there = mesh.middles[lower - mesh.vertices.size()];
        Vector<3>& here = mesh.middles[upper - mesh.vertices.size()];
        there[static_cast<int>(axis)] = here[static_cast<int>(axis)];
        here = there;
      }
}

/// Whether middles lie on ends of periods, by axis.
std::vector<std::array<std::uint8_t, 3>> ends_of_middles(const VolumeMesh& mesh) {
  std::vector<std::array<std::uint8_t, 3>> on(mesh.middles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const SurfacePatch& patch = mesh.patches[mesh.patch[t]];
    if (patch.kind != SurfacePatch::Kind::period_end) continue;
    for (const std::uint32_t node : mesh.middles_of_triangle[t])
      on[node - mesh.vertices.size()][patch.index / 2] = 1;
  }
  return on;
}

/// Whether a tetrahedron is not folded, and curved edges do not make it poor.
bool is_good(const VolumeMesh& mesh, std::size_t t) {
  constexpr double poor = 0.12;
  if (!(least_jacobian_coefficient(mesh, t) > 0)) return false;
  const double curved = curved_sicn(mesh, t);
  if (curved >= poor) return true;
  const TetrahedronCorners& c = mesh.tetrahedra[t];
  return curved >= sicn(mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]], mesh.vertices[c[3]]);
}

/// Makes edges straight until no tetrahedron is folded or poor for them, as straight edges of one may fold
/// its neighbours.
void straighten_folded(VolumeMesh& mesh, Middles& middles, const std::array<std::size_t, 3>& first_pair) {
  std::vector<std::uint8_t> is_new(mesh.middles.size(), 1), next;
  for (bool changed = true; changed;) {
    changed = false;
    next.assign(mesh.middles.size(), 0);
    const auto straighten = [&](std::uint32_t node) {
      middles.straighten(mesh, node);
      next[node - mesh.vertices.size()] = 1;
      changed = true;
    };
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto& nodes = mesh.middles_of_tetrahedron[t];
      const auto place = [&](std::uint32_t node) { return node - mesh.vertices.size(); };
      if (std::ranges::none_of(nodes, [&](std::uint32_t node) { return is_new[place(node)]; }) ||
          std::ranges::all_of(nodes, [&](std::uint32_t node) { return middles.is_straight[place(node)]; }) ||
          is_good(mesh, t))
        continue;
      for (const std::uint32_t node : nodes)
        if (!middles.is_straight[place(node)]) straighten(node);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = first_pair[axis]; k < mesh.periodic[axis].size(); ++k) {
        const auto& pair = mesh.periodic[axis][k];
        const std::size_t low = pair[0] - mesh.vertices.size(), high = pair[1] - mesh.vertices.size();
        if (middles.is_straight[low] != middles.is_straight[high])
          straighten(middles.is_straight[low] ? pair[1] : pair[0]);
      }
    is_new.swap(next);
  }
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

double least_jacobian_coefficient(const VolumeMesh& mesh, std::size_t tetrahedron) {
  // The derivative is the sum of l_i times its value at corner i, so the determinant is the sum over i, j, k
  // of l_i l_j l_k times one with columns of three corners, and a coefficient the mean over their orders.
  std::array<Eigen::Matrix3d, 4> at;
  for (std::size_t i = 0; i < 4; ++i) {
    Barycentric corner{};
    corner[i] = 1;
    at[i] = derivative(mesh, tetrahedron, corner);
  }
  std::array<double, 64> of{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const Vector<3> across = at[i].col(0).cross(at[j].col(1));
      for (std::size_t k = 0; k < 4; ++k) of[16 * i + 4 * j + k] = across.dot(at[k].col(2));
    }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j)
      for (std::size_t k = j; k < 4; ++k) {
        const auto value = [&](std::size_t a, std::size_t b, std::size_t c) {
          return of[16 * a + 4 * b + c];
        };
        least = std::min(least, value(i, j, k) + value(i, k, j) + value(j, i, k) + value(j, k, i) +
                                    value(k, i, j) + value(k, j, i));
      }
  return least / 6;
}

CurvedEdges make_second_order(VolumeMesh& mesh) {
  const EdgesOnSurfaces curved = round_edges(mesh);
  const std::vector<std::uint32_t> sphere = spheres_of_vertices(mesh);
  const EdgesOnSurfaces across = edges_across_layers(mesh, sphere);
  CurvedEdges made;
  NumbersOfMiddles number;
  Middles middles;
  number.reserve(mesh.vertices.size() * 7);
  const auto middle_of = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        number.try_emplace(key_of_edge(a, b), static_cast<std::uint32_t>(mesh.node_count()));
    if (!is_new) return found->second;
    mesh.middles.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
    middles.ends.push_back({a, b});
    middles.is_straight.push_back(1);
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
  const std::vector<std::array<std::uint8_t, 3>> ends = ends_of_middles(mesh);
  for (std::size_t k = 0; k < mesh.middles.size(); ++k) {
    const auto [a, b] = middles.ends[k];
    std::vector<RoundSurface> surfaces;
    const auto add_all = [&](const EdgesOnSurfaces& edges) {
      const auto on = edges.find(key_of_edge(a, b));
      if (on == edges.end()) return false;
      for (std::size_t t = 0; t < on->second.count; ++t)
        surfaces.push_back(surface_of(mesh, on->second.triangle[t]));
      return true;
    };
    if (add_all(curved)) {
      ++made.curved;
    } else if (const auto between = between_spheres(mesh, sphere[a], sphere[b])) {
      surfaces.push_back(*between);
      add_all(across);
    } else {
      continue;
    }
    part_from_fillets(surfaces, mesh.vertices[a]);
    std::optional<Vector<3>> there = point_on_all(surfaces, mesh.middles[k]);
    if (!there) continue;
    for (int axis = 0; axis < 3; ++axis)
      if (ends[k][static_cast<std::size_t>(axis)]) (*there)[axis] = mesh.vertices[a][axis];
    mesh.middles[k] = *there;
    middles.is_straight[k] = 0;
  }
  const std::array<std::size_t, 3> first_pair = pair_middles(mesh, number);
  make_equal(mesh, first_pair);
  straighten_folded(mesh, middles, first_pair);
  for (std::size_t k = 0; k < middles.ends.size(); ++k)
    made.kept_straight +=
        middles.is_straight[k] && curved.contains(key_of_edge(middles.ends[k][0], middles.ends[k][1]));
  return made;
}

}  // namespace bernal
