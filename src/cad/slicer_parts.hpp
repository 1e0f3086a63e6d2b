#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cad/placed_meshes.hpp"
#include "cad/zip_archive.hpp"

namespace bernal::cad {

/// What slicers write beside the model of a 3MF: names, and what of an object is no part but changes how it
/// is printed. PrusaSlicer and SuperSlicer give it by ranges of triangles (Metadata/Slic3r_PE_model.config),
/// Bambu Studio and OrcaSlicer by components (Metadata/model_settings.config).
class SlicerParts {
 public:
  /// Empty where there is neither, or what there is cannot be read.
  static SlicerParts of(ZipArchive&);

  std::string name_of(const std::string& object) const;
  bool is_part(const std::string& object, const std::string& component) const;
  /// Makes of the object's one piece those that are parts; returns how many are not.
  std::size_t split(const std::string& id, PlacedMeshes::Object&) const;

 private:
  struct Volume {
    std::size_t first, last;  ///< of its triangles
    std::string name;
    bool is_part;
  };

  std::map<std::string, std::string> names_;
  std::map<std::string, std::vector<Volume>> volumes_;
  std::set<std::pair<std::string, std::string>> no_parts_;
};

}  // namespace bernal::cad
