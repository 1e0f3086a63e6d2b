#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "bernal/domain/container.hpp"
#include "cad/wall_triangle.hpp"
#include "domain/motion.hpp"

namespace bernal::cad {

class WallTree;

/// The end of an unbounded ray, for `TriangleTree::crossing`.
inline constexpr double endless = std::numeric_limits<double>::infinity();

enum class Crossing : std::uint8_t { even, odd, starts_on_wall };

/// The triangles of a closed mesh in a CGAL AABB tree, and a container's queries of them. All queries are
/// const and may run in several threads.
///
/// Searches run nearest first with a shrinking bound: a box is entered only if it is nearer than the best
/// triangle so far; a moving sphere enters only boxes before its first contact so far. Besides its box a node
/// of several triangles has an oriented box, which is tighter on smooth walls; skipping by it does not change
/// a bit of the answer.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);
  ~TriangleTree();
  TriangleTree(TriangleTree&&) noexcept;

  /// Distance to the nearest triangle if below `bound`, else `bound`. Error: a few roundoffs of the largest
  /// coordinate.
  double distance(const Vector<3>& p, double bound) const;

  /// The same, too large by at most `slack`: in the middle of a round part, equally far from everything, the
  /// boxes of the tree then replace thousands of triangles.
  double rough_distance(const Vector<3>& p, double bound, double slack) const;

  /// Whether every triangle is at least r away from c.
  bool clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const;

  /// Appends the triangles nearer than `reach`, nearest first; if there are more than `most`, appends some
  /// and returns false.
  bool within(const Vector<3>& c, double reach, std::vector<NearFacet>& out,
              std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// See Container::contacts.
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const;

  /// See Container::first_contact.
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                       double skin) const;

  /// See Container::free_path, filtered or exact; `bound` is its `free_path_bound`.
  double free_path(const Motion& motion, double bound, WallArithmetic arithmetic) const;

  /// Whether p is on the wall and, if not, the parity of the crossings of the wall on the segment from p
  /// along the axis to the coordinate `end`, exactly. The end must not be on the wall; infinity is safe. The
  /// second form skips triangles for which ignored(number) is true.
  Crossing crossing(const Vector<3>& p, int axis, double end) const;
  Crossing crossing(const Vector<3>& p, int axis, double end,
                    const std::function<bool(std::uint32_t)>& ignored) const;

  /// Winding number of the wall around p: on the ray from p along the axis, the triangles crossed from back
  /// to front minus those crossed from front to back, exactly. Absent if p is on a triangle. Skips triangles
  /// for which ignored(number) is true.
  std::optional<int> winding(const Vector<3>& p, int axis,
                             const std::function<bool(std::uint32_t)>& ignored) const;

 private:
  std::unique_ptr<const WallTree> tree_;
};

}  // namespace bernal::cad
