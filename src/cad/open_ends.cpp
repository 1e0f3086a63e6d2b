#include "cad/open_ends.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bernal/cad/read_mesh.hpp"
#include "cad/repair/lids.hpp"
#include "cad/repeated_container.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"
#include "geometry/openings.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

/// In words: more than that is asked of nobody.
constexpr std::string_view remedy =
    "make both ends the same section with the same corners, a period apart, or take \"periodic\" out";

[[noreturn]] void refuse(const std::string& why) {
  throw OptionError("periodic", fmt::format("{}; {}", why, remedy));
}

std::string place(const Vector<3>& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]); }
char name_of_axis(int axis) { return static_cast<char>('x' + axis); }

/// The spacing of coordinates up to 128 times the largest of the mesh along an axis.
double grid_along(const Bounds<3>& bounds, int axis) {
  const double largest = std::max(std::abs(bounds.lower[axis]), std::abs(bounds.upper[axis]));
  constexpr int bits = 53, room = 7;
  return std::ldexp(1.0, std::ilogb(largest) + 1 + room - bits);
}

/// Rounds all corners along an axis, those near its ends into the end planes.
void level_ends(Mesh& mesh, int axis, double tolerance) {
  const Bounds<3> bounds = bounds_of(mesh);
  if (!(bounds.size()[axis] > 4 * tolerance))
    refuse(fmt::format("the mesh is flat along {}", name_of_axis(axis)));
  const double grid = grid_along(bounds, axis);
  const auto rounded = [&](double x) { return std::nearbyint(x / grid) * grid; };
  const double lower = rounded(bounds.lower[axis]), upper = rounded(bounds.upper[axis]);
  for (Vector<3>& v : mesh.vertices) {
    double& x = v[axis];
    x = x <= lower + tolerance ? lower : x >= upper - tolerance ? upper : rounded(x);
  }
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The edges around the triangles in one end plane, in their sense.
std::set<Edge> rim_at(const Mesh& mesh, int axis, double plane) {
  std::set<Edge> edges;
  for (const FaceCorners& t : mesh.triangles) {
    if (!lies_in_plane(mesh, t, axis, plane)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (edges.erase({b, a}) == 0) edges.insert({a, b});
    }
  }
  return edges;
}

std::vector<std::uint32_t> corners_of(const std::set<Edge>& rim) {
  std::set<std::uint32_t> corners;
  for (const auto& [a, b] : rim) corners.insert(a);
  return {corners.begin(), corners.end()};
}

/// Finds the nearest corner of a rim, seen along the axis.
class RimCorners {
 public:
  RimCorners(const Mesh& mesh, const std::set<Edge>& rim, int axis, double tolerance)
      : mesh_(mesh),
        u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        tolerance_(tolerance),
        corners_(corners_of(rim)) {
    std::ranges::sort(corners_, {}, [&](std::uint32_t c) { return mesh.vertices[c][u_]; });
  }

  const std::vector<std::uint32_t>& all() const { return corners_; }

  /// Those within the tolerance, the nearest first.
  std::vector<std::pair<double, std::uint32_t>> near(const Vector<3>& p) const {
    std::vector<std::pair<double, std::uint32_t>> found;
    const auto first = std::ranges::lower_bound(corners_, p[u_] - tolerance_, {},
                                                [&](std::uint32_t c) { return mesh_.vertices[c][u_]; });
    for (auto it = first; it != corners_.end() && mesh_.vertices[*it][u_] <= p[u_] + tolerance_; ++it)
      if (const double d = away(p, *it); d <= tolerance_) found.emplace_back(d, *it);
    std::ranges::sort(found);
    return found;
  }
  double nearest(const Vector<3>& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : corners_) least = std::min(least, away(p, c));
    return least;
  }

 private:
  double away(const Vector<3>& p, std::uint32_t c) const {
    const Vector<3>& q = mesh_.vertices[c];
    return std::hypot(p[u_] - q[u_], p[v_] - q[v_]);
  }

  const Mesh& mesh_;
  int u_, v_;
  double tolerance_;
  std::vector<std::uint32_t> corners_;
};

/// The ends of one axis.
class TwoEnds {
 public:
  TwoEnds(Mesh& mesh, int axis, double tolerance)
      : mesh_(mesh), axis_(axis), tolerance_(tolerance), bounds_(bounds_of(mesh)) {
    lower_ = rim_at(mesh, axis, bounds_.lower[axis]);
    upper_ = rim_at(mesh, axis, bounds_.upper[axis]);
    for (const bool above : {false, true})
      if ((above ? upper_ : lower_).empty())
        refuse(fmt::format("the mesh has no flat end at {} = {:.6g}: nothing goes on there",
                           name_of_axis(axis), (above ? bounds_.upper : bounds_.lower)[axis]));
  }

  /// Puts the upper rims above the lower ones. Returns the farthest that a corner has moved.
  double match() {
    const RimCorners lower(mesh_, lower_, axis_, tolerance_), upper(mesh_, upper_, axis_, tolerance_);
    if (lower.all().size() != upper.all().size()) refuse_odd_one(lower, upper);
    std::map<std::uint32_t, std::uint32_t> below;
    std::set<std::uint32_t> taken;
    double farthest = 0;
    for (const std::uint32_t c : upper.all()) {
      const Vector<3>& p = mesh_.vertices[c];
      const auto near = lower.near(p);
      if (near.empty()) refuse_apart(p, lower.nearest(p));
      if (!taken.insert(near.front().second).second || (near.size() > 1 && near[1].first == near[0].first))
        refuse(
            fmt::format("corners of the end at {} = {:.6g} near {} are nearer to each other than \"weld\", "
                        "{:.2g}",
                        name_of_axis(axis_), bounds_.upper[axis_], place(p), tolerance_));
      below[c] = near.front().second;
      farthest = std::max(farthest, near.front().first);
    }
    for (const auto& [a, b] : upper_)
      if (!lower_.contains({below.at(b), below.at(a)}))
        refuse(
            fmt::format("the rims of the ends at {0} = {1:.6g} and {2:.6g} join their corners differently, "
                        "as from {3} to {4}",
                        name_of_axis(axis_), bounds_.lower[axis_], bounds_.upper[axis_],
                        place(mesh_.vertices[a]), place(mesh_.vertices[b])));
    for (const auto& [above, under] : below) {
      const double level = mesh_.vertices[above][axis_];
      mesh_.vertices[above] = mesh_.vertices[under];
      mesh_.vertices[above][axis_] = level;
    }
    return farthest;
  }

  double period() const { return bounds_.size()[axis_]; }

 private:
  [[noreturn]] void refuse_apart(const Vector<3>& p, double distance) const {
    refuse(fmt::format(
        "the ends at {0} = {1:.6g} and {2:.6g} do not match: the corner {3} of one rim is "
        "{4:.3g} from the nearest of the other, seen along {0}, and {5:.2g} is allowed by "
        "\"weld\"",
        name_of_axis(axis_), bounds_.lower[axis_], bounds_.upper[axis_], place(p), distance, tolerance_));
  }
  [[noreturn]] void refuse_odd_one(const RimCorners& lower, const RimCorners& upper) const {
    for (const auto& [one, other] : {std::pair(&lower, &upper), std::pair(&upper, &lower)})
      for (const std::uint32_t c : one->all())
        if (const Vector<3>& p = mesh_.vertices[c]; other->near(p).empty())
          refuse_apart(p, other->nearest(p));
    refuse(fmt::format("the rims at {} = {:.6g} and {:.6g} have {} and {} corners", name_of_axis(axis_),
                       bounds_.lower[axis_], bounds_.upper[axis_], lower.all().size(), upper.all().size()));
  }

  Mesh& mesh_;
  int axis_;
  double tolerance_;
  Bounds<3> bounds_;
  std::set<Edge> lower_, upper_;
};

}  // namespace

void close_ends(Mesh& mesh, const std::array<bool, 3>& axes, double tolerance) {
  if (topology_of(mesh).open_edges == 0) return;
  const Bounds<3> bounds = bounds_of_faces(mesh);
  Mesh closed = mesh;
  std::vector<bool> kept(mesh.triangles.size(), true);
  for (const Lid& lid : put_lids(closed)) {
    bool at_end = false;
    for (int k = 0; k < 3; ++k)
      at_end |= axes[static_cast<std::size_t>(k)] && (lid.bounds.upper[k] <= bounds.lower[k] + tolerance ||
                                                      lid.bounds.lower[k] >= bounds.upper[k] - tolerance);
    kept.resize(std::max(kept.size(), lid.last), false);
    std::fill(kept.begin() + static_cast<std::ptrdiff_t>(lid.first),
              kept.begin() + static_cast<std::ptrdiff_t>(lid.last), at_end);
  }
  kept.resize(closed.triangles.size(), false);
  keep_only(closed, kept);
  mesh = std::move(closed);
}

std::string open_ends(Mesh& mesh, const std::array<bool, 3>& axes, double tolerance) {
  drop_unused_vertices(mesh);
  mesh.exact = nullptr;
  std::string done;
  for (int k = 0; k < 3; ++k)
    if (axes[static_cast<std::size_t>(k)]) level_ends(mesh, k, tolerance);
  for (int k = 0; k < 3; ++k) {
    if (!axes[static_cast<std::size_t>(k)]) continue;
    TwoEnds ends(mesh, k, tolerance);
    const double moved = ends.match();
    done += fmt::format("{}repeats itself along {} every {:.9g}", done.empty() ? "" : ", ", name_of_axis(k),
                        ends.period());
    if (moved > 0) done += fmt::format(", where its ends matched to {:.2g}", moved);
  }
  mesh.periodic = axes;
  try {
    images_around(mesh);
  } catch (const Error& error) {
    throw OptionError("periodic", error.what());
  }
  return done;
}

}  // namespace bernal::cad
