#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "scene/known_words.hpp"
#include "scene/output_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

/// Absent where it is empty.
static schema::Member name_of_output() {
  schema::Member member(&Output::file);
  member.get = [](const void* output) -> std::optional<schema::Value> {
    const std::string name = static_cast<const Output*>(output)->file.string();
    return name.empty() ? std::nullopt : std::optional<schema::Value>(name);
  };
  return member;
}

/// Takes a value and is never written.
static schema::Member older_name_of_density() {
  schema::Member member(&Output::material_density);
  member.get = [](const void*) -> std::optional<schema::Value> { return std::nullopt; };
  return member;
}

const std::vector<schema::Key>& output_keys() {
  using namespace schema;
  static const std::vector<Key> all = {
      key(Type::file, name_of_output(), "file",
          "its name in the folder of the result; if absent that of the format"),
      word(&Output::unit, "unit", "of its lengths; if absent the one that the program expects",
           {unit_names().begin(), unit_names().end()}),
      of_quantity(Quantity::density,
                  number(&Output::material_density, "material_density",
                         "of the spheres, in kg/m3; if absent the scene's, else that of glass, 2500",
                         above(0, 1e30))),
      of_quantity(Quantity::density, number(older_name_of_density(), "density",
                                            "an older name of material_density", above(0, 1e30))),
      integer(&Output::types, "types",
              "so many types of spheres, classes of radii of equal width; if absent one for every zone, else "
              "for every radius where at most ten occur, else one for all",
              {1, 1000}),
      length(
          &Output::voxel, "voxel",
          "edge of an image's voxels in the scene's unit; along axes that repeat themselves the nearest that "
          "divides the period"),
      integer(&Output::resolution, "resolution",
              "or so many voxels along the longest edge of the container's bounds; 256 if neither is given",
              {1, 10000}),
      word(&Output::values, "values",
           "of voxels: binary (0 pore, 1 sphere, 2 outside the container), labels (0, i + 1 for sphere i, "
           "4294967295), fraction (exact volume of spheres in the voxel over its own), materials or layers "
           "(0, "
           "k for the k-th that the scene's layers name, 255)",
           {"binary", "labels", "fraction", "materials", "layers"}),
      key(Type::text, &Output::material, "material",
          "of an image of values = \"fraction\": only the volume of what is made of this"),
      key(Type::text, &Output::layer, "layer",
          "what alone a file of triangles holds: a layer of the spheres by its name, closed by its outer and "
          "its inner surface; if absent whole spheres"),
      unless("true", flag(&Output::layers, "layers",
                          "false: whole spheres, though the scene names layers; else each layer by itself")),
      word(&Output::contact, "contact",
           "what becomes of spheres that touch or nearly do: none; gap (those shrink as far as it takes), "
           "shrink (all do, by one factor), bridge (cylinders join them) or cap (caps are cut off)",
           {"none", "gap", "shrink", "bridge", "cap"}),
      number(&Output::contact_gap, "contact_gap",
             "the gap that is meant there: between two spheres over the sum of their radii, to a wall over "
             "the radius",
             above(0, 0.5)),
      number(&Output::bridge_radius, "bridge_radius",
             "of the cylinders, over the smaller radius of the two spheres that they join", above(0, 0.9)),
      number(&Output::mesh_size, "mesh_size", "edge of an element on a sphere, over its radius", above(0, 2)),
      number(&Output::mesh_gap, "mesh_gap", "edge of an element in a narrow gap, over the gap's width",
             {0.05, 100}),
      integer(&Output::mesh_order, "mesh_order", "of the elements: 2 follows round surfaces", {1, 4}),
      word(&Output::surface, "surface",
           "what a file of triangles holds: spheres (cut and closed at the ends of periods), container, all "
           "(both) or pores (the boundary of the pore space, closed)",
           {"spheres", "container", "all", "pores"}),
      number(&Output::deflection, "deflection",
             "largest distance of a sphere from its triangles, over its radius; the triangles lie inside",
             {1e-5, 0.5})};
  return all;
}

schema::Entry output_entry(std::string_view name, std::string_view help,
                           const std::vector<std::string_view>& keys) {
  schema::Entry made{.name = name, .help = help, .keys = {}};
  constexpr std::array<std::string_view, 3> everywhere = {"file", "contact", "contact_gap"};
  for (const schema::Key& key : output_keys())
    if (std::ranges::find(everywhere, key.name) != everywhere.end() ||
        std::ranges::find(keys, key.name) != keys.end())
      made.keys.push_back(key);
  if (made.find("material_density")) made.choices = {{{"material_density"}, {"density"}, {}}};
  return schema::entry<Output>(std::move(made));
}

std::string_view contacts_that_use(const schema::Key& key, const Output& output) {
  if (key.name == "contact_gap" && output.contact == ContactTreatment::none)
    return "gap, shrink, bridge or cap";
  if (key.name == "bridge_radius" && output.contact != ContactTreatment::bridge) return "bridge";
  return {};
}

const OutputTable& table_of(const Output& output) {
  for (const OutputTable* table : output_tables())
    if (table->name() == output.format) return *table;
  throw Error(ErrorCode::bad_scene,
              fmt::format("unknown format {}{}", toml_string(output.format),
                          remedy_of_word(output.format, known_words_in(output_tables()))),
              output.locations.whole);
}

std::string file_beside(const std::filesystem::path& file, std::string_view ending) {
  return file.stem().string() + std::string(ending);
}

bool is_folder(const OutputTable& table, const std::filesystem::path& name) {
  return table.is_folder && !(std::filesystem::path(table.file).has_extension() && name.has_extension());
}

std::vector<std::string> files_of(const Output& output) {
  std::vector<std::string> names = {output.file.filename().string()};
  const OutputTable& table = table_of(output);
  const bool is_alone = !table.alone.empty() && output.file.extension() == table.alone;
  if (is_alone || is_folder(table, output.file)) return names;
  for (const std::string_view ending : table.endings) names.push_back(file_beside(output.file, ending));
  return names;
}

}  // namespace bernal
