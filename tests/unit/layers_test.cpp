// Layers of spheres: how they are read and placed, what there is of them, and what images and solids hold.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include <oneapi/tbb/global_control.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "core/made.hpp"
#include "support/scene_texts.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace layers_test {

using testing::Folder;
using testing::text_of;

double ball(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }

/// Spheres of a lognormal distribution, far from each other on a lattice in a periodic box: where they are is
/// of no matter to their layers.
Packing lattice(const std::string& layers, std::size_t edge = 10, const std::string& sizes = "radius = 0.5") {
  Packing packing;
  packing.scene = parse_scene(
      "unit = \"mm\"\nseed = 3\n[container]\nkind = \"periodic\"\nedge = " + std::to_string(3 * edge) +
          "\n[spheres]\ncount = 5\n" + sizes + "\n" + layers + "\n",
      "test.toml");
  packing.seed = packing.scene.seed;
  const double side = 3.0 * static_cast<double>(edge);
  Box box{Vector<3>::Zero(), Vector<3>::Constant(side), {true, true, true}};
  packing.domain = box;
  packing.volume = side * side * side;
  packing.spheres = Spheres<dynamic>(3);
  Random random(1, stream(Stream::test));
  for (std::size_t i = 0; i < edge * edge * edge; ++i) {
    packing.spheres.x[0].push_back(3.0 * static_cast<double>(i % edge) + random.uniform());
    packing.spheres.x[1].push_back(3.0 * static_cast<double>(i / edge % edge) + random.uniform());
    packing.spheres.x[2].push_back(3.0 * static_cast<double>(i / edge / edge) + random.uniform());
    const double u = random.uniform() + random.uniform() + random.uniform() - 1.5;
    packing.spheres.r.push_back(0.5 * std::exp(0.3 * u));
  }
  packing.classes.assign(packing.spheres.size(), 0);
  return packing;
}

constexpr const char* three =
    R"(layers = [{ name = "core" }, { name = "buffer", share = 0.2, material = "C" },
  { name = "coat", thickness = { distribution = "normal", mean = 0.04, sd = 0.01, min = 0.01, max = 0.06 }, material = "C" }])";

TEST(Layers, AreWhatTheSceneSaysAndEndAtTheSphere) {
  const Packing packing = lattice(three);
  const SphereLayers layers = layers_of(packing);
  ASSERT_EQ(layers.first.size(), packing.spheres.size() + 1);
  double mean = 0, squared = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const double r = packing.spheres.r[i];
    const auto outer = layers.of(i);
    ASSERT_EQ(outer.size(), 3u);
    EXPECT_EQ(outer[2], r);
    EXPECT_NEAR((ball(outer[1]) - ball(outer[0])) / ball(r), 0.2, 1e-14);
    const double thickness = r - outer[1];
    EXPECT_GE(thickness, 0.01 - 1e-15);
    EXPECT_LE(thickness, 0.06 + 1e-15);
    mean += thickness / 1000;
    squared += thickness * thickness / 1000;
  }
  // Cut at -3 and +2 deviations: of the law's mean and deviation, by its density and its share.
  const double low = std::exp(-4.5), high = std::exp(-2.0), root = std::sqrt(2 * std::numbers::pi);
  const double share = 0.5 * (std::erf(2 / std::sqrt(2.0)) + std::erf(3 / std::sqrt(2.0)));
  const double shift = (low - high) / root / share;
  EXPECT_NEAR(mean, 0.04 + 0.01 * shift, 4 * 0.01 / std::sqrt(1000.0));
  const double variance = 1 + (-3 * low - 2 * high) / root / share - shift * shift;
  EXPECT_NEAR(std::sqrt(squared - mean * mean), 0.01 * std::sqrt(variance), 0.001);
}

TEST(Layers, AreTheSameInAnyNumberOfThreadsAndForEverySphereByItself) {
  Packing packing = lattice(three);
  const SphereLayers many = layers_of(packing);
  {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(layers_of(packing).outer, many.outer);
  }
  // The first spheres have the same layers where others do not follow.
  packing.spheres.r.resize(7);
  for (auto& column : packing.spheres.x) column.resize(7);
  packing.classes.resize(7);
  const SphereLayers few = layers_of(packing);
  EXPECT_TRUE(std::equal(few.outer.begin(), few.outer.end(), many.outer.begin()));
  packing.seed = 4;
  EXPECT_NE(layers_of(packing).outer, few.outer);
}

TEST(Layers, MakeUpTheVolumeOfTheirSpheres) {
  const Packing packing = lattice(three);
  const LayerAmounts amounts = layer_amounts(packing);
  ASSERT_EQ(amounts.layers.size(), 3u);
  ASSERT_EQ(amounts.materials.size(), 2u);
  double all = 0, layers = 0, materials = 0;
  for (const double r : packing.spheres.r) all += ball(r);
  for (const LayerAmount& of : amounts.layers) layers += of.volume;
  for (const MaterialAmount& of : amounts.materials) materials += of.volume;
  EXPECT_NEAR(layers / all, 1, 1e-13);
  EXPECT_NEAR(materials / all, 1, 1e-13);
  EXPECT_NEAR(amounts.layers[1].volume / all, 0.2, 1e-13);
  EXPECT_EQ(amounts.materials[1].name, "C");
  EXPECT_FALSE(amounts.layers[0].mass);
}

TEST(Layers, OfClassesAreThoseOfTheirSpheres) {
  Packing packing = lattice("", 3,
                            "diameter = { distribution = \"classes\", values = [1.0, 2.0], shares = [1, 1], "
                            "layers = [[], [{ name = \"fuel\", radius = 0.8, material_density = 1000 }, "
                            "{ name = \"shell\", material_density = 2000 }]] }\nmaterial_density = 5");
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) packing.spheres.r[i] = i % 3 == 0 ? 1.0 : 0.5;
  packing.classes = classes_by_size(packing);
  ASSERT_EQ(packing.classes.size(), 27u);
  const SphereLayers layers = layers_of(packing);
  EXPECT_EQ(layers.of(0).size(), 2u);
  EXPECT_EQ(layers.of(0)[0], 0.8);
  EXPECT_TRUE(layers.of(1).empty());
  const LayerAmounts amounts = layer_amounts(packing);
  EXPECT_EQ(amounts.layers[0].spheres, 9u);
  EXPECT_NEAR(*amounts.layers[0].mass, 9 * ball(0.8) * 1e-9 * 1000, 1e-18);
  EXPECT_EQ(amounts.materials.back().name, "class 1");
  EXPECT_NEAR(amounts.materials.back().volume, 18 * ball(0.5), 1e-12);
}

TEST(Layers, AreNotMadeWhereNoneIsNamed) {
  const Packing packing = lattice("");
  const auto before = made_so_far();
  EXPECT_TRUE(layers_of(packing).empty());
  EXPECT_TRUE(layer_amounts(packing).layers.empty());
  EXPECT_EQ(made_so_far(), before);
  (void)layers_of(lattice(three));
  EXPECT_EQ(made_so_far().at("layers"), 1u + (before.contains("layers") ? before.at("layers") : 0));
}

TEST(Layers, AreWrittenAsTheyWereRead) {
  const Scene scene = lattice(three).scene;
  const Scene again = parse_scene(scene_as_toml(scene), "again.toml");
  testing::expect_equal(scene, again);
  EXPECT_EQ(again.layers[2].thickness->sd, 0.01);
  EXPECT_EQ(again.layers[1].material, "C");
}

TEST(Layers, ThatCannotBeAreOneLineWithItsPlace) {
  const auto refused = [](const std::string& spheres, int line, const std::string& words) {
    try {
      parse_scene(testing::with_spheres(spheres), "test.toml");
      ADD_FAILURE() << "not refused: " << spheres;
    } catch (const Error& error) {
      EXPECT_EQ(error.location().line, line) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  const auto of = [](const std::string& layers) { return "radius = 1\nlayers = [" + layers + "]"; };
  refused(of("{ thickness = 0.1 }"), 4, "missing \"name\" in layer 1 of [spheres]");
  refused(of("{ name = \"a\" }, { name = \"a\", thickness = 0.1 }"), 4, "two of the layers");
  refused(of("{ name = \"a\" }, { name = \"b\" }"), 4, "only one may take what the others leave");
  refused(of("{ name = \"a\", share = 0.6 }, { name = \"b\", share = 0.5 }, { name = \"c\" }"), 4, "shares");
  refused(of("{ name = \"a\", share = 1.5 }, { name = \"c\" }"), 4, "below 1");
  refused(of("{ name = \"a\", radius = 0.5 }, { name = \"b\", radius = 0.4 }, { name = \"c\" }"), 4,
          "not above 0.5");
  refused(of("{ name = \"a\" }, { name = \"b\", radius = 0.4 }"), 4, "from the surface in");
  refused(of("{ name = \"a\" }, { name = \"b\", thickness = 1.5 }"), 4, "thicker than the sphere");
  refused(of("{ name = \"a\", thickness = 0.4 }, { name = \"b\", thickness = 0.5 }"), 4, "leave one of them");
  refused(of("{ name = \"a\", thickness = 0.4, share = 0.1 }"), 4, "exclude each other");
  refused(of("{ name = \"a\", thickness = { mean = 0.1 } }, { name = \"b\" }"), 4,
          "missing \"sd\" in thickness of layer 1 of [spheres]");
  refused(
      of("{ name = \"a\", thickness = { mean = 0.1, sd = 0.1, min = 0.3, max = 0.2 } }, { name = \"b\" }"), 4,
      "below \"max\"");
  refused(of("{ name = \"a\" }, { name = \"b\", thickness = { mean = 0.5, sd = 0.1 } }"), 4,
          "give the thickness a \"max\"");
  const auto drawn = [&](const std::string& thickness) {
    return of("{ name = \"a\" }, { name = \"b\", thickness = { " + thickness + " } }");
  };
  // Outside of what is drawn: the layers were all as thick as one end of it.
  refused(drawn("distribution = \"normal\", mean = 0.1, sd = 0.001, min = 0.4"), 4, "must be below 0.106");
  refused(drawn("mean = 0.1, sd = 0.001, min = 0.4, max = 0.5"), 4, "must be below 0.106");
  refused(drawn("mean = 0.1, sd = 0.001, max = 0.05"), 4, "must be above 0.094");
  EXPECT_NO_THROW(parse_scene(testing::with_spheres(drawn("mean = 0.1, sd = 0.001, min = 0.105")), ""));
  refused(drawn("distribution = \"lognormal\", median = 0.1, sigma = 0.2"), 4,
          "distribution = \"normal\" only");
  refused(drawn("distribution = \"lognormal\", mean = 0.1, sd = 0.01"), 4, "did you mean \"normal\"?");
  refused(drawn("mean = 0.1, std = 0.01"), 4, "did you mean \"sd\"?");
  refused(drawn("meen = 0.1, sd = 0.01"), 4, "did you mean \"mean\"?");
  refused(of("{ nam = \"a\" }"), 4, "did you mean \"name\"?");
  refused("radius = 1\nlayers = 3", 4, "one table { name = … }");
  refused(
      "layers = [{ name = \"a\" }]\nradius = { distribution = \"classes\", values = [1, 2], shares = [1, 1], "
      "layers = [[{ name = \"a\" }], []] }",
      3, "exclude each other");
  refused(
      "radius = { distribution = \"classes\", values = [1, 2], shares = [1, 1], layers = [[{ name = \"a\" "
      "}]] }",
      3, "one list for each of \"values\"");
  EXPECT_THROW(
      parse_scene("container = { kind = \"periodic\", edge = 9, dimension = 2 }\n[spheres]\ncount = 2\n"
                  "radius = 1\nlayers = [{ name = \"a\" }]\n",
                  "test.toml"),
      Error);
}

// They were found out only after the run, without a place.
TEST(Layers, ThatEndAtOneRadiusAreRefusedWhereSizesChange) {
  const auto refused = [](const std::string& spheres, const std::string& stage) -> std::string {
    try {
      parse_scene("container = { kind = \"box\", size = [6, 6, 6] }\n[spheres]\n" + spheres + "\n" + stage,
                  "test.toml");
    } catch (const Error& error) {
      EXPECT_EQ(error.location().line, 4) << error.what();
      return error.what();
    }
    return "";
  };
  const std::string polish = "[[stage]]\ndo = \"relax\"\npolish = 1e-8\n", half = "radius = 0.5\n";
  const std::string closed = "layers = [{ name = \"a\", radius = 0.4 }, { name = \"b\", thickness = 0.1 }]";
  EXPECT_NE(refused(half + closed, polish).find("lets all sizes grow"), std::string::npos);
  EXPECT_EQ(refused(half + closed, "[[stage]]\ndo = \"relax\"\n"), "");
  EXPECT_EQ(refused(half + "layers = [{ name = \"a\" }, { name = \"b\", thickness = 0.1 }]", polish), "");
  EXPECT_EQ(refused(half + "layers = [{ name = \"a\", share = 0.3 }, { name = \"b\", share = 0.7 }]", polish),
            "");
  EXPECT_NE(refused("count = 9\nradius = { distribution = \"classes\", values = [0.4, 0.5], shares = [1, 1], "
                    "layers = [[{ name = \"a\" }], [{ name = \"b\", radius = 0.5 }]] }",
                    polish)
                .find("of class 2 end at one radius"),
            std::string::npos);
  EXPECT_NE(refused("radius = \"largest\"\nlayers = [{ name = \"a\", share = 0.3 }, { name = \"b\", share = "
                    "0.6 }]\ncount = 5",
                    "")
                .find("leave one of them"),
            std::string::npos);
  EXPECT_EQ(refused("count = 5\nradius = \"largest\"\nlayers = [{ name = \"a\", share = 0.3 }, { name = "
                    "\"b\", share = 0.7 }]",
                    ""),
            "");
}

TEST(Layers, ThickerThanASphereOfAPackingAreRefusedWithItsNumber) {
  Packing packing = lattice("layers = [{ name = \"core\" }, { name = \"coat\", thickness = 0.1 }]");
  packing.spheres.r[5] = packing.spheres.r[500] = 0.09;
  try {
    (void)layers_of(packing);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("sphere 6,"), std::string::npos) << error.what();
  }
}

/// The voxels of a raw file.
template <class Voxel>
std::vector<Voxel> voxels_of(const Packing& packing, std::map<std::string, std::string> words) {
  const Folder folder;
  write_export(packing, output_of("raw", words), folder / "image.raw");
  const std::string bytes = text_of(folder / "image.raw");
  std::vector<Voxel> voxels(bytes.size() / sizeof(Voxel));
  std::memcpy(voxels.data(), bytes.data(), bytes.size());
  return voxels;
}

TEST(Layers, OfImagesAreExactFractionsOfEachMaterial) {
  const Packing packing = lattice(three, 6);
  const LayerAmounts amounts = layer_amounts(packing);
  const double voxel = 18.0 / 60 * 18.0 / 60 * 18.0 / 60;
  std::vector<float> sums;
  for (const MaterialAmount& material : amounts.materials) {
    const auto voxels = voxels_of<float>(
        packing, {{"resolution", "60"}, {"values", "fraction"}, {"material", material.name}});
    double volume = 0;
    for (const float share : voxels) volume += share * voxel;
    EXPECT_NEAR(volume / material.volume, 1, 1e-6) << material.name;
    sums.resize(voxels.size(), 0);
    for (std::size_t k = 0; k < voxels.size(); ++k) sums[k] += voxels[k];
  }
  const auto all = voxels_of<float>(packing, {{"resolution", "60"}, {"values", "fraction"}});
  for (std::size_t k = 0; k < all.size(); ++k) ASSERT_NEAR(sums[k], all[k], 1e-6);
}

TEST(Layers, OfImagesAreWhereTheCentresOfVoxelsLie) {
  const Packing packing = lattice(three, 3);
  const SphereLayers layers = layers_of(packing);
  const int n = 40;
  const auto of_layers = voxels_of<std::uint8_t>(packing, {{"resolution", "40"}, {"values", "layers"}});
  const auto of_materials = voxels_of<std::uint8_t>(packing, {{"resolution", "40"}, {"values", "materials"}});
  ASSERT_EQ(of_layers.size(), static_cast<std::size_t>(n * n * n));
  for (int k = 0; k < n * n * n; ++k) {
    const Vector<3> at(9.0 * (k % n + 0.5) / n, 9.0 * (k / n % n + 0.5) / n, 9.0 * (k / n / n + 0.5) / n);
    int expected = 0;  // by brute force
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      Vector<3> away = at - Vector<3>(packing.spheres.center(i));
      for (int axis = 0; axis < 3; ++axis) away[axis] -= 9 * std::round(away[axis] / 9);
      for (std::size_t layer = 0; layer < 3; ++layer)
        if (away.norm() <= layers.of(i)[layer]) {
          expected = static_cast<int>(layer) + 1;
          break;
        }
    }
    ASSERT_EQ(of_layers[static_cast<std::size_t>(k)], expected);
    ASSERT_EQ(of_materials[static_cast<std::size_t>(k)], std::min(expected, 2));
  }
}

TEST(Layers, OfOutputsHaveToBeThere) {
  const auto error_of = [](const Packing& packing, const char* format,
                           std::map<std::string, std::string> words) {
    const Folder folder;
    try {
      write_export(packing, output_of(format, words), folder / "file");
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  const Packing packing = lattice(three, 2), bare = lattice("", 2);
  EXPECT_NE(error_of(bare, "raw", {{"values", "layers"}}).find("names none"), std::string::npos);
  EXPECT_NE(error_of(packing, "raw", {{"material", "C"}}).find("values = \"fraction\""), std::string::npos);
  EXPECT_NE(error_of(packing, "raw", {{"values", "fraction"}, {"material", "D"}}).find("\"core\", \"C\""),
            std::string::npos);
  EXPECT_NE(error_of(packing, "stl", {{"layer", "D"}}).find("\"core\", \"buffer\", \"coat\""),
            std::string::npos);
  EXPECT_NE(error_of(bare, "stl", {{"layer", "core"}}).find("names none"), std::string::npos);
}

/// The volume that the triangles of a binary STL file enclose.
double volume_in_stl(const std::string& bytes) {
  double volume = 0;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
    float x[9];
    std::memcpy(x, bytes.data() + at + 12, sizeof x);
    const Vector<3> a(x[0], x[1], x[2]), b(x[3], x[4], x[5]), c(x[6], x[7], x[8]);
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

TEST(Layers, OfAnStlFileAreClosedShells) {
  const Packing packing = lattice(three, 2);
  const LayerAmounts amounts = layer_amounts(packing);
  double sum = 0;
  const Folder folder;
  const auto volume = [&](std::map<std::string, std::string> words) {
    words["deflection"] = "0.002";
    write_export(packing, output_of("stl", words), folder / "a.stl");
    return volume_in_stl(text_of(folder / "a.stl"));
  };
  for (const LayerAmount& layer : amounts.layers) {
    const double of_layer = volume({{"layer", layer.name}});
    EXPECT_NEAR(of_layer / layer.volume, 1, 0.01) << layer.name;
    sum += of_layer;
  }
  EXPECT_NEAR(sum / volume({}), 1, 1e-5);
}

TEST(Layers, OfAPovRaySceneAreShellsAndThePackingIsReadBack) {
  const Packing packing = lattice(three, 2);
  const Folder folder;
  write_export(packing, output_of("povray"), folder / "a.pov");
  const std::string text = text_of(folder / "a.pov");
  std::size_t shells = 0;
  for (std::size_t at = text.find("\nShell("); at != text.npos; at = text.find("\nShell(", at + 1)) ++shells;
  EXPECT_EQ(shells, 24u);
  EXPECT_NE(text.find("// C\n#declare Material1"), std::string::npos);
  const Packing read = import_packing(folder / "a.pov").packing;
  EXPECT_EQ(read.spheres.r, packing.spheres.r);
}

TEST(Layers, OfAGltfFileAreMeshesInTheirColours) {
  const Packing packing = lattice(three, 2);
  const Folder folder;
  write_export(packing, output_of("gltf"), folder / "a.glb");
  const std::string text = text_of(folder / "a.glb");
  for (const char* name : {"core_0", "buffer_0", "coat_7"})
    EXPECT_NE(text.find(std::string("\"name\":\"") + name + '"'), std::string::npos) << name;
  write_export(packing, output_of("gltf", {{"layers", "false"}}), folder / "b.glb");
  EXPECT_EQ(text_of(folder / "b.glb").find("core_0"), std::string::npos);
}

}  // namespace layers_test
}  // namespace bernal
