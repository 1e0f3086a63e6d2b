#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"
#include "cad/wall_triangle.hpp"

namespace bernal::cad {

enum class Side : std::uint8_t { inside, wall, outside };

/// The triangles of a closed mesh in a CGAL AABB tree, and the questions a container asks of them. All
/// queries are const and may run in several threads.
///
/// Every search runs nearest first and shrinks as it finds: a box is entered only if it is nearer than the
/// best triangle so far, and a moving sphere enters only boxes on the way to its first contact so far.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);
  ~TriangleTree();
  TriangleTree(TriangleTree&&) noexcept;

  /// Distance to the nearest triangle if that is below `bound`, else `bound`. Error: a few roundoffs of the
  /// largest coordinate.
  double distance(const Vector<3>& p, double bound) const;

  /// Whether no triangle is nearer to c than r.
  bool clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const;

  /// Appends the triangles nearer than `reach`, nearest first.
  void within(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const;

  /// See Container::first_contact.
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                       double skin) const;

  /// On which side of the wall p is, exactly, whatever p: parity of the triangles above p in exact
  /// predicates, with p moved by infinitesimals so that no edge or vertex is hit.
  Side side(const Vector<3>& p) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bernal::cad
