#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <sstream>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/read/caged_reader.hpp"
#include "cad/read/file_facts.hpp"
#include "cad/read/files_of_part.hpp"
#include "cad/read/placed_meshes.hpp"
#include "cad/read/polygon_soup.hpp"
#include "cad/read/slicer_parts.hpp"
#include "cad/read/xml_document.hpp"
#include "cad/read/zip_archive.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {
namespace {

using pugi::xml_node;
using Object = PlacedMeshes::Object;

constexpr XmlDocument::Namespace production{"http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
                                            "{production}"},
    beams{"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02", "{beams}"},
    slice{"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07", "{slice}"};

/// By the namespace of an extension: slices, materials and the like are not needed to read meshes; any other
/// required extension changes the meaning of the meshes.
bool is_read_without(std::string_view uri) {
  constexpr std::string_view extensions = "http://schemas.microsoft.com/3dmanufacturing/";
  if (!uri.starts_with(extensions)) return false;
  const std::string_view name = uri.substr(extensions.size());
  return std::ranges::any_of(
      std::initializer_list<std::string_view>{"core/", "production/", "material/", "slice/", "beamlattice/",
                                              "trianglesets/"},
      [&](std::string_view known) { return name.starts_with(known); });
}

void require_known_extensions(const XmlDocument& part) {
  std::istringstream prefixes{std::string(attribute_of(part.root(), "requiredextensions"))};
  for (std::string prefix; prefixes >> prefix;) {
    const std::string_view uri = part.namespace_of(prefix);
    if (uri.empty())
      part.refuse(part.root(), fmt::format("it requires the extension \"{0}\", and xmlns:{0} is missing",
                                           plain_text(prefix, 40)));
    if (!is_read_without(uri))
      part.refuse(part.root(), fmt::format("it requires the extension {}, which is not read; export plain "
                                           "meshes",
                                           plain_text(std::string(uri), 100)));
  }
}

/// The transform of an item or a component.
Eigen::Affine3d placement_of(const XmlDocument& part, xml_node node, const std::string& who) {
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  const std::string_view text = trimmed(attribute_of(node, "transform"));
  if (text.empty()) return placement;
  std::vector<double> numbers;
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t at = 0; at < text.size(); at = text.find_first_not_of(blanks, at)) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    numbers.push_back(part.number(text.substr(at, end - at), node, [&] {
      return fmt::format("number {} of the transform of {}", numbers.size() + 1, who);
    }));
    at = end;
  }
  if (numbers.size() != 12)
    part.refuse(node, fmt::format("the transform of {} has {} numbers, not 12", who, numbers.size()));
  // A row is the image of an axis, the last one that of the origin.
  for (int row = 0; row < 4; ++row)
    for (int axis = 0; axis < 3; ++axis) placement(axis, row) = numbers[std::size_t(3 * row + axis)];
  return placement;
}

void read_mesh(const XmlDocument& part, xml_node mesh, const std::string& who, Object& object) {
  for (const xml_node vertex : part.only_child(mesh, "vertices")) {
    if (!is_named(vertex, "vertex")) continue;
    const auto axis = [&](const char* letter) {
      return part.number(attribute_of(vertex, letter), vertex, [&] {
        return fmt::format("{} of vertex {} of {}", letter, object.points.size(), who);
      });
    };
    object.points.emplace_back(axis("x"), axis("y"), axis("z"));
  }
  auto& triangles = object.pieces.emplace_back().triangles;
  for (const xml_node triangle : part.only_child(mesh, "triangles")) {
    if (!is_named(triangle, "triangle")) continue;
    const auto corner = [&](const char* key) {
      return part.index(attribute_of(triangle, key), object.points.size(), triangle,
                        [&] { return fmt::format("triangle {} of {}", triangles.size(), who); });
    };
    triangles.push_back({corner("v1"), corner("v2"), corner("v3")});
  }
}

/// The model in a package: its root part, and the parts that this one names.
class ThreeMf {
 public:
  explicit ThreeMf(const std::filesystem::path& file) : archive_(file), root_(root_part()) {}

  ReadAttempt read() {
    ReadAttempt result;
    const XmlDocument& root = part(root_).xml;
    if (!is_named(root.root(), "model"))
      root.refuse(root.root(), fmt::format("its root is <{}>, not <model>", root.root().name()));
    set_unit(root.root(), result.facts);
    slicer_ = SlicerParts::of(archive_, result.facts.notes);
    std::vector<std::string> keys;
    for (const xml_node item : root.only_child(root.root(), "build"))
      if (is_named(item, "item")) add_item(root, item, keys);
    if (meshes_.items.empty() && unprinted_ == 0 && supports_ == 0) take_all(keys, result.facts);
    // The built objects, and all that they contain.
    while (!keys.empty()) {
      const std::string key = keys.back();
      keys.pop_back();
      if (!meshes_.objects.contains(key)) meshes_.objects[key] = object_of(key, keys);
    }
    append_placed(meshes_, result);
    note_left_out(result.facts);
    return result;
  }

 private:
  struct Part {
    XmlDocument xml;
    std::map<std::string, xml_node, std::less<>> objects;
  };

  /// By the relationships of the package; else at the usual path, or the first there is.
  std::string root_part() {
    if (const std::string* relationships = archive_.find("_rels/.rels")) {
      const XmlDocument rels(*relationships, archive_.read(*relationships));
      for (const xml_node one : rels.root())
        if (attribute_of(one, "Type").ends_with("/3dmodel"))
          if (const std::string* target = entry(attribute_of(one, "Target"))) return *target;
    }
    if (const std::string* usual = archive_.find("3D/3dmodel.model")) return *usual;
    for (const std::string& name : archive_.names())
      if (in_lower_case(name).ends_with(".model")) return name;
    throw Error(ErrorCode::bad_mesh, "an archive without an entry that ends in .model");
  }

  /// An entry as named in a part, possibly percent-encoded, relative to the root of the package.
  const std::string* entry(std::string_view name) const {
    name = trimmed(name);
    if (name.starts_with("./")) name.remove_prefix(2);
    const std::string* found = archive_.find(name);
    return found != nullptr ? found : archive_.find(percent_decoded(name));
  }

  Part& part(const std::string& name) {
    auto& found = parts_[name];
    if (found) return *found;
    found = std::make_unique<Part>(Part{{name, archive_.read(name), {production, beams, slice}}, {}});
    const XmlDocument& xml = found->xml;
    xml.require_namespaces();
    require_known_extensions(xml);
    for (const xml_node object : xml.only_child(xml.root(), "resources")) {
      if (!is_named(object, "object")) continue;
      const std::string id(trimmed(attribute_of(object, "id")));
      if (!found->objects.emplace(id, object).second)
        xml.refuse(object, fmt::format("two of its objects have the id {}", id));
    }
    return *found;
  }

  /// The key of a reference in a component or an item: the path of a part (by default the referring one) and
  /// an id, separated by a zero byte.
  std::string key_of(const XmlDocument& where, xml_node node, const std::string& inside,
                     const std::string& who) {
    const std::string_view path = path_of(node);
    const std::string* name = path.empty() ? &inside : entry(path);
    if (name == nullptr)
      where.refuse(node, fmt::format("{} names the part {}, which is not there", who, path));
    std::string id(trimmed(attribute_of(node, "objectid")));
    if (!part(*name).objects.contains(id))
      where.refuse(node, fmt::format("{} names object \"{}\", which {} does not hold", who, id, *name));
    return *name + '\0' + id;
  }

  void add_item(const XmlDocument& root, xml_node item, std::vector<std::string>& keys) {
    const std::string who = fmt::format("item {}", ++items_);
    if (attribute_of(item, "printable") == "0") {
      ++unprinted_;
      return;
    }
    std::string key = key_of(root, item, root_, who);
    if (!is_part(object_node(key))) {
      ++supports_;
      return;
    }
    keys.push_back(key);
    meshes_.items.push_back({std::move(key), placement_of(root, item, who)});
  }

  /// If nothing is built: the objects that no other contains.
  void take_all(std::vector<std::string>& keys, FileFacts& facts) {
    std::set<std::string, std::less<>> held;
    const Part& root = part(root_);
    for (const auto& [id, object] : root.objects)
      for (const xml_node component : child_of(object, "components"))
        if (path_of(component).empty()) held.emplace(trimmed(attribute_of(component, "objectid")));
    for (const auto& [id, object] : root.objects) {
      if (held.contains(id) || !is_part(object)) continue;
      keys.push_back(root_ + '\0' + id);
      meshes_.items.push_back({keys.back()});
    }
    if (!keys.empty()) facts.notes.push_back("the file builds nothing: its objects are taken as they stand");
  }

  xml_node object_node(const std::string& key) {
    const std::size_t end = key.find('\0');
    return part(key.substr(0, end)).objects.find(key.substr(end + 1))->second;
  }

  static std::string_view path_of(xml_node node) {
    const std::string_view path = attribute_of(node, "{production}path");
    return path.empty() ? attribute_of(node, "path") : path;
  }

  /// Whether it is a part, not a support or a modifier.
  static bool is_part(xml_node object) {
    const std::string_view type = attribute_of(object, "type");
    return !type.ends_with("support") && type != "other";
  }

  Object object_of(const std::string& key, std::vector<std::string>& keys) {
    const xml_node node = object_node(key);
    const std::string path = key.substr(0, key.find('\0')), id = key.substr(path.size() + 1);
    const std::string who = "object " + id;
    const XmlDocument& xml = part(path).xml;
    Object object{std::string(attribute_of(node, "name"))};
    if (object.name.empty()) object.name = slicer_.name_of(path == root_ ? id : "");
    const xml_node mesh = xml.only_child(node, "mesh"), components = xml.only_child(node, "components");
    if (!mesh.empty() && !components.empty())
      xml.refuse(node, fmt::format("{} has a mesh and components, and may have one of them", who));
    if (const std::string complaint = slicer_.error_about(path == root_ ? id : ""); !complaint.empty())
      xml.refuse(node, fmt::format("of {} {}", who, complaint));
    if (!mesh.empty()) {
      read_mesh(xml, mesh, who, object);
      const std::optional<std::size_t> others = path == root_ ? slicer_.split(id, object) : 0;
      supports_ += others.value_or(0);
      settings_of_others_ += !others;
      stand_ins_ += attribute_of(node, "{slice}meshresolution") == "lowres";
      lattices_ += !child_of(mesh, "{beams}beamlattice").empty();
    } else if (!components.empty()) {
      for (const xml_node component : components)
        if (is_named(component, "component")) add_component(xml, component, path, id, object, keys);
    } else {
      const xml_node other = node.find_child([](xml_node child) {
        return child.type() == pugi::node_element && !is_named(child, "metadatagroup");
      });
      xml.refuse(node, other.empty()
                           ? fmt::format("{} is empty", who)
                           : fmt::format("{} is given as <{}>, which is no mesh", who, other.name()));
    }
    return object;
  }

  void add_component(const XmlDocument& xml, xml_node component, const std::string& path,
                     const std::string& id, Object& object, std::vector<std::string>& keys) {
    const std::string who = fmt::format("a component of object {}", id);
    std::string key = key_of(xml, component, path, who);
    const std::string part_id(trimmed(attribute_of(component, "objectid")));
    if (!is_part(object_node(key)) || (path == root_ && !slicer_.is_part(id, part_id))) {
      ++supports_;
      return;
    }
    keys.push_back(key);
    object.components.push_back({std::move(key), placement_of(xml, component, who)});
  }

  void note_left_out(FileFacts& facts) const {
    const auto note = [&](std::size_t count, std::string_view one, std::string_view many,
                          std::string_view why) {
      if (count > 0) facts.notes.push_back(fmt::format("{} left out, {}", counted(count, one, many), why));
    };
    note(supports_, "object is", "objects are", "marked in the file as supports or modifiers");
    note(unprinted_, "item is", "items are", "marked in the file as not to be printed");
    if (settings_of_others_ > 0)
      facts.notes.push_back(
          "what the slicer says of the parts of an object is of another mesh: all of it is taken as a part");
    if (stand_ins_ > 0) facts.notes.push_back("its meshes approximate finer slices, which are not read");
    note(lattices_, "lattice of beams is", "lattices of beams are", "which have no triangles");
  }

  ZipArchive archive_;
  std::string root_;
  std::map<std::string, std::unique_ptr<Part>> parts_;
  PlacedMeshes meshes_;
  SlicerParts slicer_;
  std::size_t items_ = 0, supports_ = 0, unprinted_ = 0, lattices_ = 0, settings_of_others_ = 0,
              stand_ins_ = 0;
};

}  // namespace

ReadAttempt read_3mf(const std::filesystem::path& file) {
  ReadAttempt result = read_in_cage("pugixml", cage_limits(std::filesystem::file_size(file)),
                                    [&] { return ThreeMf(file).read(); });
  result.reader = "pugixml, double precision";
  return result;
}

}  // namespace bernal::cad
