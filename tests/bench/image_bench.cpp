#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <numeric>

#include "bernal/core/random.hpp"
#include "report/write_image.hpp"
#include "support/folder.hpp"

// What it costs to write an image of 512^3 voxels: of a million spheres, of eight thousand, of a hundred.
namespace bernal {
namespace {

/// Spheres on a cubic lattice of that many a side, a little off their sites and in no order: packing fraction
/// 0.435.
Spheres<dynamic> on_lattice(int side) {
  std::vector<int> sites(static_cast<std::size_t>(side) * side * side);
  std::iota(sites.begin(), sites.end(), 0);
  Random random(1, stream(Stream::test));
  for (std::size_t i = sites.size(); i-- > 1;) std::swap(sites[i], sites[random() % (i + 1)]);
  Spheres<dynamic> spheres(3);
  const double edge = 1.0 / side;
  for (const int site : sites) {
    Vector<3> at(site % side, site / side % side, site / side / side);
    for (double& x : at) x = (x + 0.5 + random.uniform(-0.03, 0.03)) * edge;
    spheres.push_back(at, 0.47 * edge);
  }
  return spheres;
}

void image_of_512(benchmark::State& state, VoxelValues values) {
  const oneapi::tbb::global_control two(oneapi::tbb::global_control::max_allowed_parallelism, 2);
  const Spheres<dynamic> spheres = on_lattice(static_cast<int>(state.range(0)));
  const Domain box = periodic_box(Vector<3>(1, 1, 1));
  const VoxelImage image{spheres, box, voxel_grid_of(box, 512), values, "mm", "bench"};
  const testing::Folder folder;
  for (auto _ : state) {
    OutputFile file(folder / "image.nrrd");
    write_nrrd(file, image);
    file.close();
    state.PauseTiming();
    std::filesystem::remove(folder / "image.nrrd");
    state.ResumeTiming();
  }
  state.SetBytesProcessed(state.iterations() * image.grid.voxels() * bytes_per_voxel(values));
}

void sides(benchmark::internal::Benchmark* b) {
  b->ArgName("side")
      ->Arg(100)
      ->Arg(20)
      ->Arg(5)
      ->Unit(benchmark::kSecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}
BENCHMARK_CAPTURE(image_of_512, binary, VoxelValues::binary)->Apply(sides);
BENCHMARK_CAPTURE(image_of_512, labels, VoxelValues::labels)->Apply(sides);
BENCHMARK_CAPTURE(image_of_512, fraction, VoxelValues::fraction)->Apply(sides);

}  // namespace
}  // namespace bernal
