#include "meshes/improve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "core/parallel.hpp"
#include "meshes/tetrahedra_near.hpp"

namespace bernal {
namespace {

/// What a change has to gain, so that changes end.
constexpr double least_gain = 1e-4;

/// The tetrahedron with one corner replaced.
TetrahedronCorners with(TetrahedronCorners corners, std::uint32_t old, std::uint32_t by) {
  std::ranges::replace(corners, old, by);
  return corners;
}

class Improver {
 public:
  Improver(VolumeMesh& mesh, const ImproveOptions& options)
      : near_(mesh, options.for_gradients), options_(options) {}

  ImproveReport run(const Monitor& monitor) {
    for (; report_.passes < options_.passes; ++report_.passes) {
      const std::vector<std::uint32_t> bad = near_.look(options_.goal);
      if (bad.empty()) break;
      monitor.report({"improve", static_cast<double>(report_.passes) / options_.passes,
                      fmt::format("{} tetrahedra of SICN below {}, the least {:.3f}", grouped(bad.size()),
                                  options_.goal, near_.quality(bad.front()))});
      before_ = near_.take_touched();
      std::size_t changed = 0;
      for (const std::uint32_t t : bad) {
        throw_if_interrupted();
        if (is_new(t) && near_.quality(t) < options_.goal) changed += mend(t);
      }
      if (changed == 0) break;
    }
    near_.close();
    return report_;
  }

 private:
  /// Whether something near it has changed since it was last looked at.
  bool is_new(std::uint32_t t) const {
    return near_.is_there(t) &&
           (report_.passes == 0 || std::ranges::any_of(near_.corners(t), [&](std::uint32_t vertex) {
              return vertex >= before_.size() || before_[vertex];
            }));
  }

  bool mend(std::uint32_t t) {
    bool changed = false;
    const TetrahedronCorners corners = near_.corners(t);
    for (const std::uint32_t vertex : corners) changed |= smooth(vertex);
    const auto is_done = [&] { return !near_.is_there(t) || near_.quality(t) >= options_.goal; };
    if (is_done()) return changed;
    for (const auto& [i, j] : edges_of_tetrahedron)
      if (remove_edge(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(j)]))
        return ++report_.swapped > 0;
    for (int k = 0; k < 4; ++k)
      if (remove_face(t, k)) return ++report_.swapped > 0;
    for (const std::uint32_t vertex : corners)
      if (remove_vertex(vertex)) return ++report_.removed > 0;
    if (insert(t)) return ++report_.inserted > 0;
    return changed;
  }

  /// Moves a vertex to where the least SICN of its star is greatest: uphill for the worst one, and where
  /// several hold each other, in directions that have nothing to do with them.
  bool smooth(std::uint32_t vertex) {
    if (!near_.is_free(vertex) || !near_.has_star(vertex)) return false;
    const auto& star = near_.star(vertex);
    if (star.empty()) return false;
    const Vector<3> begin = near_.at(vertex);
    double height = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : star)
      for (const std::uint32_t other : near_.corners(t))
        if (other != vertex) height = std::min(height, (near_.at(other) - begin).norm());
    const double before = near_.least_quality(star);
    double best = before;
    Vector<3> place = begin;
    const auto is_better = [&](const Vector<3>& to) {
      near_.move(vertex, to);
      const double quality = near_.least_quality(star);
      if (quality > best + 1e-3 * least_gain) {
        best = quality;
        place = to;
        return true;
      }
      near_.move(vertex, place);
      return false;
    };
    for (double step = 0.5 * height; step > 0.01 * height;) {
      bool moved = is_better(place + step * uphill(vertex, step));
      for (std::size_t k = 0; !moved && k < directions.size(); ++k)
        moved = is_better(place + step * Vector<3>(directions[k][0], directions[k][1], directions[k][2]));
      if (!moved) step *= 0.5;
    }
    if (best >= before + least_gain) {
      for (const std::uint32_t t : star) near_.touch(t);
      return ++report_.moved > 0;
    }
    near_.move(vertex, begin);
    return false;
  }

  /// The direction in which the SICN of the worst one around rises most.
  Vector<3> uphill(std::uint32_t vertex, double step) {
    std::uint32_t worst = near_.star(vertex).front();
    double least = 2;
    for (const std::uint32_t t : near_.star(vertex))
      if (const double quality = near_.quality(t); quality < least) {
        least = quality;
        worst = t;
      }
    const Vector<3> here = near_.at(vertex);
    const double small = 1e-3 * step;
    Vector<3> rise = Vector<3>::Zero();
    for (int k = 0; k < 3; ++k) {
      Vector<3> there = here;
      there[k] += small;
      near_.move(vertex, there);
      rise[k] = near_.quality(worst) - least;
    }
    near_.move(vertex, here);
    return rise.squaredNorm() > 0 ? rise.normalized() : rise;
  }

  /// The vertices around an edge a, b in their order, each tetrahedron being (a, b, ring[k], ring[k + 1]).
  /// Nothing where the edge lies on the surface.
  std::vector<std::uint32_t> ring_of(std::uint32_t a, std::uint32_t b,
                                     std::span<const std::uint32_t> around) const {
    std::vector<std::array<std::uint32_t, 2>> sides;
    for (const std::uint32_t t : around) {
      if (near_.region(t) != near_.region(around[0])) return {};
      // Even permutations bring a and b to the front and keep the orientation.
      TetrahedronCorners c = near_.corners(t);
      const auto to_front = [&](std::size_t place, std::uint32_t vertex) {
        const auto at = static_cast<std::size_t>(std::ranges::find(c, vertex) - c.begin());
        if (at == place) return;
        std::swap(c[place], c[at]);
        std::swap(c[2], c[3]);
      };
      to_front(0, a);
      if (c[1] != b) {
        if (c[2] == b)
          c = {c[0], c[2], c[3], c[1]};
        else
          c = {c[0], c[3], c[1], c[2]};
      }
      sides.push_back({c[2], c[3]});
    }
    std::vector<std::uint32_t> ring{sides[0][0]};
    while (ring.size() < sides.size()) {
      const auto next = std::ranges::find(sides, ring.back(), [](const auto& side) { return side[0]; });
      if (next == sides.end()) return {};
      ring.push_back((*next)[1]);
    }
    const auto last = std::ranges::find(sides, ring.back(), [](const auto& side) { return side[0]; });
    if (last == sides.end() || (*last)[1] != ring[0]) return {};
    return ring;
  }

  /// Replaces those around an edge by two for each triangle of a triangulation of the ring, the best one,
  /// which dynamic programming finds. Source: Shewchuk, Two Discrete Optimization Algorithms for the
  /// Topological Improvement of Tetrahedral Meshes (2002).
  bool remove_edge(std::uint32_t a, std::uint32_t b) {
    constexpr std::size_t longest_ring = 9;
    if (!near_.has_star(a)) return false;
    const std::vector<std::uint32_t> old = near_.around(a, b);
    if (old.size() < 3 || old.size() > longest_ring) return false;
    const std::vector<std::uint32_t> ring = ring_of(a, b, old);
    const std::size_t n = ring.size();
    if (n < 3) return false;
    std::array<std::array<double, longest_ring>, longest_ring> best{};
    std::array<std::array<std::size_t, longest_ring>, longest_ring> middle{};
    const auto pair_of = [&](std::size_t i, std::size_t k, std::size_t j) {
      return std::array<TetrahedronCorners, 2>{
          {{ring[i], ring[k], ring[j], b}, {ring[i], ring[j], ring[k], a}}};
    };
    for (std::size_t i = 0; i < n; ++i)
      if (i + 1 < n) best[i][i + 1] = 1;
    for (std::size_t length = 2; length < n; ++length)
      for (std::size_t i = 0; i + length < n; ++i) {
        const std::size_t j = i + length;
        best[i][j] = -1;
        for (std::size_t k = i + 1; k < j; ++k) {
          const auto two = pair_of(i, k, j);
          const double quality =
              std::min({best[i][k], best[k][j], near_.quality(two[0]), near_.quality(two[1])});
          if (quality <= best[i][j]) continue;
          best[i][j] = quality;
          middle[i][j] = k;
        }
      }
    if (best[0][n - 1] < std::max(0.0, near_.least_quality(old)) + least_gain) return false;
    std::vector<TetrahedronCorners> made;
    std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = middle[i][j];
      for (const TetrahedronCorners& corners : pair_of(i, k, j)) made.push_back(corners);
      open.push_back({i, k});
      open.push_back({k, j});
    }
    near_.replace(old, made);
    return true;
  }

  /// Replaces two that share a face by three around the edge between the corners opposite it.
  bool remove_face(std::uint32_t t, int corner) {
    const std::uint32_t other = near_.behind(t, corner);
    if (other == TetrahedraNear::none) return false;
    const auto& face = faces_of_tetrahedron[static_cast<std::size_t>(corner)];
    const TetrahedronCorners c = near_.corners(t), d = near_.corners(other);
    std::array<std::uint32_t, 3> of{};
    for (std::size_t k = 0; k < 3; ++k) of[k] = c[static_cast<std::size_t>(face[k])];
    const std::uint32_t here = c[static_cast<std::size_t>(corner)];
    std::uint32_t there = d[0];
    for (const std::uint32_t v : d)
      if (std::ranges::find(of, v) == of.end()) there = v;
    std::array<TetrahedronCorners, 3> made{};
    double quality = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      made[k] = {here, there, of[k], of[(k + 1) % 3]};
      quality = std::min(quality, near_.quality(made[k]));
    }
    const std::array<std::uint32_t, 2> old = {t, other};
    if (quality < std::max(0.0, near_.least_quality(old)) + least_gain) return false;
    near_.replace(old, made);
    return true;
  }

  /// Pulls a vertex into another one around it, where that leaves better ones.
  bool remove_vertex(std::uint32_t vertex) {
    if (!near_.is_free(vertex) || !near_.has_star(vertex)) return false;
    const std::vector<std::uint32_t> old = near_.star(vertex);
    if (old.empty()) return false;
    std::vector<std::uint32_t> others;
    for (const std::uint32_t t : old)
      for (const std::uint32_t other : near_.corners(t))
        if (other != vertex) others.push_back(other);
    std::ranges::sort(others);
    others.erase(std::ranges::unique(others).begin(), others.end());
    double best = std::max(0.0, near_.least_quality(old)) + least_gain;
    std::optional<std::uint32_t> into;
    for (const std::uint32_t other : others) {
      double quality = 1;
      for (const std::uint32_t t : old)
        if (std::ranges::find(near_.corners(t), other) == near_.corners(t).end())
          quality = std::min(quality, near_.quality(with(near_.corners(t), vertex, other)));
      if (quality <= best) continue;
      best = quality;
      into = other;
    }
    if (!into) return false;
    std::vector<TetrahedronCorners> made;
    for (const std::uint32_t t : old)
      if (std::ranges::find(near_.corners(t), *into) == near_.corners(t).end())
        made.push_back(with(near_.corners(t), vertex, *into));
    near_.replace(old, made);
    return true;
  }

  /// Puts a vertex into the middle of the tetrahedron, or else of one of its edges.
  bool insert(std::uint32_t t) {
    const TetrahedronCorners c = near_.corners(t);
    if (insert(t, (near_.at(c[0]) + near_.at(c[1]) + near_.at(c[2]) + near_.at(c[3])) / 4)) return true;
    return std::ranges::any_of(edges_of_tetrahedron, [&](const auto& edge) {
      return insert(t, 0.5 * (near_.at(c[static_cast<std::size_t>(edge[0])]) +
                              near_.at(c[static_cast<std::size_t>(edge[1])])));
    });
  }

  /// Joins a vertex at this place to the faces around a cavity, which grows over the neighbours behind faces
  /// that it would make poor tetrahedra with. If not, the tetrahedron may get another number.
  bool insert(std::uint32_t& t, const Vector<3>& place) {
    constexpr std::size_t largest_cavity = 32;
    std::vector<std::uint32_t> cavity{t};
    const std::uint32_t vertex = near_.add_vertex(place);
    std::vector<TetrahedronCorners> made, best_made;
    std::vector<std::uint32_t> best_cavity;
    double best_gain = -1;
    while (cavity.size() <= largest_cavity) {
      made.clear();
      double worst = 2;
      std::uint32_t next = TetrahedraNear::none;
      for (const std::uint32_t of : cavity)
        for (int k = 0; k < 4; ++k) {
          const std::uint32_t behind = near_.behind(of, k);
          if (behind != TetrahedraNear::none && std::ranges::find(cavity, behind) != cavity.end()) continue;
          const auto& face = faces_of_tetrahedron[static_cast<std::size_t>(k)];
          const auto corner = [&](std::size_t i) {
            return near_.corners(of)[static_cast<std::size_t>(face[i])];
          };
          made.push_back({corner(0), corner(2), corner(1), vertex});
          const double quality = near_.quality(made.back());
          if (behind == TetrahedraNear::none || quality >= worst) continue;
          worst = quality;
          next = behind;
        }
      double quality = 1;
      for (const TetrahedronCorners& corners : made) quality = std::min(quality, near_.quality(corners));
      const double gain = quality - std::max(0.0, near_.least_quality(cavity));
      if (quality > 0 && gain > best_gain) {
        best_gain = gain;
        best_made = made;
        best_cavity = cavity;
      }
      if (next == TetrahedraNear::none) break;
      cavity.push_back(next);
    }
    if (best_made.empty()) {
      near_.drop_vertex();
      return false;
    }
    // Whether it is better shows where the vertex has found its place.
    const double before = std::max(0.0, near_.least_quality(best_cavity));
    std::vector<TetrahedronCorners> old;
    for (const std::uint32_t of : best_cavity) old.push_back(near_.corners(of));
    near_.replace(best_cavity, best_made);
    smooth(vertex);
    const std::vector<std::uint32_t> star = near_.star(vertex);
    if (near_.least_quality(star) >= before + least_gain) return true;
    near_.replace(star, old);
    near_.drop_vertex();
    t = *std::ranges::find_if(near_.star(old[0][0]),
                              [&](std::uint32_t at) { return near_.corners(at) == old[0]; });
    return false;
  }

  static constexpr double s = 0.57735026918962576;
  static constexpr std::array<std::array<double, 3>, 14> directions = {{{1, 0, 0},
                                                                        {-1, 0, 0},
                                                                        {0, 1, 0},
                                                                        {0, -1, 0},
                                                                        {0, 0, 1},
                                                                        {0, 0, -1},
                                                                        {s, s, s},
                                                                        {s, s, -s},
                                                                        {s, -s, s},
                                                                        {s, -s, -s},
                                                                        {-s, s, s},
                                                                        {-s, s, -s},
                                                                        {-s, -s, s},
                                                                        {-s, -s, -s}}};

  TetrahedraNear near_;
  ImproveOptions options_;
  ImproveReport report_;
  std::vector<std::uint8_t> before_;  ///< vertices that the pass before touched
};

}  // namespace

ImproveReport improve(VolumeMesh& mesh, const ImproveOptions& options, const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  return Improver(mesh, options).run(monitor);
}

}  // namespace bernal
