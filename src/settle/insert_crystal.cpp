#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "settle/insert.hpp"

namespace bernal {
namespace {

constexpr double sqrt2 = std::numbers::sqrt2, sqrt3 = std::numbers::sqrt3;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// An orthogonal cell whose nearest sites are one apart; sites in edges of the cell.
struct CrystalCell {
  Vector<3> edges;
  std::vector<Vector<3>> sites;
  double density;  ///< packing fraction of touching spheres
};

CrystalCell cell_of(Layout layout, int dimension) {
  if (dimension == 2) {
    if (layout == Layout::sc) return {{1, 1, 1}, {{0, 0, 0}}, 0.7854};
    return {{1, sqrt3, 1}, {{0, 0, 0}, {0.5, 0.5, 0}}, 0.9069};
  }
  if (layout == Layout::sc) return {{1, 1, 1}, {{0, 0, 0}}, 0.5236};
  if (layout == Layout::bcc)
    return {Vector<3>::Constant(2 / sqrt3), {{0, 0, 0}, {0.5, 0.5, 0.5}}, 0.6802};
  if (layout == Layout::fcc)
    return {Vector<3>::Constant(sqrt2),
            {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}},
            0.7405};
  return {{1, sqrt3, std::sqrt(8.0 / 3)},
          {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 1.0 / 6, 0.5}, {0, 2.0 / 3, 0.5}},
          0.7405};
}

constexpr const char* names_of_layouts[] = {"random", "lattice", "fcc", "bcc", "hcp", "sc"};

/// A period may be so much off a number of cells, for the digits that people write.
constexpr double roundings_of_periods = 1e-9;
/// A crystal whose spacing is left open may be so much wider than one that touches, to divide a period.
constexpr double most_stretch = 1e-3;

/// The planes of sites across an axis, in the scene's coordinates: of those at each fraction of a cell the
/// coordinate in every cell. Sites have their coordinates from here, so that distances between all of them
/// are known from a few.
class Planes {
 public:
  /// `count` cells of that edge, the first of them at `from`; all of them make up `period`, unless it is 0.
  Planes(const std::vector<double>& fractions, double from, double edge, int count, double period)
      : period_(period) {
    for (const double fraction : fractions) {
      std::vector<double>& at = at_.emplace_back();
      for (int k = 0; k < count; ++k) at.push_back(from + (k + fraction) * edge);
    }
  }

  std::size_t cells() const { return at_.front().size(); }
  double at(std::size_t fraction, std::size_t cell) const { return at_[fraction][cell]; }

  /// The least distance along the axis of a plane at one fraction from one at another, so many cells on.
  /// Infinite if there are none. Differences of doubles are exact here, or nearly.
  long double least_gap(std::size_t fraction, std::size_t other, int cells_on) const {
    const auto n = static_cast<int>(cells());
    long double least = infinity;
    for (int k = 0; k < n; ++k) {
      const int to = k + cells_on, turns = period_ > 0 ? (to >= n) - (to < 0) : 0, image = to - turns * n;
      if (image < 0 || image >= n) continue;
      const long double there =
          static_cast<long double>(at_[other][static_cast<std::size_t>(image)]) + turns * static_cast<long double>(period_);
      const long double own = at_[fraction][static_cast<std::size_t>(k)];
      least = std::min(least, std::abs(there - own));
    }
    return least;
  }

 private:
  std::vector<std::vector<double>> at_;
  double period_;
};

/// A crystal laid into a container.
struct Crystal {
  const CrystalCell& cell;
  std::array<std::vector<double>, 3> fractions;  ///< of the sites' planes, along each axis
  std::vector<Planes> planes;                    ///< across each axis

  std::size_t fraction_of(const Vector<3>& site, int axis) const {
    const auto& all = fractions[static_cast<std::size_t>(axis)];
    return static_cast<std::size_t>(std::ranges::find(all, site[axis]) - all.begin());
  }

  /// Whether no two sites, in whatever images, are nearer than `distance`: certainly, if it says so.
  bool keeps(double distance) const {
    constexpr double near = 1.2;
    // A sum of squares in long doubles is off by less.
    const long double square = static_cast<long double>(distance) * distance * (1 + 0x1p-60L);
    for (const Vector<3>& one : cell.sites)
      for (const Vector<3>& other : cell.sites)
        for (int n = 0; n < 27; ++n) {
          const std::array<int, 3> on = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
          const Vector<3> way = (other - one + Vector<3>(on[0], on[1], on[2])).cwiseProduct(cell.edges);
          if (way.isZero(0) || way.norm() > near) continue;
          long double sum = 0, longest = 0;
          int apart = 0;  // axes along which the two differ
          for (int k = 0; k < 3; ++k) {
            const long double gap = planes[static_cast<std::size_t>(k)].least_gap(
                fraction_of(one, k), fraction_of(other, k), on[static_cast<std::size_t>(k)]);
            sum += gap * gap;
            longest = std::max(longest, gap);
            apart += gap > 0;
          }
          if (apart == 1 ? longest < distance : sum < square) return false;
        }
    return true;
  }

  /// Calls visit(place) for every site, in the scene's coordinates.
  template <class Visit>
  void for_each_site(const Monitor& monitor, const Visit& visit) const {
    for (std::size_t k = 0; k < planes[2].cells(); ++k)
      for (std::size_t j = 0; j < planes[1].cells(); ++j) {
        if (monitor.stop()) throw Cancelled();
        for (std::size_t i = 0; i < planes[0].cells(); ++i)
          for (const Vector<3>& site : cell.sites)
            visit(Vector<3>(planes[0].at(fraction_of(site, 0), i), planes[1].at(fraction_of(site, 1), j),
                            planes[2].at(fraction_of(site, 2), k)));
      }
  }
};

/// Ways to lay a crystal of this cell and spacing into the container of a bed. Lengths are the scene's.
class Ways {
 public:
  Ways(const SpheresInBed& in_bed, const CrystalCell& cell, double spacing, double r)
      : cell_(cell), boundary_(in_bed.bed().container().boundary()), frame_(in_bed.task.frame) {
    const bool is_box = std::holds_alternative<Box>(in_bed.task.domain);
    const Bounds<3> local = in_bed.bed().container().bounds();
    room_ = {frame_.to_scene(local.lower) + Vector<3>::Constant(r),
             frame_.to_scene(local.upper) - Vector<3>::Constant(r)};
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      for (const Vector<3>& site : cell.sites) fractions_[at].push_back(site[k]);
      std::ranges::sort(fractions_[at]);
      const auto repeated = std::ranges::unique(fractions_[at]);
      fractions_[at].erase(repeated.begin(), repeated.end());
      edges_[k] = spacing * cell.edges[k];
      if (k >= in_bed.bed().dimension()) {
        shifts_[at] = {frame_.origin[k]};
        flat_[at] = true;
      } else if (boundary_.repeats(k)) {
        shifts_[at] = {frame_.to_scene(boundary_.origin)[k]};
      } else {
        // A plane of sites as near the lower end as a sphere may be, to the bit or by roundings; where walls
        // are not flat, also the middle on planes and between them.
        const double roundings = 8 * frame_.scale * frame_.resolution;
        shifts_[at].push_back(room_.lower[k]);
        for (const double f : fractions_[at])
          shifts_[at].push_back(room_.lower[k] + roundings - f * edges_[k]);
        if (!is_box)
          for (const double f : {0.0, 0.5, 0.25, 0.75})
            shifts_[at].push_back(room_.center()[k] - f * edges_[k]);
      }
    }
  }

  std::size_t count() const { return shifts_[0].size() * shifts_[1].size() * shifts_[2].size(); }

  /// All axes go on at once, so that the middle of all three is tried early.
  Crystal crystal(std::size_t way) const {
    const std::size_t x = way % shifts_[0].size(), y = (way / shifts_[0].size() + way) % shifts_[1].size(),
                      z = (way / (shifts_[0].size() * shifts_[1].size()) + way) % shifts_[2].size();
    const std::array<double, 3> shift = {shifts_[0][x], shifts_[1][y], shifts_[2][z]};
    Crystal laid{cell_, fractions_, {}};
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (flat_[at]) {
        laid.planes.emplace_back(fractions_[at], shift[at], 0.0, 1, 0.0);
      } else if (boundary_.repeats(k)) {
        const double period = frame_.scale * boundary_.edges[k];
        const int cells = std::max(1, static_cast<int>(std::lround(period / edges_[k])));
        laid.planes.emplace_back(fractions_[at], shift[at], period / cells, cells, period);
      } else {
        const double before =
            std::max(0.0, std::ceil((shift[at] - room_.lower[k]) / edges_[k] - roundings_of_periods));
        const double after = std::max(0.0, std::floor((room_.upper[k] - shift[at]) / edges_[k])) + 2;
        const auto cells = static_cast<int>(before + after);
        laid.planes.emplace_back(fractions_[at], shift[at] - before * edges_[k], edges_[k], cells, 0.0);
      }
    }
    return laid;
  }

 private:
  const CrystalCell& cell_;
  Boundary<3> boundary_;
  Frame frame_;
  Bounds<3> room_;
  Vector<3> edges_;
  std::array<std::vector<double>, 3> fractions_, shifts_;
  std::array<bool, 3> flat_ = {false, false, false};
};

/// The spacing from `least` on with which cells divide all periods; nothing where that is none up to
/// `most_stretch` wider. A period may be a rounding too short.
std::optional<double> spacing_dividing(const Boundary<3>& boundary, double unit, const CrystalCell& cell,
                                       double least, double stretch) {
  std::optional<double> spacing;
  for (int k = 0; k < 3; ++k) {
    if (!boundary.repeats(k)) continue;
    const double period = unit * boundary.edges[k], edge = least * cell.edges[k];
    double cells = std::round(period / edge);
    if (std::abs(period / edge - cells) > roundings_of_periods * cells) cells = std::floor(period / edge);
    if (!(cells >= 1)) return {};
    const double own = period / (cells * cell.edges[k]);
    if (own > (1 + stretch) * least) return {};
    if (spacing && std::abs(own - *spacing) > roundings_of_periods * own) return {};
    if (!spacing) spacing = own;
  }
  return spacing.value_or(least);
}

/// What to write so that a crystal fits, where it does not.
[[noreturn]] void refuse_periods(const Insert& options, const SpheresInBed& in_bed, const CrystalCell& cell,
                                 double spacing) {
  const Boundary<3>& boundary = in_bed.bed().container().boundary();
  std::vector<std::string> periods, nearest;
  for (int k = 0; k < 3; ++k) {
    if (!boundary.repeats(k)) continue;
    const double period = in_bed.task.frame.scale * boundary.edges[k], edge = spacing * cell.edges[k];
    const double cells = std::max(1.0, std::round(period / edge));
    periods.push_back(fmt::format("{:.12g}", period));
    nearest.push_back(fmt::format("{:.12g}", cells * edge * (1 + 1e-11)));
  }
  throw Error(ErrorCode::bad_scene,
              fmt::format("a crystal \"{}\" with sites {:.10g} apart does not fit into a period of {}; it fits "
                          "into {}",
                          names_of_layouts[static_cast<int>(options.layout)], spacing,
                          fmt::join(periods, " and "), fmt::join(nearest, " and ")));
}

/// The sites that have room for a sphere of that radius, in the scene's unit, in the packer's coordinates.
std::vector<Vector<3>> free_sites(const SpheresInBed& in_bed, const Crystal& crystal, double r,
                                  const Monitor& monitor) {
  const Bed& bed = in_bed.bed();
  const Frame& frame = in_bed.task.frame;
  const double own = r / frame.scale;
  std::vector<Vector<3>> free;
  crystal.for_each_site(monitor, [&](const Vector<3>& site) {
    const Vector<3> place = frame.to_local(site);
    if (frame.to_scene(place) != site || !bed.fits_between_spheres(place, own)) return;
    if (!bed.container().contains(place, own + bed.skin())) {
      if (bed.container().clearance_within(place, 2 * own) < own - bed.skin()) return;
      const auto exact = in_bed.task.exact_place(place, own);
      if (!exact || *exact != place) return;
    }
    free.push_back(place);
  });
  return free;
}

/// Of several ways to lay the crystal the one with the most free sites, from the floor up. Nothing where all
/// would leave sites too near to each other.
std::optional<std::vector<Vector<3>>> most_sites(const SpheresInBed& in_bed, const CrystalCell& cell,
                                                 double spacing, double r, const Monitor& monitor) {
  constexpr double sites_looked_at = 4e6;
  constexpr std::size_t fewest_ways = 4;
  const double roundings = in_bed.task.frame.scale * in_bed.task.frame.resolution;
  std::optional<std::vector<Vector<3>>> most;
  const std::size_t ways = Ways(in_bed, cell, spacing, r).count();
  for (std::size_t way = 0; way < ways; ++way) {
    const double looked = most ? static_cast<double>(way) * static_cast<double>(most->size()) : 0;
    if (way >= fewest_ways && looked > sites_looked_at) break;
    // Where rounded sites are too near to each other, the crystal is wider by some roundings.
    for (const double more : {0.0, 8.0, 64.0}) {
      const Crystal crystal = Ways(in_bed, cell, spacing + more * roundings, r).crystal(way);
      if (!crystal.keeps(2 * r)) continue;
      std::vector<Vector<3>> sites = free_sites(in_bed, crystal, r, monitor);
      if (!most || sites.size() > most->size()) most = std::move(sites);
      break;
    }
  }
  if (most)
    std::ranges::stable_sort(
        *most, {}, [up = in_bed.bed().dimension() - 1](const Vector<3>& p) { return p[up]; });
  return most;
}

}  // namespace

double full_crystal(const Insert& options, const EmptyBed& bed) {
  constexpr double wall_deficit = 0.55;
  const double touching = 2 * bed.largest,
               wider = std::max(1.0, options.spacing.value_or(touching) / touching);
  return cell_of(options.layout, bed.dimension).density * bed.evenness / std::pow(wider, bed.dimension) /
         (1 + wall_deficit * bed.wall_share);
}

void complete_insert(Insert& insert, Scene& scene, const schema::Section& section) {
  if (insert.spacing && !insert.is_crystal())
    section.refuse("spacing", "is that of a crystal: give layout = \"fcc\", \"bcc\", \"hcp\" or \"sc\" too");
  if (scene.dimension() == 2 && (insert.layout == Layout::fcc || insert.layout == Layout::bcc))
    section.refuse("layout",
                   "is none of discs: \"hcp\" is their hexagonal lattice, \"sc\" the square one");
  insert.packing_fraction = insert.until();
}

StageEnd insert_crystal(const Insert& options, SpheresInBed& in_bed, Reporter& report) {
  const EffectTimer timer(report.effects["insertion"]);
  Bed& bed = in_bed.bed();
  Supply& supply = *in_bed.supply;
  const auto is_done = [&] {
    return supply.exhausted() || bed.packing_fraction() >= options.until();
  };
  if (is_done()) return StageEnd::converged;
  const CrystalCell cell = cell_of(options.layout, bed.dimension());
  const double unit = in_bed.task.frame.scale, r = unit * supply.largest();
  if (options.spacing && *options.spacing < 2 * r)
    throw Error(ErrorCode::bad_scene,
                fmt::format("spacing = {:.10g} is less than the largest diameter, {:.10g}; leave it out, and "
                            "the spheres touch",
                            *options.spacing, 2 * r));
  const double least = options.spacing.value_or(2 * r);
  const auto spacing = spacing_dividing(bed.container().boundary(), unit, cell, least,
                                        options.spacing ? roundings_of_periods : most_stretch);
  if (!spacing) refuse_periods(options, in_bed, cell, least);
  const auto sites = most_sites(in_bed, cell, *spacing, r, report.monitor);
  if (!sites) refuse_periods(options, in_bed, cell, least);
  for (const Vector<3>& site : *sites) {
    if (is_done()) break;
    if (report.monitor.stop()) return StageEnd::cancelled;
    const std::uint32_t tag = supply.window().front();
    bed.insert(site, supply.radius(tag), tag);
    supply.take(0);
    if (bed.size() % 8192 == 0) report.milestone("insert", bed);
  }
  return is_done() ? StageEnd::converged : StageEnd::full;
}

}  // namespace bernal
