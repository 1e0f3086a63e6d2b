#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/diagnose/counted.hpp"
#include "cad/read/caged_reader.hpp"
#include "cad/read/file_facts.hpp"
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

std::string_view text_of(xml_node node) { return node.child_value(); }

std::string metadata_of(xml_node node, std::string_view type) {
  for (const xml_node child : node)
    if (is_named(child, "metadata") && attribute_of(child, "type") == type)
      return std::string(trimmed(text_of(child)));
  return {};
}

/// Whether it is a part, not a support or (PrusaSlicer's) modifier.
bool is_part(xml_node volume) {
  const std::string type = metadata_of(volume, "slic3r.volume_type");
  const bool changes = type.empty() ? metadata_of(volume, "slic3r.modifier") == "1" : type != "ModelPart";
  return !changes && attribute_of(volume, "type") != "support";
}

class Amf {
 public:
  explicit Amf(std::string name, std::string text) : xml_(std::move(name), std::move(text)) {}

  ReadAttempt read() {
    ReadAttempt result;
    const xml_node root = xml_.root();
    if (!is_named(root, "amf")) xml_.refuse(root, fmt::format("its root is <{}>, not <amf>", root.name()));
    set_unit(root, result.facts);
    in_radians_ = !metadata_of(root, "slic3rpe_amf_version").empty();
    for (const xml_node child : root) {
      const std::string id(attribute_of(child, "id"));
      if (is_named(child, "object")) add(objects_, id, child);
      if (is_named(child, "constellation")) add(constellations_, id, child);
    }
    for (const xml_node object : objects_.nodes) meshes_.objects[key_of(object)] = object_of(object);
    for (const xml_node constellation : constellations_.nodes)
      meshes_.objects[key_of(constellation)] = constellation_of(constellation);
    for (const auto* all : {&objects_, &constellations_})
      for (const xml_node node : all->nodes)
        if (!instanced_.contains(key_of(node))) meshes_.items.push_back({key_of(node)});
    append_placed(meshes_, result);
    note_left_out(result.facts);
    return result;
  }

 private:
  struct Nodes {
    std::vector<xml_node> nodes;
    std::map<std::string, xml_node> by_id;  ///< the first with each id
  };
  static void add(Nodes& all, const std::string& id, xml_node node) {
    all.nodes.push_back(node);
    all.by_id.emplace(id, node);
  }
  /// Ids are not unique: an object and a constellation may share one.
  static std::string key_of(xml_node node) { return fmt::format("{}", node.offset_debug()); }

  Object object_of(xml_node node) {
    const std::string who = fmt::format("object {}", attribute_of(node, "id"));
    Object object{metadata_of(node, "name")};
    for (const xml_node mesh : node) {
      if (!is_named(mesh, "mesh")) continue;
      const auto first = static_cast<std::uint32_t>(object.points.size());
      add_points(child_of(mesh, "vertices"), who, object);
      for (const xml_node volume : mesh) {
        if (!is_named(volume, "volume") && !is_named(volume, "region")) continue;
        if (is_negative(metadata_of(volume, "slic3r.volume_type")))
          xml_.refuse(volume,
                      fmt::format("of {} {}", who, error_about_negative(metadata_of(volume, "name"))));
        if (is_part(volume))
          add_volume(volume, first, who, object);
        else
          ++supports_;
      }
    }
    return object;
  }

  void add_points(xml_node vertices, const std::string& who, Object& object) {
    for (const xml_node vertex : vertices) {
      if (!is_named(vertex, "vertex")) {
        curved_ = curved_ || is_named(vertex, "edge");
        continue;
      }
      curved_ = curved_ || !child_of(vertex, "normal").empty();
      const xml_node coordinates = child_of(vertex, "coordinates");
      const auto axis = [&](const char* letter) {
        return xml_.number(text_of(child_of(coordinates, letter)), vertex, [&] {
          return fmt::format("{} of vertex {} of {}", letter, object.points.size(), who);
        });
      };
      object.points.emplace_back(axis("x"), axis("y"), axis("z"));
    }
  }

  void add_volume(xml_node volume, std::uint32_t first, const std::string& who, Object& object) {
    const std::size_t count = object.points.size() - first;
    PlacedMeshes::Piece piece{metadata_of(volume, "name")};
    for (const xml_node triangle : volume) {
      if (!is_named(triangle, "triangle")) continue;
      const auto corner = [&](const char* key) {
        return first + xml_.index(text_of(child_of(triangle, key)), count, triangle, [&] {
          return fmt::format("triangle {} of {}", piece.triangles.size(), who);
        });
      };
      piece.triangles.push_back({corner("v1"), corner("v2"), corner("v3")});
    }
    object.pieces.push_back(std::move(piece));
  }

  Object constellation_of(xml_node node) {
    Object object{metadata_of(node, "name")};
    for (const xml_node instance : node) {
      if (!is_named(instance, "instance")) continue;
      const std::string id(attribute_of(instance, "objectid"));
      auto found = objects_.by_id.find(id);
      if (found == objects_.by_id.end()) found = constellations_.by_id.find(id);
      if (found == constellations_.by_id.end())
        xml_.refuse(instance, fmt::format("an instance names object \"{}\", which is not there", id));
      const std::string key = key_of(found->second);
      instanced_.insert(key);
      if (trimmed(text_of(child_of(instance, "printable"))) == "0")
        ++unprinted_;
      else
        object.components.push_back({key, placement_of(instance)});
    }
    return object;
  }

  /// Mirrored and scaled (written by slicers only), rotated about x, then y, then z, and translated.
  Eigen::Affine3d placement_of(xml_node instance) const {
    const auto value = [&](const std::string& key, double otherwise) {
      const xml_node child = child_of(instance, key);
      if (child.empty()) return otherwise;
      return xml_.number(text_of(child), child, [&] { return fmt::format("{} of an instance", key); });
    };
    const auto three = [&](const std::string& key, double otherwise) {
      return Vector<3>(value(key + "x", otherwise), value(key + "y", otherwise), value(key + "z", otherwise));
    };
    const Vector<3> moved = three("delta", 0), turned = three("r", 0), mirrored = three("mirror", 1),
                    scaled = value("scale", 1) * three("scale", 1);
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
    for (int axis = 0; axis < 3; ++axis) placement.prerotate(rotation(axis, turned[axis]));
    placement.scale(Vector<3>(scaled.cwiseProduct(mirrored)));
    return placement.pretranslate(moved);
  }

  /// Exact for quarter turns, so that coordinates keep their written values.
  Eigen::Matrix3d rotation(int axis, double angle) const {
    const double quarters = angle / (in_radians_ ? std::numbers::pi / 2 : 90);
    const double whole = std::round(quarters), rest = (quarters - whole) * std::numbers::pi / 2;
    const auto quarter = static_cast<int>(std::fmod(whole, 4) + 4) % 4;
    const double c = std::cos(rest), s = std::sin(rest);
    const double cosine[] = {c, -s, -c, s}, sine[] = {s, c, -s, -c};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn(u, u) = turn(v, v) = cosine[quarter];
    turn(v, u) = sine[quarter];
    turn(u, v) = -sine[quarter];
    return turn;
  }

  void note_left_out(FileFacts& facts) const {
    if (supports_ > 0)
      facts.notes.push_back(fmt::format("{} left out, marked in the file as supports or modifiers",
                                        counted(supports_, "volume is", "volumes are")));
    if (unprinted_ > 0)
      facts.notes.push_back(fmt::format("{} left out, marked in the file as not to be printed",
                                        counted(unprinted_, "instance is", "instances are")));
    if (curved_) facts.notes.push_back("its curved triangles are taken as flat ones");
  }

  XmlDocument xml_;
  Nodes objects_, constellations_;
  PlacedMeshes meshes_;
  std::set<std::string> instanced_;
  bool in_radians_ = false, curved_ = false;
  std::size_t supports_ = 0, unprinted_ = 0;
};

/// The text of an AMF, zipped or not, under the name of its entry.
Amf opened(const std::filesystem::path& file) {
  if (!is_zip(file)) return Amf({}, text_without_mark(file));
  ZipArchive archive(file);
  for (const char* ending : {".amf", ".xml", ""})
    for (const std::string& name : archive.names())
      if (in_lower_case(name).ends_with(ending)) return Amf(name, archive.read(name));
  throw Error(ErrorCode::bad_mesh, "an archive without an entry");
}

}  // namespace

ReadAttempt read_amf(const std::filesystem::path& file) {
  ReadAttempt result = read_in_cage("pugixml", cage_limits(std::filesystem::file_size(file)),
                                    [&] { return opened(file).read(); });
  result.reader = "pugixml, double precision";
  return result;
}

}  // namespace bernal::cad
