#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/scene/read_scene.hpp"
#include "scene/schema.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Schema;

const Entry& entry_of(const std::vector<Entry>& entries, const Spec& spec) {
  if (const Entry* entry = Schema::find(entries, spec.name)) return *entry;
  throw Error(ErrorCode::bad_argument, fmt::format("no scene can name \"{}\"", spec.name), spec.where);
}

std::string distribution_as_toml(const Spec&);

/// `key = value` for every parameter that the spec has, in the order of the schema, each followed by `end`.
std::string assignments(const Spec& spec, const Entry& entry, std::string_view end) {
  std::string out;
  for (const schema::Key& key : entry.keys) {
    if (key.type == schema::Type::parts) {
      std::vector<std::string> parts;
      for (const Spec& part : spec.parts) parts.push_back(distribution_as_toml(part));
      out += fmt::format("{} = [{}]{}", key.name, fmt::join(parts, ", "), end);
    }
    if (const auto found = spec.parameters.find(key.name); found != spec.parameters.end())
      out += fmt::format("{} = {}{}", key.name, toml_text(found->second.value), end);
  }
  return out;
}

/// An inline table.
std::string distribution_as_toml(const Spec& spec) {
  std::string keys = assignments(spec, entry_of(schema::schema().distributions, spec), ", ");
  if (keys.ends_with(", ")) keys.resize(keys.size() - 2);
  return fmt::format("{{ distribution = {}, {} }}", toml_string(spec.name), keys);
}

std::string container_as_toml(Spec container, const std::filesystem::path& folder) {
  if (container.name == "mesh" && !folder.empty()) {
    Value& file = container.parameters["file"].value;
    file = std::filesystem::proximate(std::get<std::string>(file), folder).string();
  }
  const Entry& entry = entry_of(schema::schema().containers, container);
  return fmt::format("[container]\nkind = {}\n{}", toml_string(container.name),
                     assignments(container, entry, "\n"));
}

std::string spheres_as_toml(const Scene& scene) {
  std::string target;
  if (scene.target.count) target += fmt::format("count = {}\n", *scene.target.count);
  if (scene.target.packing_fraction)
    target += fmt::format("packing_fraction = {}\n", *scene.target.packing_fraction);
  else if (scene.target.predicted)
    target += "packing_fraction = \"predicted\"\n";
  if (scene.target.fill) target += "fill = true\n";
  return fmt::format("[spheres]\n{}{} = {}\ndraw = {}\n", target,
                     scene.sizes_are_diameters ? "diameter" : "radius", distribution_as_toml(scene.sizes),
                     toml_string(scene.draw));
}

}  // namespace

std::string stages_as_toml(const Scene& scene) {
  std::string out;
  for (const Spec& stage : scene.stages)
    out += fmt::format("{}[[stage]]\ndo = {}\n{}", out.empty() ? "" : "\n", toml_string(stage.name),
                       assignments(stage, entry_of(schema::schema().stages_for(scene), stage), "\n"));
  return out;
}

std::string scene_as_toml(const Scene& scene, const std::filesystem::path& folder) {
  if (scene.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    throw Error(ErrorCode::bad_argument,
                fmt::format("TOML cannot hold the seed {}: it is above 2^63 - 1", scene.seed));
  std::string out = fmt::format("unit = {}\nseed = {}\n\n", toml_string(scene.unit), scene.seed);
  out += fmt::format("{}\n{}\n", container_as_toml(scene.container, folder), spheres_as_toml(scene));
  out += fmt::format("[accuracy]\nwalls = {}\noverlap = {}\n", toml_string(scene.walls), scene.overlap);
  if (!scene.stages.empty()) out.append("\n").append(stages_as_toml(scene));
  return out;
}

}  // namespace bernal
