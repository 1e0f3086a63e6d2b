#pragma once
#include <string>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/domain/mesh_file.hpp"

namespace bernal::cad {

/// Whether planes close the container.
inline bool has_planes(const MeshFile& options) { return !options.cap.empty() || options.fill_level; }

/// Does the repairs that the options ask for, in the order of the table in repairs.cpp, each in a child
/// process. `mesh` is repaired in place; `done` receives a phrase for each repair.
///
/// Where planes close the container, an opening is no hole: repairs that close openings wait for the planes.
class Repairs {
 public:
  Repairs(const MeshFile& options, const ImportFor& purpose, Mesh& mesh, std::vector<std::string>& done)
      : options_(options), purpose_(purpose), mesh_(mesh), done_(done) {}

  void before_planes();
  void after_planes();

  bool any = false;  ///< whether the surface is no longer the file's
  std::vector<std::string> cautions = {};

 private:
  void apply(const struct RepairEntry&);

  const MeshFile& options_;
  const ImportFor& purpose_;
  Mesh& mesh_;
  std::vector<std::string>& done_;
};

}  // namespace bernal::cad
