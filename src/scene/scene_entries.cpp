#include "scene/scene_entries.hpp"

#include "scene/repetition.hpp"
#include "scene/scale_entry.hpp"
#include "scene/spheres_rules.hpp"
#include "scene/toml_text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace bernal {
namespace {

constexpr std::string_view wall_words[] = {"double", "filtered", "exact"};
constexpr std::string_view draw_words[] = {"random", "quantiles"};
constexpr std::string_view up_words[] = {"unchanged", "x", "y", "z"};
constexpr std::string_view interior_words[] = {"solid", "cavity"};

}  // namespace

std::string_view name_of(WallArithmetic walls) { return wall_words[static_cast<std::size_t>(walls)]; }
std::string_view name_of(Draw draw) { return draw_words[static_cast<std::size_t>(draw)]; }

}  // namespace bernal

namespace bernal::schema {
namespace {

std::vector<std::string_view> words(std::span<const std::string_view> of) { return {of.begin(), of.end()}; }

void box_rule(const Box& box, const Section& section) {
  if (box.repeats())
    section.refuse("size",
                   "must not repeat itself; a box that does is of the kind \"periodic\", a PeriodicBox");
}

/// Where nothing is said of the corner it is the origin, of as many coordinates as the box has.
void complete_box(Box& box, Scene&, const Section& section) {
  if (box.corner.size() == box.size.size()) return;
  if (section.locations.keys.contains("corner") || !box.corner.isZero(0))
    section.refuse("corner", fmt::format("must have {} coordinates, as \"size\" has", box.size.size()));
  box.corner = Vector<dynamic>::Zero(box.size.size());
}

void cylinder_rule(const Cylinder& cylinder, const Section& section) {
  if (cylinder.periodic && cylinder.coordinate_axis() < 0)
    section.refuse("axis", "must lie along x, y or z where \"periodic\" is true");
}

void periodic_rule(const PeriodicBox& box, const Section& section) {
  if (!box.size.empty() && static_cast<int>(box.size.size()) != box.dimension)
    section.refuse("size", fmt::format("must have a length for each of {} dimensions, but it has {}",
                                       box.dimension, box.size.size()));
  if (!box.walls.empty() && std::ranges::max(box.walls) >= box.dimension)
    section.refuse("walls", fmt::format("must name axes, each once, from 0 to {}", box.dimension - 1));
  tilt_rule(box, section);
}

/// Where nothing says how large the box is, the packing does.
void complete_periodic(PeriodicBox& box, Scene&, const Section&) {
  if (box.size.empty() && !box.edge) box.scalable = true;
}

/// A word, or a point.
Member interior() {
  Member member;
  member.get = [](const void* mesh) -> std::optional<Value> {
    const auto& of = static_cast<const MeshFile*>(mesh)->interior;
    if (const auto* point = std::get_if<Vector<3>>(&of)) return value_of(*point);
    return std::string(interior_words[static_cast<std::size_t>(std::get<Interior>(of))]);
  };
  member.set = [](void* mesh, const Value& value) {
    auto& of = static_cast<MeshFile*>(mesh)->interior;
    if (const auto* text = std::get_if<std::string>(&value))
      of = static_cast<Interior>(std::ranges::find(interior_words, *text) - interior_words);
    else
      take_value(of.emplace<Vector<3>>(), value);
  };
  return member;
}

Key interior_key() {
  Key made =
      key(Type::position, interior(), "interior",
          "what the surface encloses, the hollow of that (a bucket's inside), or the space around a point");
  made.words = words(interior_words);
  return made;
}

Member repair() {
  Member member;
  member.get = [](const void* mesh) {
    std::vector<std::string> all;
    for (const Repair r : static_cast<const MeshFile*>(mesh)->repair) all.emplace_back(name_of(r));
    return value_of(all);
  };
  member.set = [](void* mesh, const Value& value) {
    auto& of = static_cast<MeshFile*>(mesh)->repair;
    of.clear();
    for (const std::string& text : std::get<std::vector<std::string>>(value))
      of.push_back(static_cast<Repair>(std::ranges::find(repair_names, text) - repair_names));
  };
  return member;
}

constexpr std::string_view axis_words[] = {"x", "y", "z"};

/// Words of axes.
Member periodic_axes() {
  Member member;
  member.get = [](const void* mesh) {
    const auto& axes = static_cast<const MeshFile*>(mesh)->periodic;
    std::vector<std::string> all;
    for (std::size_t k = 0; k < 3; ++k)
      if (axes[k]) all.emplace_back(axis_words[k]);
    return value_of(all);
  };
  member.set = [](void* mesh, const Value& value) {
    auto& axes = static_cast<MeshFile*>(mesh)->periodic;
    axes = {};
    for (const std::string& text : std::get<std::vector<std::string>>(value))
      axes[static_cast<std::size_t>(std::ranges::find(axis_words, text) - axis_words)] = true;
  };
  return member;
}

void mesh_rule(const MeshFile& mesh, const Section& section) {
  if (mesh.ignore_unit_of_file && !mesh.unit)
    section.refuse("ignore_unit_of_file", "needs a \"unit\" beside it, that of the file's coordinates");
  if (mesh.sha256.size() > 1 + mesh.obstacles.size())
    section.refuse("sha256", "must be one for the file, then at most one for every obstacle");
  for (const std::string& digest : mesh.sha256)
    if (!is_sha256(digest))
      section.refuse("sha256", "must have 64 hexadecimal digits each, as sha256sum prints them");
}

}  // namespace

Key obstacles_key() {
  return {.name = "obstacles",
          .type = Type::solids,
          .help =
              "what is taken out of it: files of closed surfaces, and tables such as { kind = \"cylinder\", "
              "radius = 1, height = 9 }"};
}

Key rounding_key() {
  return length({}, "rounding", "its edges are rounded with this radius; if absent they are sharp");
}

std::vector<KnownWord> kinds_of_solids() {
  std::vector<KnownWord> kinds;
  for (const Entry& entry : container_entries())
    if (entry.find("obstacles")) kinds.emplace_back(entry.name, entry.help);
  return kinds;
}

const Entry& scene_entry() {
  static const Entry made = entry<Scene>(
      {.name = "scene",
       .help = "what stands at the top",
       .keys = {word(&Scene::unit, "unit", "unit of every length in the scene; required with a mesh",
                     words(unit_names())),
                integer(&Scene::seed, "seed", "one seed gives one packing, bit for bit", {0, 0x1p63})}});
  return made;
}

const Entry& accuracy_entry() {
  static const Entry made = entry<Scene>(
      {.name = "accuracy",
       .help = "how walls are decided and what the result may keep",
       .keys = {
           buys_accuracy(word(&Scene::walls, "walls",
                              "double, filtered (certified bounds, exact where they cannot decide) or exact",
                              words(wall_words))),
           buys_accuracy({1e-3, 1e-4, 1e-6, 0},
                         number(&Scene::overlap, "overlap",
                                "largest overlap ratio (ri + rj - d) / (ri + rj) that is allowed; 0: none",
                                {0, 1, false, true}))}});
  return made;
}

const std::array<const Entry*, 3>& own_entries() {
  static const std::array<const Entry*, 3> all = {&scene_entry(), &spheres_entry(), &accuracy_entry()};
  return all;
}

const std::vector<Entry>& container_entries() {
  static const std::vector<Entry> all = {
      entry<Box>({.name = "box",
                  .help = "a box along the axes; with two edges a rectangle, for discs",
                  .keys = {required(key(Type::extents, &Box::size, "size", "its edges")),
                           key(Type::corner, &Box::corner, "corner", "its lowest corner"), rounding_key(),
                           obstacles_key()},
                  .rule = rule(box_rule),
                  .complete = completion(complete_box)}),
      entry<Cylinder>(
          {.name = "cylinder",
           .help = "a circular cylinder along any axis",
           .keys = {required(length(&Cylinder::radius, "radius", "its radius")),
                    required(length(&Cylinder::height, "height", "its length along the axis")),
                    key(Type::direction, &Cylinder::axis, "axis",
                        "from the base to the top; its length is of no matter"),
                    key(Type::position, &Cylinder::base, "base", "the middle of its base"),
                    flag(&Cylinder::periodic, "periodic",
                         "true: no lids, an endless column that repeats itself with the period height; its "
                         "axis lies along x, y or z"),
                    rounding_key(), obstacles_key()},
           .rule = rule(cylinder_rule)}),
      entry<MeshFile>(
          {.name = "mesh",
           .help = "a closed surface from a CAD file",
           .keys = {required(key(Type::file, &MeshFile::file, "file",
                                 "STL, OBJ, PLY, OFF, 3MF, AMF, glTF, Collada, FBX, STEP, IGES, BREP")),
                    word(&MeshFile::unit, "unit",
                         "unit of the file's coordinates; if absent what the file says, else the scene's",
                         words(unit_names())),
                    unless("false", flag(&MeshFile::ignore_unit_of_file, "ignore_unit_of_file",
                                         "true: \"unit\" holds though the file says otherwise")),
                    unless(toml_string(up_words[0]),
                           word(&MeshFile::up, "up", "the axis of the file that points up is turned to z",
                                words(up_words))),
                    names(&MeshFile::solids, "solids",
                          "those of the file's solids that are meant, by name or by number from 1"),
                    obstacles_key(),
                    length(&MeshFile::weld, "weld",
                           "corners of open edges up to this far apart are one; if absent, what rounding "
                           "explains"),
                    buys_accuracy({10, 3, 1, 0.3, 0.1}, length(&MeshFile::deflection, "deflection",
                                                               "of STEP, IGES and BREP: how far triangles "
                                                               "may lie from the true surface; if absent "
                                                               "a fiftieth of the smallest radius")),
                    unless("false",
                           flag(&MeshFile::true_surface, "true_surface",
                                "true: of STEP, IGES and BREP: spheres lie inside the surface itself, as "
                                "is proven, not inside of its triangles, which are a thousandth of the "
                                "smallest radius from it unless \"deflection\" says otherwise")),
                    names(repair(), "repair",
                          "what may be done to a surface that is no wall: close holes, cut out "
                          "self-intersections, wrap it",
                          words(repair_names)),
                    length(&MeshFile::largest_hole, "largest_hole",
                           "holes up to this width are closed; if absent up to half of the part's: what "
                           "is wider is an open top"),
                    of_quantity(Quantity::length,
                                names(&MeshFile::cap, "cap",
                                      "planes that close open ends, \"z = 1.1\" or \"x < 5 mm\": what they "
                                      "cut off is outside")),
                    of_quantity(Quantity::length, number(&MeshFile::fill_level, "fill_level",
                                                         "what lies higher than this z is outside",
                                                         {-largest_length, largest_length})),
                    unless("\"solid\"", interior_key()),
                    names(
                        periodic_axes(), "periodic",
                        "axes along which it repeats itself, \"z\" or [\"x\", \"y\"], as a channel does: its "
                        "flat or open ends there match and are openings; the period is its extent",
                        words(axis_words)),
                    names(&MeshFile::sha256, "sha256",
                          "of the file, then of every obstacle, as sha256sum prints it: with other bytes "
                          "they are refused; a result names it; a glTF counts together with its buffers, "
                          "cat part.gltf part.bin | sha256sum")},
           .rule = rule(mesh_rule)}),
      entry<Sphere>(
          {.name = "sphere",
           .help = "a sphere",
           .keys = {required(length(&Sphere::radius, "radius", "its radius")),
                    key(Type::position, &Sphere::center, "center", "its centre"), obstacles_key()}}),
      entry<PeriodicBox>(
          {.name = "periodic",
           .help = "a box that repeats itself in all directions, or in all but those with walls",
           .keys = {integer(&PeriodicBox::dimension, "dimension", "of space", {1, max_dimension}),
                    required(key(Type::lengths, &PeriodicBox::size, "size", "its edges")),
                    required(length(&PeriodicBox::edge, "edge", "all its edges")),
                    key(Type::coordinates, &PeriodicBox::tilt, "tilt",
                        "xy, xz and yz of its cell vectors (lx, 0, 0), (xy, ly, 0) and (xz, yz, lz); in two "
                        "dimensions xy"),
                    key(Type::axes, &PeriodicBox::walls, "walls",
                        "axes, counted from 0, along which the box does not repeat itself but ends at walls, "
                        "with whole spheres between them; [] for none"),
                    flag(&PeriodicBox::scalable, "scalable",
                         "the packing decides how large the box is; size only gives its proportions")},
           .choices = {{{"size"}, {"edge"}, {}}},
           .rule = rule(periodic_rule),
           .complete = completion(complete_periodic)}),
      polygon_entry(),
      cone_entry(),
      tube_entry(),
      lathed_entry(),
      extruded_entry()};
  return all;
}

}  // namespace bernal::schema
