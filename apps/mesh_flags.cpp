#include "mesh_flags.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/scene/read_scene.hpp"
#include "measured.hpp"

using namespace bernal;

namespace {

Unit unit_of(const std::filesystem::path& file, const MeshFlags& flags) {
  if (!flags.unit.empty()) return unit_named(flags.unit);
  return flags.file_unit.empty() ? unit_of_mesh_file(file) : unit_named(flags.file_unit);
}

SceneSizes sizes_of(const MeshFlags& flags, Unit unit) {
  if (flags.largest && flags.lognormal.empty()) return Constant{1};
  if (!flags.radius.empty()) return Constant{number_of("--radius", flags.radius, Quantity::length, unit)};
  if (!flags.diameter.empty())
    return Constant{number_of("--diameter", flags.diameter, Quantity::diameter, unit)};
  return Lognormal{.median = number_of("--lognormal", flags.lognormal.at(0), Quantity::diameter, unit),
                   .sigma = number_of("--lognormal", flags.lognormal.at(1), Quantity::spread, unit)};
}

Scene scene_of_mesh(const std::filesystem::path& file, const MeshFlags& flags) {
  Scene scene;
  scene.unit = unit_of(file, flags);
  MeshFile mesh{.file = file};
  for (const std::string& plane : flags.cap) mesh.cap.push_back(without_unit(plane, scene.unit));
  if (!flags.file_unit.empty()) mesh.unit = unit_named(flags.file_unit);
  scene.container = std::move(mesh);
  scene.sizes_are_diameters = flags.radius.empty();
  scene.sizes = sizes_of(flags, scene.unit);
  if (flags.count > 0) scene.target.count = flags.count;
  scene.target.fill = flags.fill;
  scene.largest = flags.largest;
  complete(scene);
  return scene;
}

}  // namespace

std::string MeshFlags::given() const {
  std::vector<std::string_view> names;
  const std::pair<bool, std::string_view> all[] = {{!unit.empty(), "--unit"},
                                                   {!file_unit.empty(), "--file-unit"},
                                                   {!diameter.empty(), "--diameter"},
                                                   {!radius.empty(), "--radius"},
                                                   {!lognormal.empty(), "--lognormal"},
                                                   {count > 0, "--count"},
                                                   {fill, "--fill"},
                                                   {largest, "--largest"},
                                                   {!cap.empty(), "--cap"}};
  for (const auto& [is_given, name] : all)
    if (is_given) names.push_back(name);
  return fmt::format("{}", fmt::join(names, " and "));
}

std::vector<Option> options_of(MeshFlags& flags) {
  return {
      with_units({"--unit", &flags.unit,
                  "Of a mesh and of all lengths: nm, um, mm, cm, m, in, ft; a file that says its own, as "
                  "STEP does, needs none",
                  "UNIT"}),
      with_units({"--file-unit", &flags.file_unit,
                  "Of the mesh alone, where it is not the unit of the other lengths", "UNIT"}),
      measured({"--diameter", &flags.diameter,
                "Of every sphere in a mesh, with its own unit or without: 2 or \"2 mm\"", "D"}),
      excludes(measured({"--radius", &flags.radius, "Of every sphere in a mesh, instead of --diameter", "R"}),
               "--diameter"),
      excludes(excludes(list_of(2, measured({"--lognormal", &flags.lognormal, "Lognormal diameters in a mesh",
                                             "MEDIAN,SIGMA"})),
                        "--diameter"),
               "--radius"),
      within({"--count", &flags.count, "Spheres in a mesh; as many as are expected to fit if absent", "N"}, 1,
             2147483647),
      excludes({"--fill", &flags.fill, "As many spheres in a mesh as can be made to fit"}, "--count"),
      needs(excludes(excludes({"--largest", &flags.largest,
                               "As large as --count of them fit in a mesh, of one size or with --lognormal"},
                              "--diameter"),
                     "--radius"),
            "--count"),
      repeated({"--cap", &flags.cap,
                "A plane that closes an open mesh, such as \"z = 1.1\", in the unit of all lengths, or "
                "\"z = 40 mm\"; again for another",
                "PLANE"})};
}

Option scene_or_mesh(std::filesystem::path& to) {
  std::vector<std::string> endings{".toml"};
  for (const std::string_view ending : mesh_file_endings()) endings.emplace_back(ending);
  return file(
      required({"SCENE", &to, "The scene, a TOML file; or a mesh, with its unit and sizes", "SCENE|MESH"}),
      endings);
}

Scene scene_of(const std::filesystem::path& file, const MeshFlags& flags) {
  const bool is_mesh = is_mesh_file_name(file);
  if (flags.has_sizes() && (is_mesh || file.extension() != ".toml")) return scene_of_mesh(file, flags);
  if (is_mesh)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{} is a mesh, not a scene; say what is packed into it, such as --unit mm "
                    "--diameter 2 (a file that says its unit, as STEP does, needs no --unit), or name "
                    "it as \"file\" in the [container] of a scene",
                    file.string()));
  const std::string given = flags.given();
  if (!given.empty())
    throw Error(ErrorCode::bad_argument,
                flags.has_sizes() ? "a scene says itself what is packed; leave out " + given
                                  : given + (given.find(" and ") == std::string::npos ? " is" : " are") +
                                        " for a mesh, with --diameter, --radius or --lognormal");
  return read_scene(file);
}
