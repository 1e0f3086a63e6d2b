#include <algorithm>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/output_table.hpp"
#include "scene/repetition.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

using schema::check;
using schema::Key;
using schema::Section;

void require_names(const Scene& scene) {
  std::set<std::string, std::less<>> taken(names_of_result.begin(), names_of_result.end());
  for (const Output& output : scene.outputs) {
    const Section section = section_of(output);
    if (output.file != output.file.filename() || output.file.string().starts_with('.'))
      section.refuse("file",
                     fmt::format("must be the name of a file in the folder of the result, without a dot "
                                 "before it, not {}",
                                 toml_string(output.file.string())));
    for (const std::string& name : files_of(output))
      if (!taken.insert(name).second)
        section.fail("file", fmt::format("{} would write {}, which {}; give it another \"file\"",
                                         section.name, toml_string(name),
                                         std::ranges::find(names_of_result, name) == names_of_result.end()
                                             ? "an output before it writes too"
                                             : "is a file of every result"));
  }
}

namespace {

/// No writer has to fear the name that it writes into comments and scripts.
void require_plain_name(const Output& output, const OutputTable& table, const Section& section) {
  const std::string name = output.file.filename().string();
  const auto fail = [&](std::string_view why) {
    section.fail("file", fmt::format("the \"file\" {} {}; give it another name", toml_string(name), why));
  };
  if (with_escaped_controls(name) != name)
    fail("has control characters, which no name of an output may have");
  if (name.starts_with(".bernal-")) fail("is a name that bernal needs while it writes");
  if (!table.endings.empty() && !is_utf8(name)) fail("is not UTF-8, which the files that name it have to be");
  for (const std::string_view ending : table.endings)
    if (file_beside(output.file, ending) == name)
      fail(fmt::format("ends as the file does that {} writes beside it, \"{}\"", table.name(), ending));
}

/// Throws unless the format holds what is told by a member.
void require_held(const OutputTable& table, bool OutputTable::*held, std::string_view what,
                  const Section& section) {
  if (table.*held) return;
  std::vector<std::string_view> others;
  for (const OutputTable* other : output_tables())
    if (other->*held) others.push_back(other->name());
  section.fail("format", fmt::format("the format \"{}\" holds no {}; \"{}\" can", table.name(), what,
                                     fmt::join(others, "\", \"")));
}

}  // namespace

void complete_output(Output& output, const Scene& scene) {
  const OutputTable& table = table_of(output);
  const Section section = section_of(output);
  check(table.keys, &output, section);
  const int dimension = scene.dimension();
  if (dimension < table.least_dimension || dimension > table.most_dimensions) {
    std::vector<std::string_view> others;
    for (const OutputTable* other : output_tables())
      if (dimension >= other->least_dimension && dimension <= other->most_dimensions)
        others.push_back(other->name());
    section.fail(
        "format",
        fmt::format("the format \"{}\" cannot hold a packing of {} dimension{}; \"{}\" can", table.name(),
                    dimension, dimension == 1 ? "" : "s", fmt::join(others, "\", \"")));
  }
  if (schema::is_tilted(scene)) require_held(table, &OutputTable::tilted, "tilted periodic box", section);
  if (schema::is_repeated_mesh(scene))
    require_held(table, &OutputTable::repeated_mesh, "packing in a mesh that repeats itself", section);
  if (!table.has_bridges() && output.contact != ContactTreatment::none && !shrinks(output.contact)) {
    std::vector<std::string_view> others;
    for (const OutputTable* other : output_tables())
      if (other->has_bridges()) others.push_back(other->name());
    section.fail("contact", fmt::format("the format \"{}\" holds whole spheres: contact is gap or shrink; "
                                        "{} have bridges and caps, and bernal mesh makes tetrahedra of them",
                                        table.name(), fmt::join(others, " and ")));
  }
  if (const auto& said = section.locations.keys;
      said.contains("density") && said.contains("material_density"))
    section.fail("density",
                 fmt::format("\"density\" in {} is an older name of \"material_density\"; give one "
                             "of them",
                             section.name));
  if (!output.material_density && table.keys.find("material_density"))
    output.material_density = usual_density(scene);
  for (const Key& key : table.keys.keys)
    if (const auto users = contacts_that_use(key, output);
        !users.empty() && section.locations.keys.contains(key.name))
      section.fail(key.name, fmt::format("\"{}\" in {} acts where contact is {} only; say so or leave it out",
                                         key.name, section.name, users));
  constexpr int resolution_of_images = 256;
  if (output.file.empty()) output.file = table.file;
  require_plain_name(output, table, section);
  require_layers_of_output(output, scene);
  if (table.keys.find("resolution") && !output.voxel && !output.resolution)
    output.resolution = resolution_of_images;
  if (!output.unit || !table.keys.find("unit")) output.unit = table.unit.value_or(scene.unit);
  if (schema::is_repeated_mesh(scene) && output.contact != ContactTreatment::none &&
      output.unit != scene.unit)
    section.fail("contact",
                 fmt::format("in a mesh that repeats itself contacts are treated in the unit of the scene "
                             "only, as its period is exact in that; give unit = \"{}\"",
                             name_of(scene.unit)));
}

}  // namespace bernal
