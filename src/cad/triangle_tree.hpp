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

/// The end of a way that leaves everything, for `TriangleTree::crossing`.
inline constexpr double endless = std::numeric_limits<double>::infinity();

enum class Crossing : std::uint8_t { even, odd, starts_on_wall };

/// The triangles of a closed mesh in a CGAL AABB tree, and the questions a container asks of them. All
/// queries are const and may run in several threads.
///
/// Every search runs nearest first and shrinks as it finds: a box is entered only if it is nearer than the
/// best triangle so far, and a moving sphere enters only boxes on the way to its first contact so far. Beside
/// its box a node of some triangles has a disc, which tells more of a smooth wall; what it leaves out would
/// not have changed a bit of the answer.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);
  ~TriangleTree();
  TriangleTree(TriangleTree&&) noexcept;

  /// Distance to the nearest triangle if that is below `bound`, else `bound`. Error: a few roundoffs of the
  /// largest coordinate.
  double distance(const Vector<3>& p, double bound) const;

  /// The same, too large by at most `slack`: in the middle of a round part, from which everything is equally
  /// near, the boxes of the tree then answer for thousands of triangles.
  double rough_distance(const Vector<3>& p, double bound, double slack) const;

  /// Whether no triangle is nearer to c than r.
  bool clears(const Vector<3>& c, double r, WallArithmetic arithmetic) const;

  /// Appends the triangles nearer than `reach`, nearest first; or returns false where these are more than
  /// `most`, and appends some.
  bool within(const Vector<3>& c, double reach, std::vector<NearFacet>& out,
              std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  /// See Container::contacts.
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const;

  /// See Container::first_contact.
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                       double skin) const;

  /// See Container::free_path, filtered or exact; `bound` is its `free_path_bound`.
  double free_path(const Motion& motion, double bound, WallArithmetic arithmetic) const;

  /// Whether p is on the wall and, if not, whether the way from p along the axis to the coordinate `end`
  /// crosses the wall an odd number of times, exactly. Its end must not be on the wall; infinity is a good
  /// end. The second form looks at no triangle for which ignored(its number) holds.
  Crossing crossing(const Vector<3>& p, int axis, double end) const;
  Crossing crossing(const Vector<3>& p, int axis, double end,
                    const std::function<bool(std::uint32_t)>& ignored) const;

  /// How often the wall winds around p: on the way from p along the axis to infinity, how many triangles more
  /// are crossed from their back than from their front, exactly. Nothing where p is on a triangle. Looks at
  /// no triangle for which ignored(its number) holds.
  std::optional<int> winding(const Vector<3>& p, int axis,
                             const std::function<bool(std::uint32_t)>& ignored) const;

 private:
  std::unique_ptr<const WallTree> tree_;
};

}  // namespace bernal::cad
