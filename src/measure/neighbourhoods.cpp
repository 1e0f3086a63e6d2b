#include "measure/neighbourhoods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "near/size_levels.hpp"

namespace bernal {
namespace {

constexpr std::size_t spheres_a_piece = 1024;

/// Searches around one sphere after the other, widening each search until another sphere is found.
template <int D>
class NeighbourSearch {
 public:
  NeighbourSearch(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary, double gap,
                  double contact_gap)
      : spheres_(spheres),
        boundary_(boundary),
        levels_(levels_of(spheres, boundary, contact_gap)),
        gap_(gap),
        contact_gap_(contact_gap) {
    Vector<D> lower = spheres.center(0), upper = lower;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      lower = lower.cwiseMin(spheres.center(i));
      upper = upper.cwiseMax(spheres.center(i));
    }
    farthest_ = 2 * ((upper - lower).norm() + boundary.edges.norm());
  }

  void look(std::uint32_t i, std::uint32_t& contacts, double& gap) const {
    const Vector<D> c = boundary_.wrap(spheres_.center(i));
    const double r = spheres_.r[i];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double first = 0.25, wider = 3;  // in radii; growth of the search radius
    double reach = first * r;
    contacts = 0;
    gap = infinity;
    for (const SizeLevel<D>& level : levels_)
      visit(level, i, c, std::max(reach_of_contact(r + level.largest), r + level.largest + reach),
            [&](double distance, double radii) {
              contacts += distance < reach_of_contact(radii) ? 1 : 0;
              gap = std::min(gap, distance - radii);
            });
    while (gap > reach && (gap < infinity || reach <= farthest_)) {
      reach = gap < infinity ? gap : wider * reach;  // anything nearer is within it
      for (const SizeLevel<D>& level : levels_)
        visit(level, i, c, r + level.largest + reach,
              [&](double distance, double radii) { gap = std::min(gap, distance - radii); });
    }
  }

 private:
  /// Centres nearer than this are in contact, for spheres whose radii sum to `radii`: with half the gap
  /// around each, (d - s) / s < contact_gap for the sum s of the enlarged radii.
  double reach_of_contact(double radii) const { return (1 + contact_gap_) * (radii + gap_); }

  template <class Visit>
  void visit(const SizeLevel<D>& level, std::uint32_t i, const Vector<D>& c, double reach,
             const Visit& found) const {
    level.grid->for_each_near(c, reach, [&](std::uint32_t j, const Vector<D>& d) {
      const double squared = d.squaredNorm();
      if (j == i && squared == 0) return;
      found(std::sqrt(squared), spheres_.r[i] + spheres_.r[j]);
    });
  }

  const Spheres<D>& spheres_;
  const TiltedBoundary<D> boundary_;
  const std::vector<SizeLevel<D>> levels_;
  double gap_, contact_gap_, farthest_;
};

template <int D>
Neighbourhoods look_around(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary,
                           std::span<const std::uint32_t> of, double gap, double contact_gap, double scale) {
  Neighbourhoods found{std::vector<std::uint32_t>(of.size()), std::vector<double>(of.size())};
  const NeighbourSearch<D> lookout(spheres, boundary, gap / scale, contact_gap);
  parallel_ranges(of.size(), spheres_a_piece, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      lookout.look(of[k], found.contacts[k], found.gaps[k]);
      found.gaps[k] *= scale;
    }
  });
  return found;
}

}  // namespace

Neighbourhoods neighbourhoods(const Spheres<dynamic>& spheres, const Domain& domain,
                              std::span<const std::uint32_t> of, double gap, double contact_gap) {
  if (of.empty()) return {};
  if (spheres.dimension() == 3 && has_walls(domain)) {
    const Frame frame = frame_of(domain);
    return look_around<3>(localised(spheres, frame), localised(boundary_of<3>(domain), frame), of, gap,
                          contact_gap, frame.scale);
  }
  return with_dimension(spheres.dimension(), std::integer_sequence<int, 2, 3>{}, [&](auto dimension) {
    constexpr int D = dimension;
    return look_around<D>(spheres.in<D>(), tilted_boundary_of<D>(domain), of, gap, contact_gap, 1);
  });
}

std::vector<double> wall_gaps(const Spheres<dynamic>& spheres, const Domain& domain,
                              std::span<const std::uint32_t> of,
                              const std::shared_ptr<const Container>& made) {
  std::vector<double> gaps(of.size());
  if (of.empty()) return gaps;
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, made);
  parallel_ranges(of.size(), spheres_a_piece, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      Vector<3> center = Vector<3>::Zero();
      center.head(spheres.dimension()) = spheres.center(of[k]);
      gaps[k] = frame.scale * container->clearance(frame.to_local(center)) - spheres.r[of[k]];
    }
  });
  return gaps;
}

}  // namespace bernal
