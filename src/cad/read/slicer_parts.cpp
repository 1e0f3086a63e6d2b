#include "cad/read/slicer_parts.hpp"

#include <fmt/format.h>

#include <string_view>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/read/xml_document.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {
namespace {

/// The value of the `metadata` with that key.
std::string value_of(pugi::xml_node node, std::string_view key) {
  for (const pugi::xml_node metadata : node.children("metadata"))
    if (metadata.attribute("key").value() == key) return metadata.attribute("value").value();
  return {};
}

}  // namespace

bool is_negative(std::string_view type) { return in_lower_case(type).starts_with("negative"); }

std::string error_about_negative(const std::string& name) {
  return fmt::format(
      "its part \"{}\" is negative: a slicer cuts it out of the others, which is not done here; cut it out "
      "there (mesh boolean), and export the result",
      plain_text(name, 60));
}

SlicerParts SlicerParts::of(ZipArchive& archive, std::vector<std::string>& notes) {
  SlicerParts parts;
  for (const char* name : {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
    const std::string* entry = archive.find(name);
    if (entry == nullptr) continue;
    try {
      const XmlDocument config(*entry, archive.read(*entry));
      for (const pugi::xml_node object : config.root().children("object")) {
        const std::string id = object.attribute("id").value();
        parts.names_[id] = value_of(object, "name");
        for (const pugi::xml_node volume : object.children("volume")) {
          const std::string type = value_of(volume, "volume_type");
          const bool is_part = type.empty() ? value_of(volume, "modifier") != "1" : type == "ModelPart";
          parts.volumes_[id].push_back({volume.attribute("firstid").as_ullong(),
                                        volume.attribute("lastid").as_ullong(), value_of(volume, "name"),
                                        is_part});
          if (is_negative(type)) parts.negative_.try_emplace(id, value_of(volume, "name"));
        }
        for (const pugi::xml_node part : object.children("part")) {
          const std::string_view type = part.attribute("subtype").value();
          if (is_negative(type)) parts.negative_.try_emplace(id, value_of(part, "name"));
          if (!type.empty() && type != "normal_part")
            parts.no_parts_.emplace(id, part.attribute("id").value());
        }
      }
    } catch (const Error& error) {
      notes.push_back(fmt::format("{} cannot be read, so that what changes the print counts as parts: {}",
                                  name, error.what()));
    }
  }
  return parts;
}

std::string SlicerParts::name_of(const std::string& object) const {
  const auto found = names_.find(object);
  return found == names_.end() ? "" : found->second;
}

std::string SlicerParts::error_about(const std::string& object) const {
  const auto found = negative_.find(object);
  return found == negative_.end() ? "" : error_about_negative(found->second);
}

bool SlicerParts::is_part(const std::string& object, const std::string& component) const {
  return !no_parts_.contains({object, component});
}

std::optional<std::size_t> SlicerParts::split(const std::string& id, PlacedMeshes::Object& object) const {
  const auto found = volumes_.find(id);
  if (found == volumes_.end()) return 0;
  const auto triangles = object.pieces.front().triangles;
  std::vector<PlacedMeshes::Piece> pieces;
  std::size_t end = 0, others = 0;
  for (const Volume& volume : found->second) {  // contiguous to the end, or it belongs to another mesh
    if (volume.first != end || volume.last < end || volume.last >= triangles.size()) return {};
    end = volume.last + 1;
    const auto at = triangles.begin();
    others += volume.is_part ? 0 : 1;
    if (volume.is_part)
      pieces.push_back({volume.name, {at + std::ptrdiff_t(volume.first), at + std::ptrdiff_t(end)}});
  }
  if (end != triangles.size()) return {};
  object.pieces = std::move(pieces);
  return others;
}

}  // namespace bernal::cad
