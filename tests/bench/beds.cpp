// Beds of equal spheres in columns against laws, bounds and a judge of its own; writes a page of Markdown.
//   bernal_beds [SEEDS [MOST_SPHERES]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "bernal/measure/rest.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "settle/roll_to_rest.hpp"
#include "soft/bed_density.hpp"

namespace {

using namespace bernal;

constexpr double least_move = 1e-3;       // in radii
constexpr std::size_t most_walked = 500;  // of a bed, evenly spread
constexpr double left_out = 3;            // above the floor and below the top, in diameters
const Vector<3> down(0, 0, -1);

/// Spheres of diameter 1 in a column, by cells of edge 1.
class Column {
 public:
  Column(const Packing& packing, double across) : packing_(packing), radius_(across / 2) {
    for (std::uint32_t i = 0; i < packing.spheres.size(); ++i) cells_[cell(center(i))].push_back(i);
  }

  /// How far sphere i walks down, all others held, by steps of half a thousandth of its radius in directions
  /// drawn at random that descend by a hundredth or more, until a few hundred in a row lead into something.
  double walk(std::uint32_t i, Random& random) const {
    constexpr int most_failures = 300, most_steps = 3000;
    constexpr double step = 0.25 * least_move, least_descent = 0.01;
    const Vector<3> start = center(i);
    Vector<3> p = start;
    for (int failures = 0, steps = 0; failures < most_failures && steps < most_steps; ++steps) {
      Vector<3> u;
      do u = Vector<3>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0));
      while (u.squaredNorm() > 1 || u.squaredNorm() < 0.01);
      u.normalize();
      const Vector<3> to = p + step * u;
      if (u[2] > -least_descent || !is_free(to, i)) {
        ++failures;
        continue;
      }
      p = to;
      failures = 0;
    }
    return 2 * (p - start).norm();
  }

  /// Of a column that is as dense everywhere: twice as high as its spheres on average.
  double top() const {
    double sum = 0;
    for (const double z : packing_.spheres.x[2]) sum += z;
    return 2 * sum / static_cast<double>(packing_.spheres.size());
  }

  double porosity_of_core() const {
    const double low = left_out, high = top() - left_out;
    double filled = 0;
    for (const double z : packing_.spheres.x[2]) filled += share_below(high - z) - share_below(low - z);
    return 1 - filled / (1.5 * radius_ * radius_ * 4 * (high - low));
  }

  /// Porosity at a distance from the wall, in diameters, of the core.
  double porosity_at(double distance) const {
    constexpr int angles = 400;
    const double rho = radius_ - distance, low = left_out, high = top() - left_out;
    double area = 0;
    for (std::uint32_t i = 0; i < packing_.spheres.size(); ++i) {
      const Vector<3> p = center(i);
      if (p[2] < low || p[2] > high) continue;
      const double s = std::hypot(p[0], p[1]);
      if (std::abs(s - rho) > 0.5) continue;
      for (int a = 0; a < angles; ++a) {
        const double phi = std::numbers::pi * (a + 0.5) / angles;
        const double squared = 0.25 - (rho * rho + s * s - 2 * rho * s * std::cos(phi));
        if (squared > 0) area += 2 * std::sqrt(squared) * rho * 2 * std::numbers::pi / angles;
      }
    }
    return 1 - area / (2 * std::numbers::pi * rho * (high - low));
  }

 private:
  Vector<3> center(std::uint32_t i) const { return packing_.spheres.center(i); }
  static std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return (z * 4096 + y) * 4096 + x;
  }
  static std::int64_t cell(const Vector<3>& p) {
    return key(std::llround(std::floor(p[0])) + 2048, std::llround(std::floor(p[1])) + 2048,
               std::llround(std::floor(p[2])));
  }
  static double share_below(double level) {
    const double t = std::clamp(level + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  bool is_free(const Vector<3>& p, std::uint32_t i) const {
    if (p[2] < 0.5 || std::hypot(p[0], p[1]) > radius_ - 0.5) return false;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(cell(p + Vector<3>(x, y, z)));
          if (found == cells_.end()) continue;
          for (const std::uint32_t k : found->second)
            if (k != i && (center(k) - p).squaredNorm() < 1) return false;
        }
    return true;
  }

  const Packing& packing_;
  double radius_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

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

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  const double most = argc > 2 ? std::atof(argv[2]) : 1e6;
  say_columns(seeds, most);
  say_aims(seeds, most);
  say_profiles(std::min(seeds, 3));
}
