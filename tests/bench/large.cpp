// What is around the packing itself, of many spheres: the rows of data/results/large.md, by `bernal_large
// CUBE_ROOT`.
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"

namespace {

using namespace bernal;
namespace fs = std::filesystem;

/// Of this process, in bytes: `VmRSS`, what it holds, or `VmHWM`, the most since `forget_peak`.
double resident(std::string_view which) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(which)) return 1024 * std::atof(line.c_str() + which.size() + 1);
  return 0;
}
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// Equal spheres near the points of a cubic lattice of so many along an edge, in no order, a hundredth apart.
Packing near_lattice(std::size_t across) {
  const double edge = static_cast<double>(across);
  const std::size_t count = across * across * across;
  const fs::path scene = fs::temp_directory_path() / fmt::format("bernal_large_{}.toml", getpid());
  std::ofstream(scene) << fmt::format(
      "[container]\nkind = \"periodic\"\nsize = [{0}.0, {0}.0, {0}.0]\n[spheres]\ncount = {1}\nradius = "
      "0.495\n"
      "[[stage]]\ndo = \"relax\"\n",
      across, count);
  Packing packing;
  packing.scene = read_scene(scene);
  fs::remove(scene);
  packing.domain = domain_of(packing.scene);
  packing.volume = edge * edge * edge;
  Random random(1, 2);
  std::vector<std::uint32_t> at(count);
  std::iota(at.begin(), at.end(), 0u);
  for (std::size_t i = count; i-- > 1;) std::swap(at[i], at[random() % (i + 1)]);
  Spheres<3> spheres;
  spheres.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = [&](std::size_t steps) {
      constexpr double about = 0.01;
      return static_cast<double>(steps % across) + 0.5 + about * (random.uniform() - 0.5);
    };
    spheres.set_center(at[i], {place(i), place(i / across), place(i / across / across)});
    spheres.r[at[i]] = 0.495;
  }
  packing.spheres = Spheres<dynamic>(std::move(spheres));
  return packing;
}

/// One row: name, seconds in one thread and in two, bytes a sphere above what there was before.
void measure_part(std::string_view name, std::size_t spheres, const std::function<void()>& part) {
  double seconds[2] = {};
  double bytes = 0;
  for (const std::size_t threads : {1, 2}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    forget_peak();
    const double before = resident("VmRSS:");
    const Stopwatch watch;
    part();
    seconds[threads - 1] = watch.seconds();
    bytes = std::max(bytes, resident("VmHWM:") - before);
  }
  fmt::print("{}\n", nlohmann::json({{"part", name},
                                     {"spheres", spheres},
                                     {"seconds", seconds},
                                     {"bytes_a_sphere", bytes / static_cast<double>(spheres)}})
                         .dump());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t across = argc == 2 ? std::strtoul(argv[1], nullptr, 10) : 0;
  if (across < 2 || across > 1000) {
    fmt::print(stderr, "usage: bernal_large SPHERES_ALONG_AN_EDGE\n");
    return 2;
  }
  const Packing packing = near_lattice(across);
  const Spheres<dynamic>& spheres = packing.spheres;
  const Domain& domain = packing.domain;
  const std::size_t n = spheres.size();
  const MeasureOptions options;
  std::vector<double> gaps = options.gaps;
  gaps.push_back(options.contact_gap);
  // As `pack` measures it for a report.
  constexpr double work = 2e6;
  constexpr std::size_t most_with_pores = 20'000'000, points = 20000;
  measure_part("the certificate", n, [&] { certify(spheres, domain); });
  measure_part("contacts and rattlers at ten gaps", n, [&] { measure_contacts(spheres, domain, gaps); });
  measure_part("g(r), from some thousand centres", n,
               [&] { radial_distribution(spheres, domain, {.work = work}); });
  measure_part("order of bonds", n, [&] { bond_order(spheres, domain); });
  if (n <= most_with_pores)
    measure_part("pores", n, [&] { pore_sizes(spheres, domain, {.points = points}); });
  measure_part("hash", n, [&] { hash_of(spheres); });
  const fs::path folder = fs::temp_directory_path() / fmt::format("bernal_large_{}", getpid());
  measure_part("all that pack does when it writes", n, [&] {
    write_packing(packing, folder);
    fs::remove_all(folder);
  });
}
