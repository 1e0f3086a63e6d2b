#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cad/read/placed_meshes.hpp"
#include "cad/read/zip_archive.hpp"

namespace bernal::cad {

/// What slicers add to a 3MF model: names, and modifiers, which are not parts but change how an object is
/// printed. PrusaSlicer and SuperSlicer mark them by ranges of triangles (Metadata/Slic3r_PE_model.config),
/// Bambu Studio and OrcaSlicer by components (Metadata/model_settings.config).
class SlicerParts {
 public:
  /// Empty if the archive has neither; unreadable ones are noted.
  static SlicerParts of(ZipArchive&, std::vector<std::string>& notes);

  std::string name_of(const std::string& object) const;
  /// The error for an object with a negative part; empty if it has none.
  std::string error_about(const std::string& object) const;
  bool is_part(const std::string& object, const std::string& component) const;
  /// Splits the object's single piece into its parts; returns the number of modifiers dropped. Absent if the
  /// slicer's data belong to another mesh.
  std::optional<std::size_t> split(const std::string& id, PlacedMeshes::Object&) const;

 private:
  struct Volume {
    std::size_t first, last;  ///< range of its triangles
    std::string name;
    bool is_part;
  };

  std::map<std::string, std::string> names_;
  std::map<std::string, std::vector<Volume>> volumes_;
  std::set<std::pair<std::string, std::string>> no_parts_;
  std::map<std::string, std::string> negative_;  ///< by object, the name of a negative part
};

/// Whether the slicer subtracts a part of this type from the others.
bool is_negative(std::string_view type);
/// "its part "Hole" is negative, …"
std::string error_about_negative(const std::string& name);

}  // namespace bernal::cad
