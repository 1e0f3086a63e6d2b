#include "scene/scene_entries.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "scene/cells_entry.hpp"
#include "scene/layer_entry.hpp"
#include "scene/scale_entry.hpp"
#include "scene/spheres_rules.hpp"

namespace bernal::schema {
namespace {

/// A number, or "predicted".
Member packing_fraction() {
  Member member;
  member.get = [](const void* scene) -> std::optional<Value> {
    const Target& target = static_cast<const Scene*>(scene)->target;
    if (target.packing_fraction) return *target.packing_fraction;
    return target.predicted ? std::optional<Value>(std::string("predicted")) : std::nullopt;
  };
  member.set = [](void* scene, const Value& value) {
    Target& target = static_cast<Scene*>(scene)->target;
    target.predicted = std::holds_alternative<std::string>(value);
    if (!target.predicted) target.packing_fraction = std::get<double>(value);
  };
  return member;
}

/// Said only where it is true.
Member fill() {
  Member member(&Target::fill);
  member.get = [](const void* target) -> std::optional<Value> {
    return static_cast<const Target*>(target)->fill ? std::optional<Value>(true) : std::nullopt;
  };
  return member.inside(&Scene::target);
}

/// The same of what the scene says of a bed.
template <class M>
Member of_bed(M BedTarget::*member) {
  return Member(member).inside(&Target::bed).inside(&Scene::target);
}

/// The same of what the scene says of its start.
template <class M>
Member of_start(M Start::*member) {
  return Member(member).inside(&Scene::start);
}

/// The file of a zone's surface; the digest is said only of such a zone.
Member file_of_zone() {
  Member member;
  member.get = [](const void* of) -> std::optional<Value> {
    const auto& mesh = static_cast<const Zone*>(of)->mesh;
    return mesh ? std::optional<Value>(mesh->file.string()) : std::nullopt;
  };
  member.set = [](void* of, const Value& value) {
    auto& mesh = static_cast<Zone*>(of)->mesh;
    (mesh ? *mesh : mesh.emplace()).file = std::get<std::string>(value);
  };
  return member;
}
Member digest_of_zone() {
  Member member;
  member.get = [](const void* of) -> std::optional<Value> {
    const auto& mesh = static_cast<const Zone*>(of)->mesh;
    return mesh ? value_of(mesh->sha256) : std::nullopt;
  };
  member.set = [](void* of, const Value& value) {
    auto& mesh = static_cast<Zone*>(of)->mesh;
    take_value((mesh ? *mesh : mesh.emplace()).sha256, value);
  };
  return member;
}

void zone_rule(const Zone& zone, const Section& section) {
  if (zone.mesh && zone.mesh->file.empty())
    section.fail("mesh_sha256", "\"mesh_sha256\" is of a \"mesh\", and there is none: leave it out");
  if (zone.mesh && zone.mesh->sha256.size() > 1)
    section.refuse("mesh_sha256", "must be one, for the file of \"mesh\"");
}

void spheres_rule(const Scene& scene, const Section& section) {
  scale_rule(scene, section);
  amounts_rule(scene, section);
  if (const BedTarget& bed = scene.target.bed; bed.heap_angle && bed.top != BedTarget::Top::heap)
    section.fail("heap_angle",
                 "\"heap_angle\" in [spheres] is of a heap: say top = \"heap\", or leave it out");
  // The one that is read last is all that the scene still holds.
  const auto& said = section.locations.keys;
  for (const auto& [one, other] :
       {std::pair("diameter", "radius"), {"cells", "radius"}, {"cells", "diameter"}})
    if (said.contains(one) && said.contains(other))
      section.fail(one, fmt::format("\"{}\" and \"{}\" in [spheres] exclude each other; give one of them",
                                    other, one));
  start_rule(scene, section);
  layers_rule(scene.layers, "layers", "layers in [spheres]", section);
}

void spheres_of_zone_rule(const Scene& scene, const Section& section) {
  if (scene.largest || (std::holds_alternative<Constant>(scene.sizes) && !scene.draws()))
    section.fail("", fmt::format("{} needs exactly one of \"radius\", \"diameter\"", section.name));
  amounts_rule(scene, section);
  layers_rule(scene.layers, "layers", "layers in " + section.name, section);
}

}  // namespace

const Entry& spheres_entry() {
  static const Entry made = [] {
    Entry of{
        .name = "spheres",
        .help = "how many spheres there are, and how large",
        .keys = {integer(Member(&Target::count).inside(&Scene::target), "count", "stop at this many spheres",
                         {1, 0x1p31 - 1}),
                 number(packing_fraction(), "packing_fraction",
                        "stop when the spheres fill this fraction of the container; \"predicted\": as "
                        "much as is predicted, less the error of that",
                        packing_fractions()),
                 flag(fill(), "fill", "true: as many spheres as the stages can place", {1, 1}),
                 of_quantity(Quantity::mass,
                             number(Member(&Target::mass).inside(&Scene::target), "mass",
                                    "of all spheres, \"2 kg\" or in kg, in place of a count: with the "
                                    "material_density as many as weigh that",
                                    above(0, largest_length))),
                 length(of_bed(&BedTarget::height), "height",
                        "of a bed: as many spheres as make its surface lie so high above the lowest point"),
                 number(of_bed(&BedTarget::layers), "bed_layers",
                        "the height of a bed in mean diameters of the spheres", above(0, 1e9)),
                 word(of_bed(&BedTarget::density), "bed",
                      "a bed under gravity: poured (settled without friction), vibrated (denser) or loose "
                      "(arches that friction holds are kept)",
                      {"poured", "vibrated", "loose"}),
                 word(of_bed(&BedTarget::top), "top",
                      "of a bed: free (as the spheres fall), level (none above a plane) or heap (none above "
                      "a cone)",
                      {"free", "level", "heap"}),
                 number(of_bed(&BedTarget::heap_angle), "heap_angle",
                        "of the flanks of a heap with the level, in degrees; if absent 20", above(0, 45)),
                 number(of_bed(&BedTarget::porosity), "porosity",
                        "of a bed, up to its surface, in place of bed = …: the share of the volume that is "
                        "left free; where there is no bed, 1 - packing_fraction",
                        between(0.2, 0.95)),
                 of_quantity(Quantity::density,
                             number(Member(&Target::bulk_density).inside(&Scene::target), "bulk_density",
                                    "in kg/m3, in place of a porosity: 1 - bulk_density / material_density",
                                    above(0, largest_length))),
                 of_quantity(Quantity::density,
                             number(&Scene::material_density, "material_density",
                                    "of the spheres themselves, in kg/m3: 2500 is glass, 7850 steel",
                                    above(0, largest_length))),
                 key(Type::text, &Scene::material, "material",
                     "what the spheres are made of, by name: a column of the result"),
                 tables(&Scene::layers, layer_entry, "layers",
                        "of every sphere, from the centre out; at most one has no thickness, radius or "
                        "share, and takes what is left"),
                 size_key(false),
                 size_key(true),
                 cells_key(),
                 scale_key(),
                 of_quantity(Quantity::length,
                             number(&Scene::gap, "gap",
                                    "least distance between the surfaces of two spheres, and of a sphere "
                                    "and its own image",
                                    {0, largest_length})),
                 of_quantity(Quantity::length, number(&Scene::wall_gap, "wall_gap",
                                                      "least distance of a sphere's surface from the walls",
                                                      {0, largest_length})),
                 word(&Scene::draw, "draw",
                      "sizes at random, or quantiles: evenly over the distribution; if absent quantiles "
                      "where relax or grow packs a container, and wherever few spheres carry much of the "
                      "volume; else random",
                      {name_of(Draw::random), name_of(Draw::quantiles)}),
                 key(Type::file, of_start(&Start::file), "start",
                     "spheres to begin from: a CSV file whose header names x, y, z and r or d, or a "
                     "folder with a result; those that are drawn come after them, and where no sizes "
                     "are given these are all there are"),
                 word(of_start(&Start::unit), "start_unit",
                      "of the start, where its file has no line \"# unit: mm\"; if absent the scene's",
                      {unit_names().begin(), unit_names().end()}),
                 key(Type::lengths, of_start(&Start::box), "start_box",
                     "in periodic boxes: edges of the one that the start lies in; if absent those of "
                     "the folder's box, else the size of the container"),
                 names(of_start(&Start::sha256), "start_sha256",
                       "of the start's file, as sha256sum prints it: other bytes are refused; a result "
                       "names it"),
                 tables(&Scene::inside, inside_entry, "inside",
                        "packings in the innermost layer of the spheres of a class")},
        .choices = {{{"count"},
                     {"packing_fraction"},
                     {"fill"},
                     {"count", "packing_fraction"},
                     {"height"},
                     {"bed_layers"},
                     {"mass"},
                     {"mass", "packing_fraction"},
                     {}},
                    {{"bed"}, {"porosity"}, {"bulk_density"}, {}},
                    {{"radius"}, {"diameter"}, {"cells"}}},
        .rule = rule(spheres_rule)};
    of.keys[1].words = {"predicted"};
    return entry<Scene>(std::move(of));
  }();
  return made;
}

const Entry& inside_entry() {
  static const Entry made = entry<Inside>(
      {.name = "inside",
       .help = "a packing in the innermost layer of every sphere of a class",
       .keys = {required(key(Type::file, &Inside::scene, "scene",
                             "of what lies inside: its container is the ball that the layer is, and may be "
                             "left out there")),
                key(Type::text, &Inside::of_class, "class",
                    "whose spheres are filled; may be absent where there is only one"),
                key(Type::text, &Inside::layer, "layer",
                    "the innermost of these spheres; may be absent where they have no layers"),
                integer(&Inside::templates, "templates",
                        "so many packings, each in many spheres, turned at random; if absent every sphere "
                        "has its own",
                        {1, 1e6})}});
  return made;
}

const Entry& zone_entry() {
  static const Entry made = entry<Zone>(
      {.name = "zone",
       .help = "a part of the container with sizes, an amount and a material of its own",
       .keys = {key(Type::text, &Zone::name, "name",
                    "of its spheres, in the column class; if absent the material, where no other has that, "
                    "else zone and its number"),
                of_quantity(
                    Quantity::length,
                    names(&Zone::place, "place",
                          "planes, \"z < 20\" or [\"x > 5 mm\", \"x < 15 mm\"]: the zone lies on that "
                          "side of each; where spheres settle it may be absent, and the zone lies "
                          "on those before it")),
                names(&Zone::solids, "solid",
                      "of the container's file, by name or by number from 1, or several of them"),
                integer(&Zone::chamber, "chamber",
                        "of a mesh of several closed spaces, by number from 1, which is the largest",
                        {1, 1e6}),
                key(Type::file, file_of_zone(), "mesh",
                    "a CAD file: a closed surface within the container, in the unit of the container's file "
                    "or of the scene where its format carries none"),
                names(digest_of_zone(), "mesh_sha256",
                      "of the file of mesh, as sha256sum prints it: other bytes are refused; a result names "
                      "it")},
       .choices = {{{"place"}, {"solid"}, {"chamber"}, {"mesh"}, {}}},
       .rule = rule(zone_rule)});
  return made;
}

const Entry& spheres_of_zone_entry() {
  static const Entry made = [] {
    Entry of = spheres_entry();
    of.name = "zone";
    constexpr std::string_view of_all[] = {"gap",   "wall_gap",     "start",      "start_unit", "start_box",
                                           "bed",   "start_sha256", "bed_layers", "height",     "top",
                                           "scale", "heap_angle",   "cells",      "inside"};
    std::erase_if(of.keys,
                  [&](const Key& key) { return std::ranges::find(of_all, key.name) != std::end(of_all); });
    for (Key& key : of.keys)
      if (key.name == "radius" || key.name == "diameter") key.words.clear();
    of.choices = {{{"count"}, {"packing_fraction"}, {"fill"}, {"mass"}, {}},
                  {{"porosity"}, {"bulk_density"}, {}},
                  {{"radius"}, {"diameter"}}};
    of.rule = rule(spheres_of_zone_rule);
    return of;
  }();
  return made;
}

}  // namespace bernal::schema
