#include "bernal/result/read_packing.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "files/bytes_of_file.hpp"
#include "files/npy_file.hpp"
#include "files/put_in_place.hpp"
#include "report/report_summary.hpp"
#include "result/nest_folder.hpp"
#include "scene/read_npy_spheres.hpp"
#include "scene/read_spheres.hpp"
#include "scene/spheres_file.hpp"
#include "scene/unpublished.hpp"

namespace bernal {

namespace {

/// Throws where spheres and scene do not go together.
SpheresFile of_the_scene(const Scene& scene, const std::filesystem::path& file, SpheresFile read) {
  if (!read.unit.empty() && read.unit != name_of(scene.unit))
    throw Error(ErrorCode::bad_packing,
                fmt::format("the spheres are in {}, but the scene is in {}; both must have one unit",
                            read.unit, name_of(scene.unit)),
                {file.string()});
  if (read.spheres.dimension() != scene.dimension())
    throw Error(
        ErrorCode::bad_packing,
        fmt::format("the spheres have {} dimension{}, but the scene has {}; is it the scene "
                    "of another packing?",
                    read.spheres.dimension(), read.spheres.dimension() == 1 ? "" : "s", scene.dimension()),
        {file.string()});
  return read;
}

/// The numbers of the classes beside an array of spheres, as names by which the scene knows them.
void add_classes(const Scene& scene, const std::filesystem::path& folder, SpheresFile& read) {
  const std::filesystem::path file = where_it_stands(folder / classes_as_array);
  std::error_code unknown;
  const std::vector<SphereClass> known = classes_of(scene);
  if (known.empty() || !std::filesystem::exists(file, unknown)) return;
  NpyFile list(file, {}, NpyFile::Takes::any_numbers);
  if (!list.is_list() || list.rows() != read.spheres.size())
    list.fail("does not have the class of every sphere");
  for (const SphereClass& of : known) read.class_names.push_back(of.name);
  list.read([&](std::size_t, std::size_t first, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(values[i] >= 0 && values[i] < static_cast<double>(known.size())))
        list.fail_at(first + i, fmt::format("the scene has no class {}", values[i]));
      read.classes.push_back(static_cast<std::uint32_t>(values[i]));
    }
  });
}

/// Those of the cells, where the scene asks for such and the run found them.
std::vector<double> weights_in(const Scene& scene, const std::filesystem::path& folder, std::size_t spheres) {
  const std::filesystem::path file = where_it_stands(folder / weights_as_array);
  std::error_code unknown;
  std::vector<double> weights;
  if (!scene.cells || !std::filesystem::exists(file, unknown)) return weights;
  NpyFile list(file, {}, NpyFile::Takes::any_numbers);
  if (!list.is_list() || list.rows() != spheres) list.fail("does not have the weight of every sphere's cell");
  list.read([&](std::size_t, std::size_t first, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) list.fail_at(first + i, "is no finite weight");
      weights.push_back(values[i]);
    }
  });
  return weights;
}

SpheresFile spheres_in(const Scene& scene, const std::filesystem::path& folder) {
  const std::filesystem::path file = where_it_stands(only_spheres_file_in(folder));
  if (file.filename() != spheres_as_array) return of_the_scene(scene, file, read_csv(file));
  SpheresFile read = of_the_scene(scene, file, {read_npy_spheres(file), {}});
  add_classes(scene, folder, read);
  return read;
}

}  // namespace

bool is_unpublished(const std::filesystem::path& folder) { return is_begun(FolderTree(folder)); }

Spheres<dynamic> read_csv_of(const Scene& scene, const std::filesystem::path& file) {
  return of_the_scene(scene, file, read_csv(file)).spheres;
}

Spheres<dynamic> read_columns_of(const Scene& scene, const std::filesystem::path& file) {
  NamedColumns read = read_spheres(file);
  return of_the_scene(scene, file, {std::move(read.spheres), std::move(read.unit)}).spheres;
}

std::filesystem::path spheres_of_result(const std::filesystem::path& folder) {
  return where_it_stands(spheres_file_in(folder));
}

Scene scene_of_result(const std::filesystem::path& folder) { return scene_in(folder); }

Spheres<dynamic> read_spheres_of(const Scene& scene, const std::filesystem::path& folder,
                                 std::vector<std::uint32_t>* classes) {
  SpheresFile read = spheres_in(scene, folder);
  std::vector<std::uint32_t> known = classes_in(scene, read);  // refuses those that the scene does not have
  if (classes) *classes = std::move(known);
  return std::move(read.spheres);
}

std::vector<std::uint32_t> classes_in(const Scene& scene, const SpheresFile& file) {
  const std::vector<SphereClass> known = classes_of(scene);
  if (file.class_names.empty() || known.empty()) return {};
  std::vector<std::uint32_t> number_of;
  for (const std::string& name : file.class_names) {
    const auto found = std::ranges::find(known, name, &SphereClass::name);
    if (found == known.end())
      throw Error(ErrorCode::bad_packing,
                  fmt::format("there are spheres of a class \"{}\", and the scene has only {}", name,
                              fmt::join(known | std::views::transform(&SphereClass::name), ", ")));
    number_of.push_back(static_cast<std::uint32_t>(found - known.begin()));
  }
  std::vector<std::uint32_t> classes = file.classes;
  for (std::uint32_t& of : classes) of = number_of[of];
  return classes;
}

Packing read_packing(const std::filesystem::path& folder) {
  std::error_code unknown;
  if (!std::filesystem::is_directory(folder, unknown)) {
    throw Error(ErrorCode::bad_packing, "is no folder; give the one that bernal pack wrote",
                {folder.string()});
  }
  Packing packing;
  packing.scene = scene_in(folder);
  SpheresFile read = spheres_in(packing.scene, folder);  // before another result replaces both
  packing.classes = classes_in(packing.scene, read);
  packing.spheres = std::move(read.spheres);
  packing.weights = weights_in(packing.scene, folder, packing.spheres.size());
  packing.domain = packed_domain_of(packing.scene);
  packing.volume = volume_of(packing.domain);
  packing.seed = packing.scene.seed;
  read_nest(packing, folder);
  if (const auto& start = packing.scene.start.file;
      start && std::filesystem::equivalent(where_it_stands(*start), spheres_of_result(folder), unknown))
    packing.outcome = Outcome::imported;  // only such a result begins from itself
  return packing;
}

std::string shortfall_of_result(const std::filesystem::path& folder) {
  const std::filesystem::path report = where_it_stands(folder / "report.json");
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(report, unknown)) return {};
  const auto said = summary_of_report(bytes_of_file(report));
  if (!said || said->outcome == name_of(Outcome::converged) || said->outcome == name_of(Outcome::imported))
    return {};
  return fmt::format("{}: {}", said->outcome, plain_text(said->reason));
}

}  // namespace bernal
