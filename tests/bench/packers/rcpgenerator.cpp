// Equal spheres in a periodic unit cube by RCPGenerator, as its README packs them:
//   rcpgenerator COUNT SEED FILE
// writes x, y, z and diameter of each as doubles, and prints what it took.
#include <sys/resource.h>

#include <cstdio>
#include <fstream>

#include "rcpgenerator/initialize_particles.hpp"
#include "rcpgenerator/rcp_generator.hpp"

int main(int words, char** word) {
  if (words != 4) return 2;
  rcpgenerator::InitializerConfig start;
  start.N = std::strtoul(word[1], nullptr, 10);
  start.Ndim = 3;
  start.box = {1, 1, 1};
  start.walls = {0, 0, 0};
  start.seed = std::strtoul(word[2], nullptr, 10);
  const auto placed = rcpgenerator::initialize_particles(start);
  rcpgenerator::PackingConfig options;
  options.box = placed.box;
  options.walls = placed.walls;
  options.seed = static_cast<unsigned>(start.seed);
  const auto packed = rcpgenerator::run_packing({placed.positions, placed.diameters, {}}, options);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  std::printf("steps %zu\nedge %.17g\nseconds %.3f\n", packed.steps, packed.box[0],
              static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec));
  std::ofstream file(word[3], std::ios::binary);
  for (std::size_t i = 0; i < start.N; ++i) {
    const double sphere[] = {packed.positions[i][0], packed.positions[i][1], packed.positions[i][2],
                             packed.diameters[i]};
    file.write(reinterpret_cast<const char*>(sphere), sizeof sphere);
  }
  return file ? 0 : 1;
}
