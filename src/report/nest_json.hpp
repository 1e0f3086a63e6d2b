#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// The files of what lies inside the spheres of one class, by their names in the folder of the result.
struct InsideFiles {
  std::string folder = {};                 ///< that holds all of them
  std::string scene = {};                  ///< of the first of the packings; empty where there is none
  std::string table = {};                  ///< which packing each sphere holds, and how it is turned
  std::vector<std::string> packings = {};  ///< a folder each, with a result
  std::vector<Outcome> outcomes = {};      ///< of the runs that made these, where nest.json says it
};

/// nest.json: a tree of what lies inside the spheres of a packing, a level below each other: class, layer,
/// the ball in both units, counts and files; and the sums over all levels. One entry of `files` for each of
/// `Packing::inside`.
std::string nest_as_json(const Packing&, const std::vector<InsideFiles>& files);

/// The files that such a text names. Throws Error{bad_packing} with the name of the file for what is none.
std::vector<InsideFiles> files_in_nest(const std::string& json, const std::filesystem::path& file);

/// Where nest.json says otherwise than the files that it names, of which `packing` was read, as
/// "inside[0].packings[1].hash"; nothing where it does not. Numbers with a point may differ by rounding.
std::string nest_differs(const std::string& json, const Packing&, const std::vector<InsideFiles>& files);

}  // namespace bernal
