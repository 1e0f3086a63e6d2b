#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "check.hpp"
#include "support/level_packings.hpp"

// Levels of spheres for programs of particle transport. A tracer that shares no code with the writers
// (tests/tracer) reads the files, and has to find at every point what the packing has there.
namespace bernal::testing {
namespace levels_test {

using namespace levels;

constexpr const char* debian_python = "/usr/bin/python3";

/// What stands at a point of a packing, by the packing alone, and how far it is from where that changes.
struct Standing {
  std::string material;
  double margin = 1e300;
};

void look(const Packing& packing, const Vector<3>& p, const std::string& between, Standing& found) {
  found.material = between;
  const SphereLayers layers = layers_of(packing);
  const auto boundary = boundary_of<3>(packing.domain);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const auto& x = packing.spheres.x;
    const Vector<3> q = boundary.minimum_image(p - Vector<3>(x[0][i], x[1][i], x[2][i]));
    const double distance = q.norm(), r = packing.spheres.r[i];
    found.margin = std::min(found.margin, std::abs(distance - r));
    if (distance >= r) continue;
    found.material = packing.scene.material.empty() ? "spheres" : packing.scene.material;
    if (layers.empty()) return;
    const auto outer = layers.of(i);
    std::size_t k = 0;
    while (k + 1 < outer.size() && outer[k] <= distance) ++k;
    for (const double end : outer) found.margin = std::min(found.margin, std::abs(distance - end));
    found.material = material_of(layers.of_class[0][k]);
    if (k > 0) return;
    for (const PackingsInside& inside : packing.inside)
      for (std::size_t j = 0; j < inside.spheres.size(); ++j) {
        if (inside.spheres[j] != i) continue;
        const Packing& held = *inside.templates[inside.which[j]];
        const auto [w, qx, qy, qz] = inside.rotations[j];
        const double unit = metres_per(packing.scene.unit) / metres_per(held.scene.unit);
        const Vector<3> back = Eigen::Quaterniond(w, qx, qy, qz).conjugate() * q;
        Standing within;
        look(held, unit * back, found.material, within);
        found.material = within.material;
        found.margin = std::min(found.margin, within.margin / unit);
      }
    return;
  }
}

/// Half of them anywhere in the bounds, the others about the spheres.
std::vector<Vector<3>> points_in(const Packing& packing, std::size_t count) {
  Random random(3, stream(Stream::test, 1));
  const Bounds<3> bounds = bounds_of(packing.domain);
  const auto& x = packing.spheres.x;
  std::vector<Vector<3>> points(count);
  for (std::size_t k = 0; k < count; ++k) {
    points[k] = uniform_point(random, bounds);
    if (k % 2) continue;
    const std::size_t i = k / 2 % packing.spheres.size();
    const Vector<3> center(x[0][i], x[1][i], x[2][i]);
    points[k] =
        center + 1.1 * packing.spheres.r[i] * std::cbrt(random.uniform()) * uniform_direction<3>(random);
  }
  return points;
}

/// `is_within` says which points of the bounds the container has, and how far they are from its walls.
template <class Within>
void expect_traced(const Packing& packing, const std::string& format, const std::string& name,
                   const Within& clearance, std::size_t count = 20000) {
  if (Process({debian_python, "-c", "import numpy"}).wait().status != 0)
    GTEST_SKIP() << "numpy is not installed";
  const Folder folder;
  write_export(packing, output_of(format), folder / name);
  constexpr double too_near = 1e-7;  // of a surface, in the packing's unit, for files in another
  std::vector<std::string> known;
  std::string lines;
  const double to_cm = metres_per(packing.scene.unit) / 0.01;
  std::map<std::string, int> met;
  for (const Vector<3>& p : points_in(packing, count)) {
    const double clear = clearance(p);
    Standing standing;
    if (clear > 0) look(packing, p, "background", standing);
    if (std::min(standing.margin, std::abs(clear)) < too_near) continue;
    known.push_back(clear > 0 ? standing.material : "outside");
    ++met[known.back()];
    const Vector<3> at = to_cm * p;
    lines += fmt::format("{} {} {}\n", at[0], at[1], at[2]);
  }
  ASSERT_GT(known.size(), count / 2);
  const Ended traced = Process({debian_python, "-B", BERNAL_SOURCE "/tests/tracer/trace.py", format,
                                folder / name, "--at", folder.write("points.txt", lines).string()})
                           .wait();
  ASSERT_EQ(traced.status, 0) << traced.err;
  std::istringstream words(traced.out);
  std::size_t wrong = 0;
  std::string word, first;
  for (std::size_t k = 0; k < known.size() && words >> word; ++k)
    if (word != known[k] && wrong++ == 0) first = fmt::format("point {}: {}, not {}", k, word, known[k]);
  EXPECT_EQ(std::count(traced.out.begin(), traced.out.end(), '\n'), std::ptrdiff_t(known.size()));
  EXPECT_EQ(wrong, 0u) << format << ", of " << known.size() << ", the first " << first;
  for (const auto& [material, points] : met) EXPECT_GT(points, 5) << material << " is hardly tested";
}

TEST(Levels, LayersInACylinderStandInEveryFormat) {
  const Packing packing = layered_cylinder({0, 0, 1});
  const auto clear = [&](const Vector<3>& p) { return above_floor(p, std::get<Cylinder>(packing.domain)); };
  expect_traced(packing, "openmc", "model", clear);
  expect_traced(packing, "openmc", "model.xml", clear);
  expect_traced(packing, "serpent", "core.inp", clear);
  expect_traced(packing, "scone", "core", clear);
  expect_traced(packing, "mcnp", "core.inp", clear);
}

TEST(Levels, ObliqueAxesAndConesAreWalls) {
  const Packing oblique = layered_cylinder({1, 2, 3});
  for (const auto& [format, name] :
       {std::pair{"openmc", "m"}, {"serpent", "m.inp"}, {"scone", "m"}, {"mcnp", "m"}})
    expect_traced(oblique, format, name,
                  [&](const Vector<3>& p) { return above_floor(p, std::get<Cylinder>(oblique.domain)); });
  // A vessel: a cylinder over a cone that ends in a point.
  const Revolved vessel{.base = {1, 0, 2}, .axis = {0, 0, 1}, .profile = {{0, 0}, {3, 2}, {3, 6}, {0, 6}}};
  const Packing packing =
      with_layers(apart(packing_in(vessel, "kind = \"box\"\nsize = [9, 9, 9]")), three_layers);
  const auto clear = [&](const Vector<3>& p) {
    const Vector<3> q = p - vessel.base;
    const double r = std::hypot(q[0], q[1]);
    return std::min({6 - q[2], 3 - r, (q[2] - r * 2 / 3) / std::hypot(1, 2.0 / 3)});
  };
  for (const auto& [format, name] :
       {std::pair{"openmc", "m"}, {"serpent", "m.inp"}, {"scone", "m"}, {"mcnp", "m"}})
    expect_traced(packing, format, name, clear);
  // A frustum is one body for MCNP; a tube has an inner wall.
  const Revolved frustum{.base = {1, 0, 2}, .axis = {0, 0, -1}, .profile = {{0, 0}, {3, 0}, {2, 5}, {0, 5}}};
  const auto within_frustum = [&](const Vector<3>& p) {
    const double r = std::hypot(p[0] - 1, p[1]), z = 2 - p[2];
    return std::min({z, 5 - z, (3 - z / 5 - r) / std::hypot(1, 0.2)});
  };
  expect_traced(with_layers(apart(packing_in(frustum, "kind = \"box\"\nsize = [9, 9, 9]")), three_layers),
                "mcnp", "m", within_frustum);
  const Revolved tube{.base = {0, 0, 0}, .axis = {0, 1, 0}, .profile = {{1, 0}, {3, 0}, {3, 5}, {1, 5}}};
  const auto within_tube = [&](const Vector<3>& p) {
    const double r = std::hypot(p[0], p[2]);
    return std::min({p[1], 5 - p[1], 3 - r, r - 1});
  };
  Packing around = packing_in(tube, "kind = \"box\"\nsize = [9, 9, 9]");
  for (double& r : around.spheres.r) r *= 0.5;
  for (std::size_t i = 0; i < around.spheres.size(); ++i) {
    const double turn = 0.1 * static_cast<double>(i);
    around.spheres.x[0][i] = 2 * std::cos(turn);
    around.spheres.x[2][i] = 2 * std::sin(turn);
  }
  for (const auto& [format, name] : {std::pair{"openmc", "m"}, {"serpent", "m.inp"}, {"mcnp", "m"}})
    expect_traced(apart(around), format, name, within_tube);
}

TEST(Levels, SpheresAcrossAPeriodicFaceStandOnBothSides) {
  Packing packing = with_layers(grown(exports::periodic(false)), three_layers);
  Spheres<dynamic>& s = packing.spheres;
  s.x[0][0] = 0.01, s.x[1][0] = 3.99, s.x[2][0] = 5.29;  // across a corner
  packing = apart(packing);
  for (const auto& [format, name] : {std::pair{"openmc", "m"}, {"serpent", "m.inp"}, {"scone", "m"}})
    expect_traced(packing, format, name, in_box);
}

TEST(Levels, WhatLiesInsideIsTurnedAsThePackingHasIt) {
  const Packing packing = nested(true);
  const auto clear = [&](const Vector<3>& p) { return above_floor(p, std::get<Cylinder>(packing.domain)); };
  expect_traced(packing, "openmc", "model", clear, 60000);
  expect_traced(packing, "serpent", "core.inp", clear, 60000);
  expect_traced(packing, "scone", "core", clear, 60000);
}

/// The numbers of spheres, the radii, and largest difference of places after a conversion.
void expect_same_spheres(const Packing& read, const Packing& known, const std::string& what) {
  ASSERT_EQ(read.spheres.size(), known.spheres.size()) << what;
  const double to_cm = metres_per(known.scene.unit) / 0.01;
  EXPECT_EQ(read.scene.unit, Unit::cm) << what;
  for (std::size_t i = 0; i < known.spheres.size(); ++i) {
    EXPECT_DOUBLE_EQ(read.spheres.r[i], to_cm * known.spheres.r[i]) << what << " " << i;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_DOUBLE_EQ(read.spheres.x[k][i], to_cm * known.spheres.x[k][i]) << what << " " << i;
  }
  EXPECT_EQ(kind_of(read.domain), kind_of(known.domain)) << what;
  EXPECT_NEAR(volume_of(read.domain), std::pow(to_cm, 3) * volume_of(known.domain),
              1e-12 * volume_of(read.domain))
      << what;
}

TEST(Levels, EveryLevelIsReadBack) {
  const Packing packing = nested(false), box = with_layers(apart(exports::periodic()), three_layers);
  const Folder folder;
  for (const auto& [format, name, file] :
       {std::array<std::string, 3>{"openmc", "model", "model/geometry.xml"},
        {"openmc", "model.xml", "model.xml"},
        {"serpent", "core.inp", "core.inp"},
        {"scone", "core", "core"}}) {
    write_export(packing, output_of(format), folder / name);
    EXPECT_EQ(import_packing(folder / file).notes.at(0).text, format + ": level core");
    expect_same_spheres(import_packing(folder / file).packing, packing, format);
    for (std::size_t k = 0; k < 2; ++k)
      expect_same_spheres(import_packing(folder / file, {.level = fmt::format("core-1-{}", k + 1)}).packing,
                          *packing.inside[0].templates[k], format + " inside");
    expect_refusal([&] { import_packing(folder / file, {.level = "bed"}); },
                   {"no level \"bed\"", "core, core-1-1, core-1-2"});
    write_export(box, output_of(format), folder / ("box_" + name));
    expect_same_spheres(import_packing(folder / ("box_" + file)).packing, box, format + " box");
  }
  const Packing layered = layered_cylinder({0, 0, 1});
  write_export(layered, output_of("mcnp"), folder / "layered.inp");
  expect_same_spheres(import_packing(folder / "layered.inp").packing, layered, "mcnp");
  expect_refusal([&] { write_export(packing, output_of("mcnp"), folder / "nested.inp"); },
                 {"mcnp", "one level", "openmc"});
  EXPECT_FALSE(std::filesystem::exists(folder / "nested.inp"));
}

/// What the notes of an import say of something; empty where they are silent.
std::string said_of(const ImportedPacking& read, std::string_view about) {
  for (const ImportNote& note : read.notes)
    if (note.about == about) return note.text;
  return {};
}

/// Layers of the same spheres end at the same places, in cm, and are of the same materials.
void expect_same_layers(const Packing& read, const Packing& known, const std::string& what) {
  const SphereLayers a = layers_of(read), b = layers_of(known);
  ASSERT_EQ(a.first, b.first) << what;
  const double to_cm = metres_per(known.scene.unit) / 0.01;
  for (std::size_t k = 0; k < b.outer.size(); ++k)
    ASSERT_NEAR(a.outer[k], to_cm * b.outer[k], 1e-12 * a.outer[k]) << what << " " << k;
  for (std::size_t k = 0; k < b.of_class[0].size(); ++k) {
    EXPECT_EQ(material_of(a.of_class[0][k]), material_of(b.of_class[0][k])) << what;
    EXPECT_EQ(a.of_class[0][k].material_density, b.of_class[0][k].material_density) << what;
  }
}

TEST(Levels, LayersAreReadBackFromTheirShells) {
  const Folder folder;
  const auto reads = [&](const Packing& packing, const std::string& format, const std::string& name,
                         const std::string& file, const std::string& level = {}) {
    if (format == "openmc")
      std::filesystem::remove_all(folder / name);  // what bernal left there goes otherwise
    write_export(packing, output_of(format), folder / name);
    return import_packing(folder / file, {.level = level});
  };
  const auto each = [](const auto& call) {
    for (const auto& [format, name, file] :
         {std::array<std::string, 3>{"openmc", "model", "model/geometry.xml"},
          {"openmc", "model.xml", "model.xml"},
          {"serpent", "core.inp", "core.inp"}})
      call(format, name, file);
  };
  // Of spheres of many sizes: a share, what is left, a thickness; some of them images of others.
  const Packing box = with_layers(
      apart(exports::periodic()),
      R"([{name = "kernel", share = 0.3, material_density = "10.4 g/cm3"}, {name = "buffer"}, {name = "SiC", thickness = 0.004}])");
  const Packing twice = with_layers(
      layered_cylinder({0, 0, 1}),
      R"([{name = "in", thickness = 0.01, material = "C"}, {name = "middle"}, {name = "out", material = "C", share = 0.1}])");
  Packing drawn = layered_cylinder({0, 0, 1});
  drawn = with_layers(
      drawn,
      R"([{name = "in"}, {name = "out", thickness = {distribution = "normal", mean = 0.01, sd = 0.001}}])");
  const Packing nest = nested(true);
  each([&](const std::string& format, const std::string& name, const std::string& file) {
    const ImportedPacking of_box = reads(box, format, name, file);
    EXPECT_EQ(said_of(of_box, "layers"), "kernel, buffer, SiC") << format;
    expect_same_layers(of_box.packing, box, format + " box");
    const ImportedPacking of_twice = reads(twice, format, name, file);
    EXPECT_EQ(said_of(of_twice, "layers"), "C, middle, C 2") << format;
    expect_same_layers(of_twice.packing, twice, format + " twice");
    const ImportedPacking of_drawn = reads(drawn, format, name, file);
    EXPECT_NE(said_of(of_drawn, "layers").find("are not taken over: they differ"), std::string::npos)
        << format;
    EXPECT_TRUE(of_drawn.packing.scene.layers.empty());
    const ImportedPacking of_nest = reads(nest, format, name, file);
    expect_same_layers(of_nest.packing, nest, format + " nest");
    EXPECT_EQ(said_of(of_nest, "layers"), "fuel, graphite") << format;
    EXPECT_NE(said_of(of_nest, "inside")
                  .find(fmt::format("in {} of {} spheres are not taken over", nest.inside[0].spheres.size(),
                                    nest.spheres.size())),
              std::string::npos)
        << said_of(of_nest, "inside");
    const ImportedPacking inner = reads(nest, format, name, file, "core-1-2");
    expect_same_layers(inner.packing, *nest.inside[0].templates[1], format + " inside");
    EXPECT_EQ(said_of(inner, "inside"), "");
    // A result of it is packed, certified and written again.
    write_imported(of_box.packing, folder / file, folder / ("out_" + name));
    EXPECT_EQ(bernal({"verify", (folder / ("out_" + name)).string()}).status, 0);
  });
  // Shells that somebody has changed are no layers, and the spheres are read all the same.
  write_export(box, output_of("serpent"), folder / "core.inp");
  std::string text = text_of(folder / "core.inp");
  const std::size_t at = text.find(" sph 0 0 0 ") + 11;
  text.replace(at, text.find('\n', at) - at, "5");
  folder.write("core.inp", text);
  const ImportedPacking changed = import_packing(folder / "core.inp");
  EXPECT_NE(said_of(changed, "layers").find("is not as bernal wrote it"), std::string::npos);
  expect_same_spheres(changed.packing, box, "changed");
}

TEST(Levels, WhatNoProgramHoldsIsRefusedInALine) {
  const Folder folder;
  const Mesh walls{{{0, 0, 0}, {90, 0, 0}, {0, 90, 0}, {0, 0, 90}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Packing in_mesh = packing_in(walls, "kind = \"box\"\nsize = [9, 9, 9]");
  for (const char* format : {"openmc", "serpent", "scone", "mcnp"})
    expect_refusal([&] { write_export(in_mesh, output_of(format), folder / "m"); }, {format, "mesh"});
  const Packing packing = nested(false);
  expect_refusal(
      [&] {
        write_export(packing, output_of("serpent", {{"contact", "shrink"}}), folder / "m");
      },
      {"shrinks no spheres that hold others"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));

  // Files of others, cut off, or without what they name.
  write_export(packing, output_of("serpent"), folder / "core.inp");
  const std::string rows = text_of(folder / "core_core.pbed");
  folder.write("core_core.pbed", rows.substr(0, rows.size() / 2));
  expect_refusal([&] { import_packing(folder / "core.inp"); }, {"core_core.pbed"});
  std::filesystem::remove(folder / "core_core.pbed");
  expect_refusal([&] { import_packing(folder / "core.inp"); }, {"core_core.pbed", "is not there"});
  folder.write("mine.xml", "<?xml version=\"1.0\"?>\n<geometry/>\n");
  expect_refusal([&] { import_packing(folder / "mine.xml", {.format = "openmc"}); },
                 {"mine.xml", "only files that bernal wrote"});
}

// What goes with an input takes no place but that of its own kind, as bernal wrote it.
TEST(Levels, FilesBesideAreNobodyElses) {
  const Folder folder;
  const Packing packing = nested(false);
  folder.write("core_core-1-2.pbed", "mine\n");
  expect_refusal([&] { write_export(packing, output_of("serpent"), folder / "core.inp"); },
                 {"core_core-1-2.pbed", "goes with core.inp"});
  EXPECT_EQ(text_of(folder / "core_core-1-2.pbed"), "mine\n");
  std::filesystem::remove(folder / "core_core-1-2.pbed");
  for (int k = 0; k < 2; ++k) write_export(packing, output_of("serpent"), folder / "core.inp");
  write_export(packing, output_of("openmc"), folder / "model");
  expect_refusal([&] { write_export(packing, output_of("openmc"), folder / "model"); },
                 {"model", "stands there already"});
}

}  // namespace levels_test
}  // namespace bernal::testing
