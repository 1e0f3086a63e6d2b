#pragma once
#if __has_include(<CGAL/AABB_traits_3.h>)  // CGAL 6 has two, by dimension
#include <CGAL/AABB_traits_3.h>
#else
#include <CGAL/AABB_traits.h>
#endif
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "cad/oriented_box.hpp"
#include "cad/wall_triangle.hpp"

namespace bernal::cad {

using WallKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// So many triangles are looked at one by one: that is cheaper than the boxes of the last levels of the tree.
constexpr std::size_t leaves_a_group = 4;

inline WallKernel::Point_3 to_cgal(const Vector<3>& p) { return {p[0], p[1], p[2]}; }

/// The tree's leaves own their triangles, so that a query reads them in the order of the tree.
class Leaf {
 public:
  using Id = std::uint32_t;
  using Point = WallKernel::Point_3;
  using Datum = WallKernel::Triangle_3;

  explicit Leaf(std::vector<WallTriangle>::const_iterator triangle)
      : triangle_(*triangle),
        normal_((triangle->b - triangle->a).cross(triangle->c - triangle->a).normalized()) {}
  const WallTriangle& triangle() const { return triangle_; }
  const Vector<3>& normal() const { return normal_; }

  /// min u·(p - v) over the vertices v: a lower bound of the distance of p for every unit vector u.
  double depth_along(const Vector<3>& u, const Vector<3>& p,
                     const Vector<3>& step = Vector<3>::Zero()) const {
    return std::min(std::min(u.dot(p - triangle_.a), u.dot(p - triangle_.b)), u.dot(p - triangle_.c)) +
           std::min(u.dot(step), 0.0);
  }
  /// That bound for the better of both normals and all points between p and p + step. Where the triangle is a
  /// needle its normal is inaccurate, and the bound still is one.
  double depth_along_normal(const Vector<3>& p, const Vector<3>& step = Vector<3>::Zero()) const {
    const double a = normal_.dot(p - triangle_.a), b = normal_.dot(p - triangle_.b),
                 c = normal_.dot(p - triangle_.c), s = normal_.dot(step);
    const double above = std::min(std::min(a, b), c) + std::min(s, 0.0);
    const double below = -std::max(std::max(a, b), c) - std::max(s, 0.0);
    return std::max(above, below);
  }
  Id id() const { return triangle_.id; }
  Point reference_point() const { return to_cgal(triangle_.a); }
  Datum datum() const { return {to_cgal(triangle_.a), to_cgal(triangle_.b), to_cgal(triangle_.c)}; }

 private:
  WallTriangle triangle_;
  Vector<3> normal_;
};

#if __has_include(<CGAL/AABB_traits_3.h>)
using TreeTraits = CGAL::AABB_traits_3<WallKernel, Leaf>;
#else
using TreeTraits = CGAL::AABB_traits<WallKernel, Leaf>;
#endif
using Tree = CGAL::AABB_tree<TreeTraits>;
using Node = CGAL::AABB_node<TreeTraits>;

/// A CGAL tree of the triangles of a wall, with two additions of our own.
///
/// CGAL halves the leaves of a node along the longest axis of its box; in a wall of long needles that cuts
/// across all of them, where nothing tells them apart. Here they are halved on the axis on which their
/// centres differ most. And beside the box of each node that a search may enter stands a box that is
/// oriented, where that tells more. It is found by the node's place in CGAL's array of nodes, which has no
/// public name.
///
/// What that buys, in processor time of insert, compress, shake and refill in a round vessel: CGAL's halving
/// takes 3.2 times as long where 3000 needles stand upright, and to do without oriented boxes takes 2.5 times
/// as long where 400 are tilted; parts of well-shaped triangles take as long either way.
class WallTree {
 public:
  explicit WallTree(const Mesh& mesh);

  const Tree& tree() const { return tree_; }
  template <class Traversal>
  void search_nearest_first(const Vector<3>& p, Traversal& traversal) const {
    tree_.traversal_with_priority_and_group_traversal(p, traversal, leaves_a_group);
  }
  const OrientedBox& oriented(const Node& node) const {
    return oriented_[static_cast<std::size_t>(&node - root_)];
  }

 private:
  void orient(const Node& node, std::size_t leaves, double extent);

  Tree tree_;
  const Node* root_ = nullptr;
  std::vector<OrientedBox> oriented_;
};

}  // namespace bernal::cad
