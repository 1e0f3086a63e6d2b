#include "soft/fill_by_relaxation.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "soft/crowd.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// So often in a row stirring may leave the spheres no freer than before; and where there are far too many.
constexpr double patience = 20, hopeless_patience = 3;
constexpr int failures_a_burst = 2;
/// Taken out of the spheres, at most, at a time: squeeze says little where a box is asked to hold several
/// times its fill.
constexpr double most_taken_out = 0.2;
/// For that there are so many sweeps more, in those of the limit.
constexpr double more_sweeps = 1;
/// Moves, in radii of the smallest, that break the symmetry of spheres which come in a lattice or in line.
constexpr double jitter = 1e-6;
/// Radii that centres stay away from walls, for the rounding of who adds them up.
constexpr double before_wall = 1 + 1e-12;
/// Rods along a line, in random order, with gaps between them as they come by chance but none of which is
/// less than half of the mean. They overlap where they have to.
Spheres<1> in_line(Spheres<1> spheres, double edge, double allowed, Random& random) {
  const std::size_t n = spheres.size();
  double room = edge;
  for (const double r : spheres.r) room -= 2 * (1 - allowed) * r;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  std::vector<double> offsets(n);
  for (double& offset : offsets) offset = 0.5 * room * random.uniform();
  std::ranges::sort(offsets);
  double end = 0;  // of the rod before
  for (std::size_t k = 0; k < n; ++k) {
    const double r = (1 - allowed) * spheres.r[order[k]],
                 even = 0.5 * room * static_cast<double>(k) / static_cast<double>(n);
    spheres.set_center(order[k], Boundary<1>{Vector<1>(edge)}.wrap(Vector<1>(end + r + even + offsets[k])));
    end += 2 * r;
  }
  return spheres;
}

/// What reaches beyond a wall goes back to just before it.
template <int D>
void move_between_walls(Spheres<D>& spheres, const Vector<D>& edges, const Task& task) {
  for (int k = 0; k < D; ++k) {
    if (!task.has_wall(k)) continue;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double low = std::min(before_wall * spheres.r[i], 0.5 * edges[k]);
      double& x = spheres.x[static_cast<std::size_t>(k)][i];
      x = std::clamp(x, low, edges[k] - low);
    }
  }
}

template <int D>
Spheres<D> starting_places(const SpheresInBox& in_box, Random& random) {
  Spheres<D> spheres = in_box.spheres.in<D>();
  const Vector<D> edges = *in_box.task.target_edges;
  if (in_box.placed) {
    Vector<D> now = in_box.edges;
    resize_box<D>(spheres, now, edges);
  } else if constexpr (D == 1) {
    spheres = in_line(std::move(spheres), edges[0], in_box.task.allowed_overlap, random);
  } else {
    place_at_random(spheres, edges, random);
  }
  move_between_walls<D>(spheres, edges, in_box.task);
  return spheres;
}

/// The numbers of those that are left when, again and again, the one that overlaps most others has gone, the
/// last of those.
template <int D>
std::vector<std::uint32_t> without_overlap(const Spheres<D>& spheres, const Vector<D>& edges,
                                           double allowed) {
  const auto pairs = overlapping<D>(spheres, edges, allowed);
  std::vector<std::vector<std::uint32_t>> others(spheres.size());
  for (const auto& [i, j] : pairs) {
    others[i].push_back(j);
    others[j].push_back(i);
  }
  std::vector<std::size_t> overlaps(spheres.size());
  std::set<std::pair<std::size_t, std::uint32_t>> most;  // ascending in the number of overlaps
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    overlaps[i] = others[i].size();
    if (overlaps[i] > 0) most.emplace(overlaps[i], i);
  }
  std::vector<bool> gone(spheres.size(), false);
  while (!most.empty()) {
    const std::uint32_t i = most.rbegin()->second;
    most.erase(std::prev(most.end()));
    gone[i] = true;
    for (const std::uint32_t j : others[i])
      if (most.erase({overlaps[j], j}) > 0 && --overlaps[j] > 0) most.emplace(overlaps[j], j);
  }
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    if (!gone[i]) left.push_back(i);
  return left;
}

template <int D>
class Filling {
 public:
  Filling(SpheresInBox& in_box, Reporter& report, const FillOptions& options, Spheres<D> spheres,
          const Random& random)
      : in_box_(in_box),
        report_(report),
        options_(options),
        most_sweeps_(options.sweeps),
        random_(random),
        edges_(*in_box.task.target_edges),
        crowd_(BoxGround<D>(edges_, in_box.task.allowed_overlap, in_box.task.walls),
               shaken(std::move(spheres))) {}

  StageEnd run() {
    StageEnd end = StageEnd::full;
    const Resumable part(report_, "filling",
                         [&](Archive& a) { a(end, taking_out_, share_out_, most_sweeps_, reported_); });
    if (!taking_out_) {
      end = relax(patience);
      most_sweeps_ = crowd_.sweeps() + more_sweeps * options_.sweeps;
    }
    if ((taking_out_ || (end != StageEnd::converged && end != StageEnd::cancelled)) && !take_out(end))
      end = StageEnd::cancelled;
    report_.effects["neighbour lists"] += crowd_.lists_built();
    report_.effects["relaxation"].calls += static_cast<std::uint64_t>(crowd_.sweeps());
    in_box_.spheres = crowd_.spheres();
    in_box_.leave(without_overlap<D>(crowd_.spheres(), edges_, in_box_.task.allowed_overlap));
    return end;
  }

 private:
  /// Moved by nothing that matters, so that a lattice or a line of spheres does not last for ever.
  Spheres<D> shaken(Spheres<D> spheres) {
    displace_at_random<D>(spheres, edges_, in_box_.task.walls, jitter * std::ranges::min(spheres.r), random_);
    return spheres;
  }

  /// Settles and stirs.
  StageEnd relax(double patience_now) {
    const auto is_free = [this] {
      return overlapping<D>(crowd_.spheres(), edges_, in_box_.task.allowed_overlap).empty();
    };
    return crowd_.relax({.patience = patience_now,
                         .hopeless_patience = std::min(patience_now, hopeless_patience),
                         .failures_a_burst = failures_a_burst,
                         .milestone = [this] { tell(); },
                         .is_over = [this] { return crowd_.sweeps() > most_sweeps_; },
                         .most_sweeps = most_sweeps_,
                         .is_free = is_free,
                         .checkpoints = report_.checkpoints},
                        report_.monitor, random_);
  }

  /// Fewer and fewer, the last ones first, until the others are free of overlap. Returns false if cancelled.
  bool take_out(StageEnd end) {
    if (std::exchange(taking_out_, true)) end = relax(0);  // as it was at
    while (end != StageEnd::converged && end != StageEnd::cancelled && crowd_.size() > 1 &&
           crowd_.sweeps() <= most_sweeps_) {
      const double count =
          std::min(share_out_ * crowd_.mean_squeeze(), most_taken_out) * static_cast<double>(crowd_.size());
      crowd_.drop_last(count, random_);
      share_out_ *= taken_out_faster;
      end = relax(0);
    }
    return end != StageEnd::cancelled;
  }

  void tell() {
    if (crowd_.done() < reported_) return;
    reported_ = crowd_.done() + 0.005;
    report_.milestone("fill", in_box_, crowd_.largest_overlap(), crowd_.done());
  }

  SpheresInBox& in_box_;

  Reporter& report_;
  const FillOptions options_;
  double most_sweeps_;
  Random random_;
  const Vector<D> edges_;
  CrowdInBox<D> crowd_;
  double reported_ = 0;
  bool taking_out_ = false;
  double share_out_ = taken_out;
};

template <int D>
StageEnd fill_box(SpheresInBox& in_box, Reporter& report, const FillOptions& options) {
  Random random = report.random(Stream::relax);
  Spheres<D> spheres = starting_places<D>(in_box, random);
  in_box.edges = *in_box.task.target_edges;
  in_box.needed_volume = in_box.edges.prod();
  in_box.placed = true;
  if (!overlapping<D>(spheres, in_box.edges, in_box.task.allowed_overlap).empty())
    return Filling<D>(in_box, report, options, std::move(spheres), random).run();
  in_box.spheres = std::move(spheres);
  return StageEnd::converged;
}

}  // namespace

bool fits_box(const SpheresInBox& in_box) {
  const double largest = std::ranges::max(in_box.spheres.r);
  return 2 * largest * (1 - in_box.task.allowed_overlap) <= in_box.task.target_edges->minCoeff();
}

StageEnd fill_by_relaxation(SpheresInBox& in_box, Reporter& report, const FillOptions& options) {
  if (in_box.spheres.empty()) return StageEnd::converged;
  if (!fits_box(in_box))
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the largest sphere is {:.4g} times as wide as the box that is to be filled; give "
                    "more or smaller spheres",
                    2 * std::ranges::max(in_box.spheres.r) / in_box.task.target_edges->minCoeff()));
  const EffectTimer timer(report.effects["relaxation"]);
  return with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    return fill_box<decltype(dimension)::value>(in_box, report, options);
  });
}

}  // namespace bernal
