#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "settle/insert.hpp"
#include "work/snug_places.hpp"

namespace bernal {
namespace {

constexpr std::size_t a_milestone_every = 8192;
/// Of the spacing at which as many sites as are needed fill the container evenly: where the search for the
/// widest lattice begins, and by what it comes closer.
constexpr double widest_tried = 2, closer = 0.8;
/// Then it is found by bisection; so near to as many sites as are needed it is wide enough.
constexpr int most_bisections = 12;
constexpr double enough_sites = 1.01;
/// A wider lattice that holds more than this times what a closer one does is kept.
constexpr double far_more = 1.25;
/// Of a lattice that holds too few: how often it is halved for what is still to come.
constexpr int most_halvings = 2;
/// Where sites for the largest hold less than this of what is to be placed, those are taken that hold it,
/// and a large sphere stands on several of them.
constexpr double share_of_large = 0.3;
/// Spheres of the window that are tried at one site.
constexpr std::size_t most_tried = 32;

/// Of sites that are `spacing` apart: the steps of a face-centred lattice, in the plane z = 0 of a hexagonal
/// one.
Vector<3> steps_of(double spacing, int dimension) {
  if (dimension == 2) return {0.5 * spacing, 0.5 * std::numbers::sqrt3 * spacing, 0};
  return Vector<3>::Constant(spacing / std::numbers::sqrt2);
}

/// At which so many sites fill the container evenly.
double even_spacing(const Container& container, std::size_t sites) {
  const double volume = container.volume();
  const auto n = static_cast<double>(sites);
  return container.dimension() == 2 ? std::sqrt(2 / std::numbers::sqrt3 * volume / n)
                                    : std::cbrt(std::numbers::sqrt2 * volume / n);
}

/// The points first + (i, j, k) step with i + j + k even, for i, j, k from 0 to below `count`.
struct Lattice {
  Vector<3> first, step;
  std::array<int, 3> count;

  /// With sites `spacing` apart, or more across periods, which it divides; for spheres of that radius between
  /// open bounds, in whose middle it lies. No sites where they do not fit.
  Lattice(const Container& container, double r, double spacing, double skin) {
    const Bounds<3> bounds = container.bounds();
    const Vector<3> least_step = steps_of(spacing, container.dimension());
    step = first = Vector<3>::Zero();
    count = {1, 1, 1};
    for (int k = 0; k < container.dimension(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (container.boundary().repeats(k)) {
        const double period = container.boundary().edges[k];
        count[at] = 2 * std::max(1, static_cast<int>(period / (2 * least_step[k])));
        step[k] = period / count[at];
        first[k] = container.boundary().origin[k];
        continue;
      }
      const double room = bounds.size()[k] - 2 * (r + 2 * skin);
      const int steps = room >= 0 ? static_cast<int>(room / least_step[k]) : -1;
      count[at] = steps + 1;
      step[k] = least_step[k];
      first[k] = bounds.center()[k] - 0.5 * steps * least_step[k];
    }
  }

  void halve(const Boundary<3>& boundary) {
    step /= 2;
    for (int k = 0; k < 3; ++k) {
      int& n = count[static_cast<std::size_t>(k)];
      n = boundary.repeats(k) ? 2 * n : std::max(0, 2 * n - 1);
    }
  }

  /// Those with room for a sphere of that radius. Throws Cancelled.
  std::vector<Vector<3>> sites(const Bed& bed, double r, const Monitor& monitor) const {
    std::vector<Vector<3>> free;
    for (int i = 0; i < count[0]; ++i) {
      if (monitor.stop()) throw Cancelled();
      for (int j = 0; j < count[1]; ++j)
        for (int k = (i + j) % 2; k < count[2]; k += 2) {
          const Vector<3> site = first + step.cwiseProduct(Vector<3>(i, j, k));
          if (bed.fits(site, r)) free.push_back(site);
        }
    }
    return free;
  }
};

/// The densest, face-centred and hexagonal; what walls take away; and what sizes that differ widely reach by
/// the halved lattices at least.
constexpr double densest[] = {1, 0.9069, 0.7405};
constexpr double wall_deficit_of_lattice = 0.55, least_of_sizes = 0.18;

struct Sites {
  Lattice lattice;
  std::vector<Vector<3>> free;
};

/// The widest that has so many free sites, or of those tried, down to the one whose spheres touch, the one
/// with far more than the closer ones, if there is such a one. Wide ones are tried first: where few spheres
/// are wanted in much room, the others have sites without number.
Sites widest_lattice(const SpheresInBed& in_bed, const Monitor& monitor, std::size_t needed) {
  const Bed& bed = in_bed.bed();
  const double r = in_bed.supply->largest(), touching = 2 * (r + bed.skin());
  const auto sites_at = [&](double spacing) {
    const Lattice lattice(bed.container(), r, spacing, bed.skin());
    return Sites{lattice, lattice.sites(bed, r, monitor)};
  };
  const double even = even_spacing(bed.container(), needed);
  double wide = std::max(touching, widest_tried * even), close = wide;
  Sites widest = sites_at(wide);
  while (widest.free.size() < needed && close > touching) {
    wide = close;
    close = std::max(touching, closer * close);
    Sites tried = sites_at(close);
    if (static_cast<double>(widest.free.size()) < far_more * static_cast<double>(tried.free.size()))
      widest = std::move(tried);
  }
  if (widest.free.size() < needed) return widest;
  for (int k = 0; k < most_bisections && close < wide; ++k) {
    if (static_cast<double>(widest.free.size()) <= enough_sites * static_cast<double>(needed)) break;
    const double middle = 0.5 * (close + wide);
    Sites tried = sites_at(middle);
    const bool holds = tried.free.size() >= needed;
    (holds ? close : wide) = middle;
    if (holds) widest = std::move(tried);
  }
  return widest;
}

}  // namespace

double full_lattice(const EmptyBed& bed) {
  return densest[bed.dimension - 1] * std::max(least_of_sizes, bed.evenness) /
         (1 + wall_deficit_of_lattice * bed.wall_share);
}

StageEnd insert_on_lattice(const Insert& options, SpheresInBed& in_bed, Reporter& report) {
  const EffectTimer timer(report.effects["insertion"]);
  Bed& bed = in_bed.bed();
  Supply& supply = *in_bed.supply;
  Random random = report.random(Stream::insert);
  const auto is_done = [&] { return supply.exhausted() || bed.packing_fraction() >= options.until(); };
  const std::size_t enough = std::min(in_bed.count_filling(options.until()), supply.wanted());

  SnugPlaces snug(in_bed, report);  // where a lattice has no site
  if (snug.only_some_touch()) snug.place_those_that_touch();
  if (is_done() || enough <= bed.size()) return StageEnd::converged;
  const std::size_t needed = enough - bed.size();
  auto [lattice, sites] = widest_lattice(in_bed, report.monitor, needed);
  if (static_cast<double>(sites.size()) < share_of_large * static_cast<double>(needed) &&
      supply.smallest() < supply.largest()) {
    lattice = {bed.container(), supply.smallest(), even_spacing(bed.container(), needed), bed.skin()};
    sites = lattice.sites(bed, supply.smallest(), report.monitor);
  }
  std::map<std::uint32_t, int> in_vain;  // sites of this lattice that a sphere was tried at
  const auto occupy = [&](const Vector<3>& site) {
    double too_large = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < std::min(most_tried, supply.window().size()); ++k) {
      const std::uint32_t tag = supply.window()[k];
      const double r = supply.radius(tag);
      if (r >= too_large) continue;
      if (const auto tried = in_vain.find(tag); tried != in_vain.end() && tried->second >= options.attempts)
        continue;
      if (bed.fits(site, r)) {
        bed.insert(site, r, tag);
        supply.take(k);
        if (bed.size() % a_milestone_every == 0) report.milestone("insert", bed);
        return;
      }
      too_large = r;
      ++in_vain[tag];
    }
  };
  for (int halvings = 0;; ++halvings) {
    in_vain.clear();
    for (std::size_t left = sites.size(); left > 0 && !is_done(); --left) {
      if (report.monitor.stop()) return StageEnd::cancelled;
      std::swap(sites[random() % left], sites[left - 1]);
      occupy(sites[left - 1]);
    }
    if (is_done()) return StageEnd::converged;
    if (halvings == most_halvings || supply.smallest() == supply.largest()) break;
    lattice.halve(bed.container().boundary());
    sites = lattice.sites(bed, supply.smallest(), report.monitor);
  }
  while (!is_done())
    if (snug.place_waiting(options.until()) == 0) return StageEnd::full;
  return StageEnd::converged;
}

}  // namespace bernal
