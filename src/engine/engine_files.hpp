#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "bernal/scene/scene.hpp"
#include "engine/engine_task.hpp"

namespace bernal::engine {

// What an engine reads: a script, a data file of the spheres, and of CAD walls an STL. All numbers are the
// shortest decimals that read back as the same double, but for those of places, which are %.17g.

inline constexpr const char* data_name = "spheres.data";
inline constexpr const char* walls_name = "walls.stl";
inline constexpr const char* places_name = "places.dump";
inline constexpr const char* output_name = "output.txt";  // what the engine and its launcher print

/// What is particular to one engine.
struct Dialect {
  std::string_view title;                ///< "LAMMPS"
  std::string_view package, executable;  ///< as Debian calls them: "lammps", "lmp"
  std::string_view script, log;          ///< names of files
  std::string_view atoms;                ///< the heading above them in a data file
  int wall_types;                        ///< of atoms, beside those of spheres, that the data file announces
  std::string (*script_of)(const EngineTask&);
};
const Dialect& dialect_of(const SceneEngine& engine);

std::string lammps_script(const EngineTask& task);
std::string liggghts_script(const EngineTask& task);

/// One atom a sphere: id, type, diameter, density, place. Overwrites. Throws Error{cannot_write}.
void write_data(const std::filesystem::path& file, const EngineTask& task, const Dialect& dialect);
/// The triangles of a mesh, as text.
void write_walls_stl(const std::filesystem::path& file, const Mesh& mesh);
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace bernal::engine
