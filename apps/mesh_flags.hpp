#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"
#include "command_line.hpp"

/// What is packed into a mesh, where the command line says it and no scene does.
struct MeshFlags {
  std::string unit, file_unit;
  std::string diameter, radius;        ///< as all lengths in `unit`, or with one of their own: "3 mm"
  std::vector<std::string> lognormal;  ///< median and sigma of the diameter
  std::int64_t count = 0;              ///< 0: as many as are expected to fit
  bool fill = false, largest = false;
  std::vector<std::string> cap;

  bool has_sizes() const { return !diameter.empty() || !radius.empty() || !lognormal.empty() || largest; }
  /// Those that are given, for messages: "--diameter and --count".
  std::string given() const;
};

/// Its options; it has to outlive them.
std::vector<Option> options_of(MeshFlags& flags);
/// The positional argument of a command that takes a scene or a mesh.
Option scene_or_mesh(std::filesystem::path& file);

/// The scene of a TOML file, or the one that stands for the mesh and its flags. Throws Error{bad_argument}
/// where a mesh comes without sizes or without a unit, or a scene with flags. Cost: without --unit and
/// --file-unit the mesh is read for its unit.
bernal::Scene scene_of(const std::filesystem::path& file, const MeshFlags& flags);
