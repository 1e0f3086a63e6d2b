#include <fmt/format.h>

#include "hard/table/hard_case.hpp"
#include "support/folder.hpp"

// Files that others made: examples and test data of CAD programs, meshers and solvers (tests/hard/models).
namespace bernal::hard {

std::vector<Case> model_cases() {
  std::vector<Case> cases;
  const auto add = [&](const char* name, const std::string& path, const char* why, const char* spheres,
                       Expected expected, const std::string& line = "", const std::string& rest = "") {
    cases.push_back({"CAD files of others", name, why,
                     scene(fmt::format("kind = \"mesh\"\nfile = \"{}/{}\"\n{}", BERNAL_SOURCE, path, line),
                           spheres, rest),
                     std::move(expected)});
  };
  const std::string models = "tests/hard/models/", meshes = "data/meshes/";
  const std::string settled = stages({"insert", "compress", "shake", "refill"});

  add("Block", models + "admesh_block_UPPERCASE.stl", "text STL in capitals that other readers refuse",
      "diameter = 0.4", at_least(500));
  add("SphereWithHole", models + "assimp_sphereWithHole.stl", "a tab after \"solid\", and a hole",
      "diameter = 0.02", refused("repair = [\"holes\"]"));
  add("SphereWithHoleClosed", models + "assimp_sphereWithHole.stl", "with the line that was offered",
      "count = 100\ndiameter = 0.02", at_least(1), "{offered}");
  add("Spider", models + "assimp_spider.obj", "18 crossing, open pieces of a figure", "diameter = 4.0",
      refused("bernal inspect tries a wrap"));
  add("SpiderWrapped", models + "assimp_spider.obj", "with the line that was offered",
      "count = 300\ndiameter = 4.0", at_least(100), "{offered}");
  add("Bones", models + "cgal_bones.off", "closed pieces with 366 crossings", "diameter = 0.2",
      refused("repair = [\"self-intersections\"]"));
  add("BonesMended", models + "cgal_bones.off", "with the line that was offered", "diameter = 0.2",
      at_least(300), "{offered}");
  add("Coupling", models + "cgal_couplingdown.off", "genus 9", "diameter = 0.05", at_least(500));
  add("CouplingSettled", models + "cgal_couplingdown.off", "genus 9, from above", "diameter = 0.08",
      at_least(50), "", settled);
  add("Elephant", models + "cgal_elephant.off", "free form, with tusks and a tail", "diameter = 0.03",
      at_least(500));
  add("Flange", models + "flange.stl", "in metres, drawn in millimetres", "diameter = 3.0", at_least(200),
      "unit = \"m\"");
  add("FlangeByItsNumbers", models + "flange.stl", "metres taken for millimetres: far too small",
      "diameter = 1.5", refused(""));
  add("T13", models + "gmsh_t13.stl", "genus 2", "diameter = 3.0", at_least(1000));
  add("Bucket", models + "liggghts_bucket.stl", "walls with a thickness: the wall is packed",
      "count = 3000\ndiameter = 4.0", exactly(3000));
  add("BucketInside", models + "liggghts_bucket.stl", "the hollow is meant", "diameter = 15.0", at_least(300),
      "interior = \"cavity\"");
  add("HopperOfPlate", models + "liggghts_hopper_open_flipped.stl",
      "eight flipped edges; the plate itself is packed", "count = 200\ndiameter = 2.0", exactly(200));
  add("HopperInside", models + "liggghts_hopper_open_flipped.stl", "the hollow is meant, faces are flipped",
      "diameter = 30.0", at_least(300), "interior = \"cavity\"");
  add("LinkRods", models + "linkrods.step", "free-form and analytic faces", "diameter = 0.2", at_least(200));
  add("HeaderSolid", models + "made_binary_header_solid.stl", "binary, its header begins with \"solid\"",
      "diameter = 0.1", at_least(50));
  add("MixerVessel", models + "mixer_vessel_open.stl", "open at the top, in metres", "diameter = 40.0",
      refused("cap = "), "unit = \"m\"");
  add("MixerVesselFilled", models + "mixer_vessel_open.stl", "filled to a level", "diameter = 70.0",
      at_least(300), "unit = \"m\"\nfill_level = 800.0");
  add("MixerVesselCapped", models + "mixer_vessel_open.stl", "with the line that was offered",
      "diameter = 70.0", at_least(300), "unit = \"m\"\n{offered}");
  add("Hinge", models + "netgen_hinge.stl", "genus 5, thin walls", "diameter = 2.5", at_least(100));
  add("Unparseable", models + "openscad_unparseable.stl", "no numbers in line 4", "diameter = 1.0",
      refused(":4:"));
  add("ZeroArea", models + "openscad_zero_area.stl", "a face without area", "diameter = 2.0", at_least(100));
  add("Screw", models + "screw.step", "a thread", "diameter = 2.0", at_least(200));
  add("Bearing", models + "bearing.iges", "surfaces whose edges do not meet; metres called millimetres",
      "diameter = 2.0", refused("cap = "), "unit = \"m\"\nignore_unit_of_file = true");
  // Closed forms of the three solids, in mm³; the tessellation follows the sphere.
  add("ThreeSolids", models + "three_solids_inch.step", "three solids at once", "diameter = 14.0",
      explained(150));
  for (const auto& [solid, volume] : {std::pair{1, 682129.61}, {2, 105355.77}, {3, 161733.84}})
    add(fmt::format("ThreeSolidsNumber{}", solid).c_str(), models + "three_solids_inch.step",
        "one of three, by its number; its volume in closed form", "diameter = 6.0",
        of_volume(at_least(200), volume, 5e-3), fmt::format("solids = \"{}\"", solid));
  add("ThreeSolidsNumber4", models + "three_solids_inch.step", "there is no fourth", "diameter = 4.0",
      refused("solid"), "solids = \"4\"");
  add("Helix", meshes + "lib3mf_helix.stl", "a spring: thin and winding", "diameter = 6.0", at_least(200));
  add("HelixSettled", meshes + "lib3mf_helix.stl", "a spring from above: overhangs all along",
      "diameter = 7.0", at_least(100), "", settled);
  add("Tardis", meshes + "openscad_bad_tardis.stl", "crosses itself six times", "diameter = 2.0",
      refused("repair = [\"self-intersections\"]"));
  add("TardisMended", meshes + "openscad_bad_tardis.stl", "with the line that was offered",
      "count = 300\ndiameter = 1.5", exactly(300), "{offered}");
  add("BlockWithFillets", meshes + "block_fillets_bore.step", "all edges rounded, a bore", "diameter = 4.0",
      at_least(400));
  add("AssemblyInInches", meshes + "assembly_inch.step", "three placed parts", "diameter = 6.0",
      at_least(500));
  add("DrumOfThreeFaces", meshes + "drum_inch.igs", "faces that nobody joined", "diameter = 3.0",
      at_least(200));
  add("OpenBoxOfFaces", meshes + "open_box_inch.igs", "a face is missing", "diameter = 3.0",
      refused("cap = "));
  add("OpenBoxOfFacesCapped", meshes + "open_box_inch.igs", "with the line that was offered",
      "diameter = 3.0", at_least(200), "{offered}");
  add("FrustumOfBrep", meshes + "frustum.brep", "names no unit", "diameter = 3.0", at_least(100));
  return cases;
}

}  // namespace bernal::hard
