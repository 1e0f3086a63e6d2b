#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "settle/crystal.hpp"
#include "settle/insert.hpp"

namespace bernal {
namespace {

/// A crystal whose spacing is left open may be so much wider than one that touches, to divide a period.
constexpr double most_stretch = 1e-3;

using CrystalSites = std::vector<Vector<3>>;

CrystalGround ground_of(const SpheresInBed& in_bed) {
  const Container& container = in_bed.bed().container();
  return {container.boundary(), container.bounds(), in_bed.task.frame, container.dimension(),
          std::holds_alternative<Box>(in_bed.task.domain)};
}

CrystalGround ground_of(const SpheresInBox& in_box) {
  CrystalGround ground;
  ground.frame = in_box.task.frame;
  ground.dimension = in_box.dimension();
  ground.boundary.edges.setZero();
  ground.boundary.edges.head(in_box.dimension()) = *in_box.task.target_edges;
  ground.bounds = {Vector<3>::Zero(), ground.boundary.edges};
  return ground;
}

/// The sites that have room for a sphere of that radius, in the scene's unit, in the packer's coordinates.
CrystalSites free_sites(const SpheresInBed& in_bed, const Crystal& crystal, double r,
                        const Monitor& monitor) {
  const Bed& bed = in_bed.bed();
  const double own = r / in_bed.task.frame.scale;
  CrystalSites free;
  crystal.for_each_site(monitor, [&](const Vector<3>& place) {
    if (!bed.fits_between_spheres(place, own)) return;
    if (!bed.container().contains(place, own + bed.skin())) {
      if (bed.container().clearance_within(place, 2 * own) < own - bed.skin()) return;
      const auto exact = in_bed.task.exact_place(place, own);
      if (!exact || *exact != place) return;
    }
    free.push_back(place);
  });
  return free;
}

/// Of several ways to lay the crystal the one for which sites_of(crystal) are the most, from the floor up.
/// Nothing where all ways would leave sites too near to each other.
template <class SitesOf>
std::optional<CrystalSites> most_sites(const CrystalGround& ground, const CrystalCell& cell, double spacing,
                                       double r, const SitesOf& sites_of) {
  constexpr double sites_looked_at = 3e5;
  constexpr std::size_t fewest_ways = 6;
  const double roundings = ground.frame.scale * ground.frame.resolution;
  std::optional<CrystalSites> most;
  const std::size_t ways = Ways(ground, cell, spacing, r).count();
  for (std::size_t way = 0; way < ways; ++way) {
    const double looked = most ? static_cast<double>(way) * static_cast<double>(most->size()) : 0;
    if (way >= fewest_ways && looked > sites_looked_at) break;
    // Where rounded sites are too near to each other, the crystal is wider by some roundings.
    for (const double more : {0.0, 8.0, 64.0}) {
      const Ways wider(ground, cell, spacing + more * roundings, r);
      const Crystal crystal = wider.crystal(way);
      if (!crystal.keeps(2 * r)) continue;
      CrystalSites sites = sites_of(crystal);
      if (!most || sites.size() > most->size()) most = std::move(sites);
      break;
    }
  }
  if (most)
    std::ranges::stable_sort(*most, {}, [up = ground.dimension - 1](const Vector<3>& p) { return p[up]; });
  return most;
}

/// The spacing of the crystal that the options ask for, of spheres up to radius r, in the scene's unit.
/// Throws Error{bad_scene} where there is none.
double spacing_asked(const Insert& options, const CrystalGround& ground, const CrystalCell& cell, double r) {
  if (options.spacing && *options.spacing < 2 * r)
    throw Error(ErrorCode::bad_scene,
                fmt::format("spacing = {:.10g} is less than the largest diameter, {:.10g}; leave it out, and "
                            "the spheres touch",
                            *options.spacing, 2 * r));
  const double least = options.spacing.value_or(2 * r);
  const auto spacing =
      spacing_dividing(ground, cell, least, options.spacing ? roundings_of_periods : most_stretch);
  if (!spacing) refuse_periods(options.layout, ground, cell, least);
  return *spacing;
}

/// The sites of that crystal.
template <class SitesOf>
CrystalSites sites_asked(const Insert& options, const CrystalGround& ground, double r,
                         const SitesOf& sites_of) {
  const CrystalCell cell = cell_of(options.layout, ground.dimension);
  const auto sites = most_sites(ground, cell, spacing_asked(options, ground, cell, r), r, sites_of);
  if (!sites) refuse_periods(options.layout, ground, cell, options.spacing.value_or(2 * r));
  return *sites;
}

/// Where a scene says it by itself: of equal spheres in a periodic box, or anywhere.
void require_crystal(const Insert& insert, const Scene& scene) {
  const auto* equal = std::get_if<Constant>(&scene.sizes);
  const bool as_said = equal && equal->value > 0 && scene.scale == 1 && !scene.largest;
  if (!as_said || scene.start.file || scene.asks_for_gaps()) return;
  CrystalGround ground;
  ground.dimension = scene.dimension();
  if (const auto* box = std::get_if<PeriodicBox>(&scene.container); box && box->walls.empty())
    for (int k = 0; k < ground.dimension; ++k)
      ground.boundary.edges[k] = box->edge.value_or(
          box->size.empty() ? 0 : box->size[std::min(static_cast<std::size_t>(k), box->size.size() - 1)]);
  spacing_asked(insert, ground, cell_of(insert.layout, ground.dimension),
                equal->value / (scene.sizes_are_diameters ? 2 : 1));
}

double density_of(const Insert& options, int dimension, double largest) {
  const double wider = std::max(1.0, options.spacing.value_or(2 * largest) / (2 * largest));
  return cell_of(options.layout, dimension).density / std::pow(wider, dimension);
}

}  // namespace

double full_crystal(const Insert& options, const EmptyBed& bed) {
  constexpr double wall_deficit = 0.55;
  return density_of(options, bed.dimension, bed.largest) * bed.evenness / (1 + wall_deficit * bed.wall_share);
}

double gain_of_crystal(const Insert& options, const SizeDistribution& radii, int dimension,
                       const WallsAround& around) {
  constexpr double of_equal[] = {1, 1, 0.84, 0.6435};  // at random, by dimension
  // So many are drawn that all sites of the box are taken.
  constexpr double more = 1.001;
  if (!options.is_crystal() || around.has_walls || dimension < 2 || dimension > 3) return 1;
  const double largest = radii.quantile(1 - 1e-9);
  return more * density_of(options, dimension, largest) / of_equal[dimension];
}

void complete_insert(Insert& insert, Scene& scene, const schema::Section& section) {
  if (insert.spacing && !insert.is_crystal())
    section.refuse("spacing", "is that of a crystal: give layout = \"fcc\", \"bcc\", \"hcp\" or \"sc\" too");
  if (scene.dimension() == 2 && (insert.layout == Layout::fcc || insert.layout == Layout::bcc))
    section.refuse("layout", "is none of discs: \"hcp\" is their hexagonal lattice, \"sc\" the square one");
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (box && box->walls.empty()) {
    if (!insert.is_crystal())
      section.refuse(
          "layout",
          "must be \"fcc\", \"bcc\", \"hcp\" or \"sc\" in a periodic box; \"fly\" fills one at random");
    if (box->scalable) section.refuse("layout", "needs a periodic box of given \"size\" or \"edge\"");
  }
  if (insert.is_crystal()) {
    try {
      require_crystal(insert, scene);
    } catch (const Error& error) {
      throw Error(error.code(), error.what(), section.locations.of("layout"));
    }
    return;
  }
  insert.packing_fraction = insert.until();
}

std::vector<Vector<3>> crystal_sites(const Insert& options, const SpheresInBed& in_bed,
                                     const Monitor& monitor) {
  const double r = in_bed.task.frame.scale * in_bed.supply->largest();
  return sites_asked(options, ground_of(in_bed), r,
                     [&](const Crystal& crystal) { return free_sites(in_bed, crystal, r, monitor); });
}

StageEnd insert_crystal(const Insert& options, SpheresInBed& in_bed, Reporter& report) {
  const EffectTimer timer(report.effects["insertion"]);
  Bed& bed = in_bed.bed();
  Supply& supply = *in_bed.supply;
  const auto is_done = [&] { return supply.exhausted() || bed.packing_fraction() >= options.until(); };
  if (is_done()) return StageEnd::converged;
  for (const Vector<3>& site : crystal_sites(options, in_bed, report.monitor)) {
    if (is_done()) break;
    if (report.monitor.stop()) return StageEnd::cancelled;
    const std::uint32_t tag = supply.window().front();
    bed.insert(site, supply.radius(tag), tag);
    supply.take(0);
    if (bed.size() % 8192 == 0) report.milestone("insert", bed);
  }
  return is_done() ? StageEnd::converged : StageEnd::full;
}

StageEnd insert_crystal_in_box(const Insert& options, SpheresInBox& in_box, Reporter& report) {
  const EffectTimer timer(report.effects["insertion"]);
  if (in_box.placed) return StageEnd::converged;
  const CrystalGround ground = ground_of(in_box);
  const double scale = ground.frame.scale, r = scale * in_box.supply->largest();
  const CrystalSites sites = sites_asked(options, ground, r, [&](const Crystal& crystal) {
    CrystalSites all;
    crystal.for_each_site(report.monitor, [&](const Vector<3>& site) { all.push_back(site); });
    return all;
  });
  const std::size_t wanted = in_box.spheres.size(), n = std::min(wanted, sites.size());
  if (n < wanted) {
    std::vector<std::uint32_t> first(n);
    std::iota(first.begin(), first.end(), 0U);
    in_box.leave(first);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < in_box.spheres.x.size(); ++k)
      in_box.spheres.x[k][i] = sites[i][static_cast<int>(k)];
  in_box.edges = *in_box.task.target_edges;
  in_box.needed_volume = in_box.edges.prod();
  in_box.placed = true;
  return n < wanted ? StageEnd::full : StageEnd::converged;
}

}  // namespace bernal
