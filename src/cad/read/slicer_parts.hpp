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

/// What slicers write beside the model of a 3MF: names, and what of an object is no part but changes how it
/// is printed. PrusaSlicer and SuperSlicer give it by ranges of triangles (Metadata/Slic3r_PE_model.config),
/// Bambu Studio and OrcaSlicer by components (Metadata/model_settings.config).
class SlicerParts {
 public:
  /// Empty where there is neither; what there is and cannot be read is noted.
  static SlicerParts of(ZipArchive&, std::vector<std::string>& notes);

  std::string name_of(const std::string& object) const;
  /// What to say of an object that holds a part which is cut out of the others; empty for all others.
  std::string complaint_about(const std::string& object) const;
  bool is_part(const std::string& object, const std::string& component) const;
  /// Makes of the object's one piece those that are parts; returns how many are not. Nothing, where what the
  /// slicer says is of another mesh.
  std::optional<std::size_t> split(const std::string& id, PlacedMeshes::Object&) const;

 private:
  struct Volume {
    std::size_t first, last;  ///< of its triangles
    std::string name;
    bool is_part;
  };

  std::map<std::string, std::string> names_;
  std::map<std::string, std::vector<Volume>> volumes_;
  std::set<std::pair<std::string, std::string>> no_parts_;
  std::map<std::string, std::string> negative_;  ///< of an object the name of one
};

/// Whether it cuts out of the others, as slicers call that.
bool is_negative(std::string_view type);
/// "its part "Hole" is negative, …"
std::string complaint_about_negative(const std::string& name);

}  // namespace bernal::cad
