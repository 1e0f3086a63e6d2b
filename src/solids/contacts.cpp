#include "solids/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/verify/certificate.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// The factor for each radius, and the numbers of pairs and walls that require it.
struct Factors {
  std::vector<double> of;
  std::size_t pairs = 0, walls = 0;
};

Factors factors_of(const Spheres<dynamic>& spheres, const Domain& domain, double gap) {
  Factors factors{.of = std::vector<double>(spheres.size(), 1.0)};
  const auto lower = [&](std::uint32_t i, double factor) {
    if (!(factor > 0))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("sphere {} has its centre in another one or outside the walls: no shrinking "
                              "makes room for a gap; bernal verify says more",
                              i));
    factors.of[i] = std::min(factors.of[i], factor);
  };
  for (const NearPair& pair : near_pairs(spheres, domain, gap)) {
    ++factors.pairs;
    lower(pair.first, (1 + pair.gap) / (1 + gap));
    lower(pair.second, (1 + pair.gap) / (1 + gap));
  }
  for (const NearWall& wall : near_walls(spheres, domain, gap, nullptr)) {
    ++factors.walls;
    lower(wall.sphere, (1 + wall.gap) / (1 + gap));
  }
  return factors;
}

/// "1 pair", "1,200 pairs".
std::string number_of(std::size_t n, std::string_view one, std::string_view more) {
  return fmt::format("{} {}", grouped(n), n == 1 ? one : more);
}

double at_most(double diameter, bool single) {
  if (!single) return diameter;
  const auto nearest = static_cast<float>(diameter);
  return static_cast<double>(nearest) <= diameter ? nearest : std::nextafter(nearest, 0.0f);
}

}  // namespace

double volume_of_balls(const Spheres<dynamic>& spheres) {
  const double half = 0.5 * spheres.dimension();
  const double unit = std::pow(std::numbers::pi, half) / std::tgamma(half + 1);
  double sum = 0;
  for (const double r : spheres.r) sum += std::pow(r, spheres.dimension());
  return unit * sum;
}

bool has_gap(const Spheres<dynamic>& spheres, const Domain& domain, double gap, const Monitor& monitor) {
  // Above the product: 1 + gap and the product have one roundoff each, the last factor another.
  constexpr double above = 1 + 8 * tolerance::roundoff;
  Spheres<dynamic> grown = spheres;
  for (double& r : grown.r) r = r * (1 + gap) * above;
  const Certificate certificate = certify(grown, domain, {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  return certificate.certified;
}

ContactReport shrink_contacts(Spheres<dynamic>& spheres, const Domain& domain, ContactTreatment treatment,
                              double gap, bool single, const Monitor& monitor) {
  ContactReport report{.treatment = treatment, .gap = gap, .spheres = spheres.size()};
  report.volume_before = volume_of_balls(spheres);
  report.domain_volume = volume_of(domain);
  const Spheres<dynamic> untouched = spheres;
  Factors factors = factors_of(untouched, domain, gap);
  report.pairs = factors.pairs;
  report.walls = factors.walls;
  const auto share_least_factor = [&] {
    if (treatment == ContactTreatment::shrink && !spheres.empty())
      std::ranges::fill(factors.of, std::ranges::min(factors.of));
  };
  share_least_factor();

  constexpr double first_margin = 16 * tolerance::roundoff, last_margin = 1e-6;
  const std::vector<double>& before = untouched.r;
  double margin = first_margin;
  do {
    if (margin > last_margin)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("a gap of {:g} cannot be proven for these spheres; bernal verify says what "
                              "is wrong with them",
                              gap));
    for (std::size_t i = 0; i < before.size(); ++i)
      if (factors.of[i] < 1)
        spheres.r[i] = 0.5 * at_most(2 * before[i] * factors.of[i] * (1 - margin), single);
    margin *= 16;
    if (margin > 1e3 * first_margin) {
      // Spheres at the gap to within rounding may be closer than it; others do not change.
      const Factors near = factors_of(untouched, domain, (1 + gap) * (1 + margin) - 1);
      for (std::size_t i = 0; i < before.size(); ++i)
        if (near.of[i] < 1) factors.of[i] = std::min(factors.of[i], 1 - margin);
      share_least_factor();
    }
  } while (!has_gap(spheres, domain, gap, monitor));

  for (std::size_t i = 0; i < before.size(); ++i) {
    report.changed += spheres.r[i] < before[i];
    report.largest_change = std::max(report.largest_change, 1 - spheres.r[i] / before[i]);
  }
  report.volume_after = volume_of_balls(spheres);
  report.proven_gap = gap;
  return report;
}

std::string contact_text(const ContactReport& report) {
  const std::string porosity =
      fmt::format("porosity {}{:+.3g}", report.meetings == 0 ? "" : "about ", report.change_of_porosity());
  switch (report.treatment) {
    case ContactTreatment::none:
      return "contacts as they are";
    case ContactTreatment::gap:
    case ContactTreatment::shrink:
      return fmt::format(
          "{} of {} shrunk by up to {:.3g}, {}; proven: every distance of centres is at least {} "
          "times the sum of radii, every clearance as many times the radius",
          grouped(report.changed), number_of(report.spheres, "radius", "radii"), report.largest_change,
          porosity, 1 + report.gap);
    case ContactTreatment::bridge:
    case ContactTreatment::fillet:
      return fmt::format(
          "{}, {} {:.6g} in all where only points touched, {}, {}; no angle at their rims below {:.1f} "
          "degrees{}",
          number_of(report.pairs, "bridge", "bridges"),
          report.pairs == 1 ? "its cross-section" : "cross-sections", report.contact_area, porosity,
          report.meetings == 0
              ? std::string("none meets a third sphere or another bridge")
              : fmt::format("{} a third sphere or each other", number_of(report.meetings, "meets", "meet")),
          report.smallest_angle,
          report.walls == 0 ? std::string()
                            : fmt::format("; {} as near stay as they are",
                                          number_of(report.walls, "place of walls", "places of walls")));
    case ContactTreatment::cap:
      return fmt::format(
          "caps cut off {} at {} and {}, flat faces {:.6g} in all where only points touched, {}{}; {}",
          number_of(report.changed, "sphere", "spheres"), number_of(report.pairs, "pair", "pairs"),
          number_of(report.walls, "place of walls", "places of walls"), report.contact_area, porosity,
          report.meetings == 0
              ? std::string()
              : fmt::format(", {} on one sphere, which volumes count twice",
                            number_of(report.meetings, "pair of caps meets", "pairs of caps meet")),
          report.proven_gap > 0
              ? fmt::format("proven: the planes of every pair are {} times the sum of radii apart",
                            report.proven_gap)
              : std::string("that their planes are apart is not proven"));
  }
  return {};
}

}  // namespace bernal
