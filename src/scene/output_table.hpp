#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/entry.hpp"

namespace bernal {

/// What an output takes for the density of its spheres where it is told none: the scene's, else that of
/// glass.
inline double usual_density(const Scene& scene) {
  constexpr double glass = 2500;
  return scene.material_density.value_or(glass);
}

/// The files of a result, all that it ever has.
inline constexpr std::array<std::string_view, 13> names_of_result = {
    "scene.toml",  "spheres.csv", "spheres.npy", "classes.npy",   "weights.npy", "spheres.vtp", "report.json",
    "report.html", "packing.svg", "section.svg", "container.off", "layers.csv",  "nest.json"};

/// A format of other programs as a scene knows it: what it can be told, and what its file is.
struct OutputTable {
  schema::Entry keys;  ///< of an Output
  std::string_view file;
  /// Of files that may come with it, and take its name: "_radii.npy", ".py".
  std::vector<std::string_view> endings = {};
  std::string_view alone = {};  ///< the ending of names with which none of them comes
  int least_dimension = 3, most_dimensions = 3;
  std::optional<Unit> unit = {};      ///< that the program expects; none: whatever the scene has
  std::string_view sizes = "radius";  ///< or "diameter": what the file holds
  bool is_folder = false;             ///< what its name is given to, see `is_folder`
  bool tilted = false;                ///< it can state a tilted periodic box
  bool repeated_mesh = false;         ///< it holds spheres and periods, and no walls

  std::string_view name() const { return keys.name; }
  /// Whether spheres may be joined or cut in it; else they can only shrink.
  bool has_bridges() const { return keys.find("bridge_radius") != nullptr; }
};

/// All of them, in the order in which people are told of them; formats/ holds the list.
std::span<const OutputTable* const> output_tables();

/// Of a key that acts with other treatments of contacts than the output's: which; else empty.
std::string_view contacts_that_use(const schema::Key&, const Output&);

/// Throws Error{bad_scene} where there is no such format.
const OutputTable& table_of(const Output& output);

/// Of a format that has "file" and these keys besides.
schema::Entry output_entry(std::string_view name, std::string_view help,
                           const std::vector<std::string_view>& keys);

/// Every key that any format has, in the order in which people are told of them.
const std::vector<schema::Key>& output_keys();

/// Checks one output of a scene and fills in what it leaves open. Throws Error{bad_scene} for what its format
/// cannot hold.
void complete_output(Output& output, const Scene& scene);
/// Throws Error{bad_scene} unless every output has a name of its own, and none of the result's.
void require_names(const Scene& scene);

/// The name of the file that comes with another: "mine.py" with "mine.npy".
std::string file_beside(const std::filesystem::path& file, std::string_view ending);
/// Whether the name is that of a folder. Where the usual name has an ending, one with an ending is a file.
bool is_folder(const OutputTable&, const std::filesystem::path& name);
/// All names that an output may write to, its own first.
std::vector<std::string> files_of(const Output& output);

/// An output of a scene as its errors name it.
inline schema::Section section_of(const Output& output) {
  return {"[[output]] " + output.format, output.locations};
}

}  // namespace bernal
