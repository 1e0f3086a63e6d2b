#include <nlohmann/json.hpp>

#include "bernal/mesh_files/mesh_packing.hpp"

namespace bernal {

std::string mesh_report_as_json(const Packing& packing, const BedMeshReport& report) {
  using Json = nlohmann::ordered_json;
  const auto place = [](const Vector<3>& p) { return Json{p[0], p[1], p[2]}; };
  Json json{{"unit", name_of(packing.scene.unit)},
            {"spheres", report.spheres},
            {"necks", report.necks},
            {"shrunk_necks", report.shrunk_necks},
            {"largest_neck_shrink", report.largest_neck_shrink},
            {"cut_fillets", report.cut_fillets},
            {"gaps_at_edges", report.gaps_at_edges},
            {"wall_deviation", report.wall_deviation},
            {"shrunk_spheres", report.shrunk_spheres},
            {"largest_sphere_shrink", report.largest_sphere_shrink},
            {"widened_necks", report.widened_necks},
            {"deepened_caps", report.deepened_caps},
            {"clipped", report.clipped},
            {"cleared", report.cleared},
            {"triangles", report.triangles},
            {"least_edge", report.least_edge},
            {"least_triangle_angle", report.least_triangle_angle},
            {"place_of_least_angle", place(report.place_of_least_angle)},
            {"is_surface", report.is_surface},
            {"tetrahedra", report.tetrahedra},
            {"prisms", report.prisms},
            {"prism_ends", report.prism_ends},
            {"prism_share", report.prism_share},
            {"mean_prism_height", report.mean_prism_height},
            {"least_prism_height", report.least_prism_height},
            {"least_scaled_jacobian", report.least_scaled_jacobian},
            {"nodes", report.nodes},
            {"least_sicn", report.least_sicn},
            {"mean_sicn", report.mean_sicn},
            {"promised_sicn", BedMeshReport::promised_sicn},
            {"least_dihedral_angle", report.least_angle},
            {"largest_dihedral_angle", report.largest_angle},
            {"histogram", report.histogram},
            {"domain_volume", report.domain_volume},
            {"porosity", report.porosity},
            {"meshed_porosity", report.meshed_porosity},
            {"contact_area", report.contact_area}};
  json["packed_porosity"] = report.packed_porosity ? Json(*report.packed_porosity) : Json();
  json["least_curved_sicn"] = report.least_curved_sicn ? Json(*report.least_curved_sicn) : Json();
  json["curved_edges"] = report.curved_edges;
  json["straight_edges"] = report.straight_edges;
  for (const char* list : {"worst", "groups", "parts"}) json[list] = Json::array();
  for (const BedMeshReport::Place& at : report.worst)
    json["worst"].push_back({{"sicn", at.sicn}, {"center", place(at.center)}});
  for (const BedMeshReport::Group& group : report.groups)
    json["groups"].push_back({{"name", group.name},
                              {"volume", group.volume},
                              {"stated_volume", group.stated_volume ? Json(*group.stated_volume) : Json()},
                              {"tetrahedra", group.tetrahedra}});
  for (const BedMeshReport::Part& part : report.parts)
    json["parts"].push_back(
        {{"name", part.name}, {"seconds", part.seconds}, {"peak_bytes", part.peak_bytes}});
  return json.dump(2) + "\n";
}

}  // namespace bernal
