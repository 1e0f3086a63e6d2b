#include "bernal/result/write_packing.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/section.hpp"
#include "bernal/result/certify_levels.hpp"
#include "bernal/scene/read_scene.hpp"
#include "core/parallel.hpp"
#include "files/output_file.hpp"
#include "files/sha256.hpp"
#include "report/report.hpp"
#include "report/write_svg.hpp"
#include "result/nest_folder.hpp"
#include "result/result_folder.hpp"
#include "result/write_layers.hpp"
#include "result/write_off.hpp"
#include "result/write_output.hpp"
#include "result/write_spheres.hpp"
#include "result/write_vtp.hpp"
#include "scene/scene_sources.hpp"
#include "scene/spheres_file.hpp"
#include "viewer/viewer_data.hpp"

namespace bernal {
namespace {

/// Enough for curves that are smooth to the eye; `bernal measure` takes more.
constexpr double distances_for_a_report = 2e6, wall_distances_for_a_report = 2e5, places_for_a_report = 1e6;
constexpr std::uint32_t points_for_a_report = 4000, pore_points_for_a_report = 10000;
/// Of more spheres, cells and waves would take longer than many a packing; all cells of fewer already would,
/// of which a sample says nearly as much.
constexpr std::size_t most_for_a_report = 100'000, all_cells_for_a_report = 10'000, cells_for_a_report = 4000;
/// Of more spheres the search for pores would take as much memory as all the rest.
constexpr std::size_t most_for_pores = 20'000'000;

bool writes_array(const Packing& packing, const WriteOptions& options) {
  return options.as_array || packing.spheres.size() > options.most_as_text;
}

/// Certifies what stands in the file: that is what stands in memory, to the bit.
Certificate certify_written(const std::filesystem::path& file, const Packing& packing,
                            const WriteOptions& options) {
  require_written(file, packing, writes_array(packing, options));
  return certify(packing.spheres, packing.domain,
                 {.allowed_overlap = packing.scene.overlap,
                  .gap = packing.scene.gap,
                  .wall_gap = packing.scene.wall_gap,
                  .list = options.list});
}

/// Scripts are written to be changed, and then are their user's. What is larger nobody changes by hand, and
/// it would take seconds to read.
void add_changeable(const std::string& name, const std::filesystem::path& file, Manifest& manifest) {
  constexpr std::uintmax_t largest = 64 << 20;
  if (std::filesystem::file_size(file) <= largest) manifest[name] = sha256_of(file);
}

/// Empty in other dimensions than three, and where a container is too thin for a plane to have an area in it.
std::string middle_section(const Packing& packing) {
  if (packing.spheres.dimension() != 3) return {};
  try {
    return section_svg(section_of(packing.spheres, packing.domain, middle_plane(packing.domain)),
                       packing.spheres, name_of(packing.scene.unit));
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::string spheres_file_of(const Packing& packing, const WriteOptions& options) {
  return std::string(writes_array(packing, options) ? spheres_as_array : spheres_as_text);
}

namespace {

void go_on_if(const WriteOptions& options) {
  if (options.all_or_nothing && options.monitor.stop()) throw Cancelled();
}

/// What is written of a packing, and of those inside its spheres, into a staged folder.
struct StagedPacking {
  Certificate certificate;
  std::vector<std::string> notes;  // of outputs
  Manifest manifest;               // by names in the folder of this packing
};

/// What is written of one: of a packing inside of spheres, of which there may be one for each, what it takes
/// to read, certify and measure it.
enum class Extent { whole, inside };

StagedPacking stage(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                    const WriteOptions& options, Extent extent);

/// Those inside, each in a folder of its own, and nest.json, which says which sphere holds which.
void stage_insides(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                   const WriteOptions& options, StagedPacking& around) {
  if (packing.inside.empty()) return;
  const std::vector<InsideFiles> files = files_of_insides(packing);
  std::vector<std::vector<Certificate>> certificates;
  for (std::size_t k = 0; k < files.size(); ++k) {
    certificates.emplace_back();
    for (std::size_t t = 0; t < files[k].packings.size(); ++t) {
      const std::string& name = files[k].packings[t];
      const StagedFolder::Below below(staged, name);
      StagedPacking inside =
          stage(*packing.inside[k].templates[t], staged, folder / name, options, Extent::inside);
      for (const auto& [file, sha256] : inside.manifest)
        around.manifest[fmt::format("{}/{}", name, file)] = sha256;
      certificates.back().push_back(std::move(inside.certificate));
    }
  }
  write_nest(packing, staged);
  around.certificate = with_levels(std::move(around.certificate), packing, certificates);
}

Measurements measured_for_report(const Packing& packing, const SceneRadii& radii,
                                 const WriteOptions& options) {
  const std::size_t n = packing.spheres.size();
  return measure(packing.spheres, packing.domain, radii.asked,
                 {.gap = packing.scene.gap,
                  .wall_gap = packing.scene.wall_gap,
                  .radial = {.work = distances_for_a_report, .places = places_for_a_report},
                  .size_correlation = {.work = distances_for_a_report},
                  .chambers = {.points = points_for_a_report},
                  .bed = bed_options_of(packing.scene),
                  .walls = {.work = wall_distances_for_a_report},
                  .local = {.most_spheres = most_for_a_report,
                            .all_of = all_cells_for_a_report,
                            .looked_at = cells_for_a_report},
                  .structure = {.most_spheres = most_for_a_report},
                  .pores = {.points = n > most_for_pores ? 0 : pore_points_for_a_report},
                  .container = packing.container,
                  .monitor = options.monitor});
}

void stage_layers(const SphereLayers& layers, const Packing& packing, StagedFolder& staged) {
  if (layers.empty()) return;
  OutputFile table(staged.add(std::string(layers_as_text)));
  write_layers_csv(table, layers, packing);
  table.close();
}

/// scene.toml, whose text it returns.
std::string stage_scene(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                        const WriteOptions& options, Manifest& manifest) {
  const std::string scene =
      scene_as_toml(scene_as_run(packing, staged, folder, options.with_mesh, manifest), folder);
  staged.write("scene.toml", scene);
  manifest["scene.toml"] = sha256_of(staged.written("scene.toml"));
  return scene;
}

/// What the scene's outputs ask for, and the names of all files from `before` on, with those that follow.
void stage_outputs(const Packing& packing, StagedFolder& staged, const WriteOptions& options,
                   std::size_t before, const std::vector<std::string>& follow, StagedPacking& made) {
  const Monitor bar{options.monitor.on_progress, {}};  // what a cancelled run has is written whole
  const std::size_t own = staged.names().size();
  for (const Output& output : packing.scene.outputs)
    made.notes.push_back(write_output(packing, output, staged, bar));
  const auto name_here = [&](std::size_t k) { return staged.names()[k].substr(staged.below().size()); };
  for (std::size_t k = own; k < staged.names().size(); ++k)
    add_changeable(name_here(k), staged.written(name_here(k)), made.manifest);
  for (std::size_t k = before; k < staged.names().size(); ++k) made.manifest.try_emplace(name_here(k));
  for (const std::string& name : follow) made.manifest[name];
}

std::vector<std::string> sources_beside(const Packing& packing, const std::filesystem::path& folder) {
  std::vector<std::string> sources;
  for (const std::filesystem::path& source : sources_of_scene(packing.scene.file))
    sources.push_back(std::filesystem::proximate(source, folder).string());
  return sources;
}

/// The rest of what is written of a packing inside of spheres.
void stage_rest_of_inside(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                          const WriteOptions& options, std::size_t before, StagedPacking& made) {
  stage_scene(packing, staged, folder, options, made.manifest);
  stage_outputs(packing, staged, options, before, {"report.json"}, made);
  staged.write(
      "report.json",
      json_of(StreamedReport{packing, packing.spheres.size(), packing.packing_fraction(), made.certificate,
                             "it lies inside of spheres, where measuring each packing would take "
                             "longer than making it; bernal measure of this folder makes up for it",
                             hash_of(packing.spheres), made.manifest, sources_beside(packing, folder),
                             layer_amounts(packing)}));
}

StagedPacking stage(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                    const WriteOptions& options, Extent extent) {
  const auto go_on = [&] { go_on_if(options); };
  const bool is_whole = extent == Extent::whole;
  StagedPacking made;
  const std::size_t before = staged.names().size();
  const bool as_array = writes_array(packing, options);
  const std::filesystem::path spheres = staged.add(spheres_file_of(packing, options));
  write_spheres(spheres, packing, as_array);
  if (as_array && !packing.classes.empty())
    staged.write(std::string(classes_as_array), as_npy(packing.classes));
  if (!packing.weights.empty()) staged.write(std::string(weights_as_array), as_npy(packing.weights));
  const bool has_vtp = is_whole && !as_array;
  const std::filesystem::path vtp = has_vtp ? staged.add("spheres.vtp") : std::filesystem::path();
  Certificate& certificate = made.certificate = certify_written(spheres, packing, options);
  certificate.statement += certified_walls(packing.scene, packing.domain);
  go_on();
  Manifest& manifest = made.manifest;
  stage_insides(packing, staged, folder, options, made);
  const SphereLayers layers = as_array ? SphereLayers() : layers_of(packing);
  if (!is_whole) {
    stage_layers(layers, packing, staged);
    stage_rest_of_inside(packing, staged, folder, options, before, made);
    return made;
  }
  const SceneRadii radii = asked_radii_of(packing);
  const Measurements measured = measured_for_report(packing, radii, options);
  go_on();
  if (has_vtp) {
    OutputFile file(vtp);
    write_vtp(file, packing.spheres, name_of(packing.scene.unit), measured.of_contacts.coordination,
              packing.classes, columns_of_layers(layers, packing));
    file.close();
  }
  stage_layers(layers, packing, staged);
  const std::string scene = stage_scene(packing, staged, folder, options, manifest);
  const std::string picture = svg_of(packing.spheres, packing.domain, name_of(packing.scene.unit));
  if (!picture.empty()) staged.write("packing.svg", picture);
  const std::string section = middle_section(packing);
  if (!section.empty()) staged.write("section.svg", section);
  if (const auto* walls = std::get_if<Mesh>(&packing.domain); walls && walls_are_made(packing.scene))
    staged.write("container.off", as_off_file(*walls));
  stage_outputs(packing, staged, options, before, {"report.json", "report.html"}, made);
  const Report report{packing,
                      certificate,
                      measured,
                      radii.all.get(),
                      hash_of(packing.spheres),
                      manifest,
                      sources_beside(packing, folder),
                      options.cell,
                      layer_amounts(packing)};
  staged.write("report.json", json_of(report));
  const std::string view =
      options.view && has_view(packing.spheres.dimension()) ? view_data(packing, &measured) : std::string();
  staged.write("report.html", html_of(report, {picture, section, view}, scene));
  return made;
}

}  // namespace

WrittenPacking write_packing(const Packing& packing, const std::filesystem::path& folder,
                             const WriteOptions& options) {
  std::optional<Interruptible> interruptible;
  if (options.all_or_nothing) interruptible.emplace(options.monitor);
  go_on_if(options);
  StagedFolder staged(folder);
  const StagedPacking made = stage(packing, staged, folder, options, Extent::whole);

  // What the scene names stays where it is.
  std::vector<std::string> replaced = files_of_earlier_result(folder);
  std::erase_if(replaced, [&](const std::string& name) {
    return made.manifest.contains(name) && std::ranges::find(staged.names(), name) == staged.names().end();
  });
  go_on_if(options);
  return {staged.publish(replaced), made.certificate, made.notes};
}

}  // namespace bernal
