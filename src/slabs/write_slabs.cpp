#include "slabs/write_slabs.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/scene/read_scene.hpp"
#include "core/fnv.hpp"
#include "core/parallel.hpp"
#include "files/npy_file.hpp"
#include "files/npy_rows.hpp"
#include "files/output_file.hpp"
#include "files/sha256.hpp"
#include "report/report.hpp"
#include "result/result_folder.hpp"
#include "scene/scene_sources.hpp"
#include "scene/spheres_file.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

using Row = std::array<double, 4>;

/// The spheres of a slab in the scene's unit, along the axis.
std::vector<Row> rows_of(const SlabStore& store, int slab, const Vector<3>& edges, double unit) {
  struct Placed {
    double offset;
    Row row;
  };
  std::vector<Placed> placed;
  placed.reserve(store.spheres(slab));
  store.for_each(slab, [&](const SlabSphere& sphere) {
    Placed& here = placed.emplace_back(Placed{store.offset(slab, sphere), {}});
    for (int k = 0; k < 3; ++k) {
      const auto column = static_cast<std::size_t>(k);
      here.row[column] = carried_along(sphere.at[column], edges[k], edges[k]) * unit;
    }
    here.row[3] = sphere.r * unit;
  });
  std::ranges::sort(placed, {}, [](const Placed& p) { return std::tie(p.offset, p.row); });
  std::vector<Row> rows;
  rows.reserve(placed.size());
  for (const Placed& p : placed) rows.push_back(p.row);
  return rows;
}

struct WrittenSpheres {
  std::uint64_t count = 0;
  double volume = 0;
  Fnv1a hash = {};
};

WrittenSpheres write_spheres_of(SlabStore& store, const Vector<3>& edges, double unit,
                                const std::filesystem::path& path) {
  WrittenSpheres written;
  std::uint64_t all = 0;
  for (int s = 0; s < store.size(); ++s) all += store.spheres(s);
  OutputFile file(path);
  file.append(npy_header(all, 4));
  for (int s = 0; s < store.size(); ++s) {
    throw_if_interrupted();
    const std::vector<Row> rows = rows_of(store, s, edges, unit);
    file.append({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(Row)});
    for (const Row& row : rows) {
      for (const double x : row) written.hash.absorb(x);
      written.volume += ball_volume(3, row[3]);
    }
    written.count += rows.size();
    store.forget(s);
  }
  file.close();
  store.end();
  return written;
}

}  // namespace

Certificate certify_in_slabs(const Scene& scene, const std::filesystem::path& spheres,
                             CertifyOptions options) {
  const auto rows = std::make_shared<NpyRows>(spheres);
  if (rows->columns() != 4)
    throw Error(ErrorCode::bad_packing,
                fmt::format("has {} columns, where x, y, z, r are expected", rows->columns()),
                {spheres.string()});
  const auto slabs = static_cast<std::uint64_t>(scene.engine->process().slabs);
  options.allowed_overlap = scene.overlap;
  constexpr std::uint64_t least = 1 << 14;  // fewer at once save no memory to speak of
  options.at_once =
      std::clamp<std::uint64_t>((rows->rows() + slabs - 1) / slabs, least, CertifyOptions().at_once);
  return certify(
      SphereRows{rows->rows(), 3,
                 [rows](std::uint64_t first, std::span<double> values) { rows->read(first, values); }},
      packed_domain_of(scene), options);
}

void write_slabs(SlabStore& store, const Vector<3>& edges, double unit, const Plan& plan,
                 const std::filesystem::path& folder, StagedFolder& staged, const Monitor& monitor,
                 PackedInSlabs& result, const std::function<void()>& conclude) {
  Packing& packing = result.packing;
  auto& stated = std::get<PeriodicBox>(packing.scene.container);
  const Coordinates& size = std::get<Box>(packing.domain).size;
  stated.size.assign(size.begin(), size.end());
  stated.edge.reset();

  const std::filesystem::path file = staged.add(std::string(spheres_as_array));
  const WrittenSpheres written = write_spheres_of(store, edges, unit, file);
  result.spheres = written.count;
  result.packing_fraction = written.volume / packing.volume;
  result.not_measured = fmt::format(
      "structure and sizes were not measured, for the spheres are in {} slabs, of which only some were in "
      "memory; "
      "bernal measure does, of all of them",
      plan.scene.engine->process().slabs);
  conclude();

  Manifest manifest;
  const Scene as_run = scene_as_run(packing, staged, folder, false, manifest);
  result.written.certificate = certify_in_slabs(packing.scene, file, {.monitor = monitor});
  if (monitor.stop()) throw Cancelled();
  staged.write("scene.toml", scene_as_toml(as_run, folder));
  manifest["scene.toml"] = sha256_of(staged.written("scene.toml"));
  for (const std::string& name : staged.names()) manifest.try_emplace(name);
  manifest["report.json"];
  std::vector<std::string> sources;
  for (const std::filesystem::path& source : sources_of_scene(packing.scene.file))
    sources.push_back(std::filesystem::proximate(source, folder).string());
  staged.write("report.json",
               json_of(StreamedReport{packing, written.count, result.packing_fraction,
                                      result.written.certificate, result.not_measured,
                                      fmt::format("{:016x}", written.hash.hash()), manifest, sources}));
  result.written.files = staged.publish(files_of_earlier_result(folder));
}

}  // namespace bernal
