#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/unit.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Which side of a closed surface is meant.
enum class Interior {
  solid,  ///< what the surface encloses
  cavity  ///< the hollow of what it encloses: the inside of a bucket whose walls have a thickness
};

/// What may be done to a surface that cannot be a container as it is; in this order.
enum class Repair {
  holes,               ///< are closed by patches
  self_intersections,  ///< are cut out and closed
  wrap                 ///< the surface is replaced by one that wraps it
};

/// Their words in a scene.
inline constexpr std::string_view repair_names[] = {"holes", "self-intersections", "wrap"};
constexpr std::string_view name_of(Repair repair) { return repair_names[static_cast<int>(repair)]; }

/// Which axis of the file's points up.
enum class Up { as_in_file, x, y, z };

/// A container in a CAD file, and how the file becomes one. Lengths and coordinates are the scene's.
struct MeshFile {
  std::filesystem::path file = {};
  std::optional<Unit> unit = {};     ///< of the file's coordinates; else as the file says; else the scene's
  bool ignore_unit_of_file = false;  ///< `unit` holds though the file says otherwise
  Up up = Up::as_in_file;            ///< this axis becomes z
  std::vector<std::string> solids = {};               ///< by name, or by number from 1; all of them if empty
  std::vector<std::filesystem::path> obstacles = {};  ///< closed surfaces that are taken out
  std::optional<double> weld = {};                    ///< corners of open edges up to this far apart are one
  std::optional<double> deflection = {};              ///< of a tessellated surface from the true one
  bool true_surface = false;  ///< spheres lie inside the surface of the CAD file itself, not of its triangles
  std::vector<Repair> repair = {};
  std::optional<double> largest_hole = {};  ///< that is closed; else half of the part's diagonal
  std::vector<std::string> cap = {};        ///< planes, "z = 1.1" or "x < 0.5": what they cut off is outside
  std::optional<double> fill_level = {};    ///< as `cap = "z < …"`
  std::variant<Interior, Vector<3>> interior = Interior::solid;  ///< or a point that is inside
  /// The axes along which it repeats itself: its ends there are openings, see `read_container_mesh`.
  std::array<bool, 3> periodic = {};
  /// Of the file and then of every obstacle, in hexadecimal, as they were when the scene was run: files whose
  /// bytes are others are refused.
  std::vector<std::string> sha256 = {};
  /// Surfaces that stand in no file, by what `file` and `obstacles` call them, such as "part.off": they are
  /// taken as an OFF file that holds them, and a result has that file beside it.
  std::map<std::filesystem::path, std::shared_ptr<const PolygonSurface>> surfaces = {};

  bool repeats() const { return periodic[0] || periodic[1] || periodic[2]; }

  /// The container's, then those of the obstacles.
  std::vector<std::filesystem::path*> files() {
    std::vector<std::filesystem::path*> all{&file};
    for (std::filesystem::path& obstacle : obstacles) all.push_back(&obstacle);
    return all;
  }
  /// Null where the name is that of a file.
  const PolygonSurface* surface_called(const std::filesystem::path& name) const {
    const auto found = surfaces.find(name);
    return found == surfaces.end() ? nullptr : found->second.get();
  }
};

}  // namespace bernal
