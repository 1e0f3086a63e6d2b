// Beds of equal spheres in columns against laws, bounds and a judge of its own; writes a page of Markdown.
//   bernal_beds [SEEDS [MOST_SPHERES]]
//   bernal_beds closed [SEEDS]: a closed column by every method, and how its profile depends on the bins
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bench/column.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/column_profile.hpp"
#include "bernal/measure/rest.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "settle/roll_to_rest.hpp"
#include "soft/bed_density.hpp"

namespace {

using namespace bernal;
using bench::Column;
using bench::least_move;

constexpr std::size_t most_walked = 500;  // of a bed, evenly spread
const Vector<3> down(0, 0, -1);

Packing bed_of(double across, double height, const char* density, std::uint64_t seed) {
  const int count = static_cast<int>(std::lround(1.5 * across * across * height * 0.57));
  RunOptions options;
  options.seed = seed;
  options.threads = 1;
  return run(build(parse_scene(fmt::format("[container]\nkind = \"cylinder\"\nradius = {}\nheight = {}\n"
                                           "[spheres]\ncount = {}\ndiameter = 1.0\nbed = \"{}\"\n[[stage]]\n"
                                           "do = \"settle\"\n",
                                           across / 2, 2 * height, count, density),
                               "column.toml")),
             options);
}

/// What ten beds of a kind are like.
struct Kind {
  std::vector<double> porosities;
  std::size_t spheres = 0, unsettled = 0, hanging = 0, held = 0, moved = 0, limits = 0;

  double mean() const {
    double sum = 0;
    for (const double p : porosities) sum += p;
    return sum / static_cast<double>(porosities.size());
  }
  double deviation() const {
    double sum = 0;
    for (const double p : porosities) sum += (p - mean()) * (p - mean());
    return std::sqrt(sum / std::max<double>(1, static_cast<double>(porosities.size()) - 1));
  }
  std::string text() const {
    return porosities.empty() ? "" : fmt::format("{:.4f} ± {:.4f}", mean(), deviation());
  }
};

/// With what friction of that angle, in degrees, may hold them; what that holds may be walked down.
Kind beds_of(double across, double height, const char* density, int seeds, double most_spheres,
             double friction = 0) {
  Kind kind;
  if (0.86 * across * across * height > most_spheres) return kind;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Packing packing = bed_of(across, height, density, static_cast<std::uint64_t>(seed));
    const Rest rest = measure_rest(packing.spheres, packing.domain, down, {.friction = friction});
    const Column column(packing, across);
    kind.porosities.push_back(column.porosity_of_core());
    kind.spheres += packing.spheres.size();
    kind.unsettled += rest.unsettled;
    kind.hanging += rest.hanging;
    kind.held += rest.held_by_friction;
    kind.limits += packing.outcome != Outcome::converged;
    Random random(static_cast<std::uint64_t>(seed), stream(Stream::test));
    const std::size_t every = 1 + packing.spheres.size() / most_walked;
    for (std::size_t i = 0; rest.held_by_friction == 0 && i < packing.spheres.size(); i += every)
      kind.moved += column.walk(static_cast<std::uint32_t>(i), random) > least_move;
    std::fprintf(stderr, "D/d %g, %g high, %s, seed %d: %.4f, %s\n", across, height, density, seed,
                 kind.porosities.back(), packing.reason.c_str());
  }
  return kind;
}

/// The densest of all packings up to D/d = 1 + sqrt(3)/2: a zigzag, in which each sphere touches the one
/// before and the wall opposite to it.
double porosity_of_zigzag(double across) {
  const double pitch = std::sqrt(1 - (across - 1) * (across - 1));
  return 1 - 2 / (3 * across * across * pitch);
}

/// De Klerk (2003), z in diameters from the wall.
double by_de_klerk(double z, double bulk) {
  if (z <= 0.637) return 2.14 * z * z - 2.53 * z + 1;
  return bulk + 0.29 * std::exp(-0.6 * z) * std::cos(2.3 * std::numbers::pi * (z - 0.16)) +
         0.15 * std::exp(-0.9 * z);
}

void say_columns(int seeds, double most) {
  std::printf(
      "## Poured, by height\n\nPorosity of the core, three diameters from floor and top left out, mean and "
      "standard "
      "deviation of %d seeds; heights in diameters.\n\n| D/d | 40 high | 160 high | 640 high | law of poured "
      "beds | "
      "others | may not be below | spheres | not at rest | hanging | moved by the judge |\n"
      "|---:|---:|---:|---:|---:|---|---:|---:|---:|---:|---:|\n",
      seeds);
  for (const double across : {1.5, 1.8, 2.0, 2.5, 3.0, 4.0, 4.4, 5.0, 6.0, 8.0, 10.0, 20.0}) {
    std::size_t spheres = 0, unsettled = 0, hanging = 0, moved = 0;
    std::string heights;
    for (const double height : {40.0, 160.0, 640.0}) {
      const Kind kind = beds_of(across, height, "poured", seeds, most);
      heights += kind.text() + " | ";
      spheres += kind.spheres;
      unsettled += kind.unsettled;
      hanging += kind.hanging;
      moved += kind.moved;
    }
    std::printf(
        "| %g | %s%.3f | %s | %s | %zu | %zu | %zu | %zu |\n", across, heights.c_str(),
        porosity_poured(across),
        across == 6     ? ".4429 poured"
        : across == 4.4 ? ".464 pebbles"
                        : "",
        across < 1 + std::sqrt(3.0) / 2 ? fmt::format("{:.4f}", porosity_of_zigzag(across)).c_str() : "",
        spheres, unsettled, hanging, moved);
    std::fflush(stdout);
  }
}

void say_aims(int seeds, double most) {
  std::printf(
      "\n## Vibrated and loose, 40 diameters high\n\n| D/d | vibrated | aim | loose | aim | spheres | not at "
      "rest | held by friction | hanging | moved by the judge | aim missed |\n"
      "|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const double across : {4.0, 5.0, 6.0, 8.0, 10.0, 20.0}) {
    const Kind vibrated = beds_of(across, 40, "vibrated", seeds, most),
               loose = beds_of(across, 40, "loose", seeds, most, BedTarget::most_friction);
    std::printf("| %g | %s | %.4f | %s | %.4f | %zu | %zu | %zu | %zu | %zu | %zu |\n", across,
                vibrated.text().c_str(), porosity_vibrated(across), loose.text().c_str(),
                porosity_loose(across), vibrated.spheres + loose.spheres,
                vibrated.unsettled + loose.unsettled, loose.held, vibrated.hanging + loose.hanging,
                vibrated.moved + loose.moved, vibrated.limits + loose.limits);
    std::fflush(stdout);
  }
}

void say_profiles(int seeds) {
  constexpr double step = 0.1, deepest = 3;
  const double columns[] = {6, 10, 20};
  std::vector<std::vector<double>> profiles;
  double bulk = 0;
  int in_bulk = 0;
  for (const double across : columns) {
    std::vector<double> profile;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Packing packing = bed_of(across, 40, "poured", static_cast<std::uint64_t>(seed));
      const Column column(packing, across);
      std::size_t k = 0;
      for (double z = step / 2; z < std::min(deepest, across / 2); z += step, ++k) {
        if (k == profile.size()) profile.push_back(0);
        profile[k] += column.porosity_at(z) / seeds;
      }
      if (across == 20)
        for (double z = 4.05; z < 9; z += 0.1, ++in_bulk) bulk += column.porosity_at(z);
    }
    profiles.push_back(profile);
  }
  bulk /= in_bulk;
  std::printf(
      "\n## Porosity over the distance from the wall\n\nOf poured beds 40 diameters high, beside de Klerk "
      "(2003) with a "
      "porosity of the bulk of %.3f, that of the widest column four to nine diameters from its wall.\n\n"
      "| diameters from the wall | D/d = 6 | 10 | 20 | de Klerk |\n|---:|---:|---:|---:|---:|\n",
      bulk);
  std::vector<double> squares(3, 0);
  std::size_t k = 0;
  for (double z = step / 2; z < deepest; z += step, ++k) {
    const double law = by_de_klerk(z, bulk);
    std::printf("| %.2f |", z);
    for (std::size_t c = 0; c < 3; ++c) {
      const bool there = k < profiles[c].size();
      std::printf(there ? " %.3f |" : " |", there ? profiles[c][k] : 0);
      if (there) squares[c] += (profiles[c][k] - law) * (profiles[c][k] - law);
    }
    std::printf(" %.3f |\n", law);
  }
  std::printf("| root mean square from it |");
  for (std::size_t c = 0; c < 3; ++c)
    std::printf(" %.3f |", std::sqrt(squares[c] / static_cast<double>(profiles[c].size())));
  std::printf(" |\n");
}

/// A way to pack the closed column: what stands in [spheres], and the stages.
struct Way {
  const char *name, *keys, *stages;
};
constexpr double closed_across = 20, closed_height = 20;
constexpr Way ways[] = {
    {"relaxation", "", "[[stage]]\ndo = \"relax\"\n"},
    {"Han, Feng & Owen", "fill = true\n",
     "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n[[stage]]\ndo = \"shake\"\n[[stage]]\n"
     "do = \"refill\"\n"},
    {"growth", "packing_fraction = 0.60\n", "[[stage]]\ndo = \"grow\"\n"},
    {"poured", "bed = \"poured\"\n", ""},
    {"vibrated", "bed = \"vibrated\"\n", ""}};

/// "0.251 ± 0.004", or a dash where there is nothing.
std::string spread_of(const std::vector<double>& values) {
  Kind kind;
  kind.porosities = values;
  return values.empty() ? "–" : fmt::format("{:.3f} ± {:.3f}", kind.mean(), kind.deviation());
}

/// Which of them lie where published packings do, 0.25 to 0.27 to the third digit.
std::string published_of(const std::vector<double>& side, const std::vector<double>& floor,
                         const std::vector<double>& lid) {
  std::string names;
  const auto add = [&](const char* name, const std::vector<double>& values) {
    Kind kind;
    kind.porosities = values;
    if (values.empty() || kind.mean() < 0.2495 || kind.mean() >= 0.2705) return;
    names += names.empty() ? name : fmt::format(", {}", name);
  };
  add("side", side);
  add("floor", floor);
  add("lid", lid);
  return names.empty() ? "none" : names;
}

/// Of a packing, the least porosity at a distance of 0.3 to 0.8 diameters from the side, without bins.
double least_at_side(const Packing& packing) {
  const Column column(packing, closed_across);
  double least = 1;
  for (double z = 0.3; z < 0.8; z += 0.02) least = std::min(least, column.porosity_at(z));
  return least;
}

void say_closed(int seeds) {
  constexpr double bins[] = {0.2, 0.1, 0.05, 0.025};
  std::printf(
      "| method | packing fraction | bins | side | floor | lid | as published |\n"
      "|---|---:|---:|---:|---:|---:|---|\n");
  for (const Way& way : ways) {
    std::vector<Packing> packings;
    std::vector<double> fractions, exact;
    for (int seed = 1; seed <= seeds; ++seed) {
      const std::string scene = fmt::format(
          "[container]\nkind = \"cylinder\"\nradius = {}\nheight = {}\n[spheres]\n"
          "diameter = 1.0\n{}{}",
          closed_across / 2, closed_height, way.keys, way.stages);
      packings.push_back(run(build(parse_scene(scene, "closed.toml")),
                             {.seed = static_cast<std::uint64_t>(seed), .threads = 1}));
      fractions.push_back(packings.back().packing_fraction());
      exact.push_back(least_at_side(packings.back()));
      std::fprintf(stderr, "%s, seed %d: %zu spheres, %s\n", way.name, seed, packings.back().spheres.size(),
                   packings.back().reason.c_str());
    }
    std::printf("| %s | %s | none | %s | | | %s |\n", way.name, spread_of(fractions).c_str(),
                spread_of(exact).c_str(), published_of(exact, {}, {}).c_str());
    for (const double bin : bins) {
      std::vector<double> side, floor, lid;
      for (const Packing& packing : packings) {
        const auto found = column_profile(packing.spheres, packing.domain,
                                          {.layer = bin, .side = {.layer = bin, .work = 1e6 / bin}});
        const auto add = [](std::vector<double>& to, const std::optional<WallProfile::Minimum>& minimum) {
          if (minimum) to.push_back(minimum->porosity);
        };
        if (found->side) add(side, found->side->profile.first_minimum);
        add(floor, found->floor_minimum);
        if (way.keys[0] != 'b') add(lid, found->lid_minimum);  // a bed does not lie at the lid
      }
      std::printf("| | | %g | %s | %s | %s | %s |\n", bin, spread_of(side).c_str(), spread_of(floor).c_str(),
                  spread_of(lid).c_str(), published_of(side, floor, lid).c_str());
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "closed") {
    say_closed(argc > 2 ? std::atoi(argv[2]) : 3);
    return 0;
  }
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  const double most = argc > 2 ? std::atof(argv[2]) : 1e6;
  say_columns(seeds, most);
  say_aims(seeds, most);
  say_profiles(std::min(seeds, 3));
}
