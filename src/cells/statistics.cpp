#include <nlohmann/json.hpp>

#include "bernal/cells/write_cells.hpp"

namespace bernal {

std::string cell_statistics_as_json(const Packing& packing, const Cells& cells, const CellStatistics& found) {
  using Json = nlohmann::ordered_json;
  const auto moments = [](const CellStatistics::Moments& of) {
    return Json{{"mean", of.mean},         {"deviation", of.deviation}, {"skewness", of.skewness},
                {"kurtosis", of.kurtosis}, {"least", of.least},         {"most", of.most}};
  };
  const Json json{{"unit", name_of(packing.scene.unit)},
                  {"dimension", cells.dimension},
                  {"spheres", cells.size()},
                  {"cells", found.cells},
                  {"empty", found.empty},
                  {"corners", found.corners},
                  {"edges", found.edges},
                  {"faces", found.faces},
                  {"euler", found.euler},
                  {"not_euler", found.not_euler},
                  {"volume", found.volume},
                  {"volume_error", found.volume_error},
                  {"deviation_of_walls", cells.deviation},
                  {"merged", cells.merged},
                  {"volumes", moments(found.volumes)},
                  {"diameters", moments(found.diameters)},
                  {"faces_a_cell", moments(found.faces_a_cell)},
                  {"edges_a_face", moments(found.edges_a_face)},
                  {"sphericity", moments(found.sphericity)},
                  {"aspect", moments(found.aspect)},
                  {"with_faces", found.with_faces}};
  return json.dump(2) + "\n";
}

}  // namespace bernal
