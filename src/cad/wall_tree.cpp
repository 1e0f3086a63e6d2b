#include "cad/wall_tree.hpp"

#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

/// Approximate position of a triangle.
struct Place {
  Eigen::Vector3f center;
  std::uint32_t id;
};

/// Sorts places into the order in which the tree halves its leaves.
void arrange(std::span<Place> places) {
  constexpr std::size_t worth_a_task = 1 << 14;
  if (places.size() < 3) return;
  Eigen::AlignedBox3f bounds;
  for (const Place& place : places) bounds.extend(place.center);
  Eigen::Index axis = 0;
  bounds.sizes().maxCoeff(&axis);
  const std::size_t half = places.size() / 2;
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(half), places.end(),
                   [axis](const Place& p, const Place& q) {
                     return std::pair(p.center[axis], p.id) < std::pair(q.center[axis], q.id);
                   });
  const auto one = [&] { arrange(places.first(half)); };
  const auto other = [&] { arrange(places.subspan(half)); };
  if (places.size() > worth_a_task) {
    parallel_both(one, other);
  } else {
    one();
    other();
  }
}

/// The triangles of the mesh in that order.
std::vector<WallTriangle> arranged(const Mesh& mesh) {
  const Vector<3> middle = bounds_of(mesh).center();
  std::vector<Place> places;
  places.reserve(mesh.triangles.size());
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector<3> center = (mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3;
    places.push_back({(center - middle).cast<float>(), static_cast<std::uint32_t>(places.size())});
  }
  arrange(places);
  std::vector<WallTriangle> triangles;
  triangles.reserve(places.size());
  for (const Place& place : places) {
    const auto& [i, j, k] = mesh.triangles[place.id];
    triangles.push_back({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k], place.id});
  }
  return triangles;
}

/// The leaves of a node are contiguous.
std::span<const Leaf> leaves_of(const Node& node, std::size_t leaves) {
  const Node* first = &node;
  for (std::size_t n = leaves; n > 3; n /= 2) first = &first->left_child();
  return {&first->left_data(), leaves};
}

}  // namespace

WallTree::WallTree(const Mesh& mesh) {
  const std::vector<WallTriangle> triangles = arranged(mesh);
  tree_.insert(triangles.cbegin(), triangles.cend());
  tree_.do_not_accelerate_distance_queries();
  // Built now, because queries are const and concurrent.
  tree_.custom_build(tree_.traits().compute_bbox_object(), [](auto, auto, const CGAL::Bbox_3&) {});
  if (tree_.size() < 2) return;  // it has no nodes
  root_ = tree_.root_node();
  oriented_.resize(tree_.size() - 1);
  constexpr double in_single_precision = 1e30;
  double extent = 0;
  for (const Vector<3>& v : mesh.vertices) extent = std::max(extent, v.cwiseAbs().maxCoeff());
  if (extent < in_single_precision && extent > 1 / in_single_precision) orient(*root_, tree_.size(), extent);
}

void WallTree::orient(const Node& node, std::size_t leaves, double extent) {
  constexpr std::size_t flat = 4096;  // larger nodes are hardly ever flat
  if (leaves <= flat)
    oriented_[static_cast<std::size_t>(&node - root_)] = OrientedBox(leaves_of(node, leaves), extent);
  if (leaves <= leaves_a_group) return;
  const auto one = [&] { orient(node.left_child(), leaves / 2, extent); };
  const auto other = [&] { orient(node.right_child(), leaves - leaves / 2, extent); };
  if (leaves > flat) {
    parallel_both(one, other);
  } else {
    one();
    other();
  }
}

}  // namespace bernal::cad
