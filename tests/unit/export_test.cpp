// What other programs read is the packing: every format read back by a parser of its own.
#include "bernal/formats/export.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/export_packings.hpp"
#include "support/exports.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace export_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::example_in;
using testing::Folder;
using testing::text_of;

std::vector<Packing> packings() { return {periodic(), between_walls(), in_cylinder(), periodic(false)}; }

void expect_same(const ReadBack& read, const Packing& packing, const std::string& unit,
                 bool swapped = false) {
  ASSERT_EQ(read.radii.size(), packing.spheres.size());
  const std::array<std::size_t, 3> axes =
      swapped ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2};
  for (std::size_t i = 0; i < read.radii.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double given = k < packing.spheres.x.size() ? packing.spheres.x[k][i] : 0.0;
      EXPECT_EQ(read.centers[i][axes[k]], in_unit(given, unit)) << i << " axis " << k;
    }
    EXPECT_EQ(read.radii[i], in_unit(packing.spheres.r[i], unit)) << i;
  }
  if (read.types.empty()) return;
  for (std::size_t i = 0; i < read.types.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (packing.spheres.r[i] < packing.spheres.r[j]) {
        EXPECT_LE(read.types[i], read.types[j]);
      }
}

/// One period where the domain repeats itself; elsewhere more than the domain, by no more than a diameter.
void expect_box(const ReadBack& read, const Packing& packing, const std::string& unit) {
  ASSERT_TRUE(read.has_box);
  const Bounds<3> bounds = bounds_of(packing.domain);
  const auto* box = std::get_if<Box>(&packing.domain);
  for (int k = 0; k < dimension_of(packing.domain); ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (box && box->repeats(k)) {
      EXPECT_EQ(read.lower[axis], 0);
      EXPECT_EQ(read.upper[axis], in_unit(box->size[k], unit));
      continue;
    }
    const double largest =
        in_unit(*std::max_element(packing.spheres.r.begin(), packing.spheres.r.end()), unit);
    EXPECT_LT(read.lower[axis], in_unit(bounds.lower[k], unit));
    EXPECT_GT(read.lower[axis], in_unit(bounds.lower[k], unit) - 2 * largest);
    EXPECT_GT(read.upper[axis], in_unit(bounds.upper[k], unit));
    EXPECT_LT(read.upper[axis], in_unit(bounds.upper[k], unit) + 2 * largest);
  }
}

TEST(Export, LammpsReadsWhatWasPacked) {
  for (const Packing& packing : packings())
    for (const std::string unit : {"m", "cm", "mm"}) {
      const Folder folder;
      double density = 0;
      const ReadBack read =
          read_lammps(exported_to(folder, packing, "lammps", {{"unit", unit}, {"density", "2650"}}), density);
      expect_same(read, packing, unit);
      expect_box(read, packing, unit);
      // kg/m³ in the masses of the unit style: kg, g, and kg for one that has no style.
      EXPECT_EQ(density, unit == "m" ? 2650 : unit == "cm" ? 2.65 : 2650 / 1e9);
      const std::string text = text_of(folder / "a.lammps");
      EXPECT_NE(text.find("lengths in " + unit + ","), text.npos);
      EXPECT_NE(text.find(unit == "m" ? "units si" : unit == "cm" ? "units cgs" : "units lj"), text.npos);
    }
}

TEST(Export, LammpsIsToldWhichAxesRepeatThemselves) {
  const Folder folder;
  EXPECT_NE(text_of(exported_to(folder, periodic(), "lammps")).find("boundary p p p"), std::string::npos);
  EXPECT_NE(text_of(exported_to(folder, between_walls(), "lammps")).find("boundary p p f"),
            std::string::npos);
  EXPECT_NE(text_of(exported_to(folder, in_plane(), "lammps")).find("dimension 2; boundary f f p"),
            std::string::npos);
}

// LAMMPS before 2022 refuses boxes whose tilt is above half an edge, unless it is told to take them.
TEST(Export, LammpsIsToldToTakeLargeTilts) {
  const Folder folder;
  const Vector<3> edges(3, 4, 5.3);
  const auto asks = [&](const Tilt& tilt) {
    Packing packing = periodic();
    packing.domain = periodic_box(edges, {}, tilt);
    packing.scene.container = PeriodicBox{
        .dimension = 3, .size = {3, 4, 5.3}, .tilt = std::vector<double>(tilt.begin(), tilt.end())};
    return text_of(exported_to(folder, packing, "lammps")).find("; box tilt large; read_data ") !=
           std::string::npos;
  };
  EXPECT_FALSE(asks({}));
  EXPECT_FALSE(asks({1.25, -1.25, 1.75}));
  EXPECT_TRUE(asks({1.75, 0, 0}));
  EXPECT_TRUE(asks({0, -1.75, 0}));
  EXPECT_FALSE(asks({0, 0, 1.75}));  // along y
  EXPECT_TRUE(asks({0, 0, -2.25}));
}

TEST(Export, DiscsStandInThePlane) {
  const Packing packing = in_plane();
  const Folder folder;
  double density = 0;
  const ReadBack atoms = read_lammps(exported_to(folder, packing, "lammps", {{"unit", "mm"}}), density);
  expect_same(atoms, packing, "mm");
  expect_box(atoms, packing, "mm");
  EXPECT_LT(atoms.lower[2], 0);
  EXPECT_GT(atoms.upper[2], 0);
  expect_same(read_esys(exported_to(folder, packing, "esys")), packing, "mm");
  expect_same(read_extxyz(exported_to(folder, packing, "extxyz")), packing, "mm");
  expect_same(read_pfc(exported_to(folder, packing, "pfc"), 2), packing, "m");
  expect_same(read_mfix(exported_to(folder, packing, "mfix"), 2, density), packing, "m");
  const auto gsd = read_gsd(exported_to(folder, packing, "gsd"));
  EXPECT_EQ(gsd.at("configuration/dimensions").bytes, "\x02");
  EXPECT_EQ(gsd.at("configuration/box").as<float>()[2], 0.0F);
}

TEST(Export, TextFormatsReadBack) {
  for (const Packing& packing : packings()) {
    const Folder folder;
    double density = 0;
    expect_same(read_yade(exported_to(folder, packing, "yade")), packing, "m");
    const ReadBack esys = read_esys(exported_to(folder, packing, "esys"));
    expect_same(esys, packing, "mm");
    expect_box(esys, packing, "mm");
    const ReadBack xyz = read_extxyz(exported_to(folder, packing, "extxyz"));
    expect_same(xyz, packing, "mm");
    expect_box(xyz, packing, "mm");
    const ReadBack pfc = read_pfc(exported_to(folder, packing, "pfc", {{"density", "1850.5"}}), 3);
    expect_same(pfc, packing, "m");
    expect_box(pfc, packing, "m");
    EXPECT_NE(text_of(folder / "a.pfc").find("\nball attribute density 1850.5\n"), std::string::npos);
    expect_same(read_mfix(exported_to(folder, packing, "mfix", {{"density", "1850.5"}}), 3, density), packing,
                "m");
    EXPECT_EQ(density, 1850.5);
    expect_same(read_povray(exported_to(folder, packing, "povray")), packing, "mm", true);
    const ReadBack granular = read_lammps(exported_to(folder, packing, "liggghts"), density);
    expect_same(granular, packing, "m");
    expect_box(granular, packing, "m");
    EXPECT_EQ(density, 2500);
  }
}

// POV-Ray sees nothing smaller than 1e-6 or farther than 1e7: what is of another size has a length of its
// own.
TEST(Export, PicturesAreOfASizeThatIsSeen) {
  for (const double scale : {1e-12, 1e-5, 1e-3, 1.0, 1e3, 1e9}) {
    Packing packing =
        packing_in(Cylinder{.base = scale * Vector<3>(1, 2, -1), .radius = 2 * scale, .height = 5 * scale},
                   "kind = \"cylinder\"\nradius = 2\nheight = 5");
    for (double& r : packing.spheres.r) r *= scale;
    const Folder folder;
    const WrittenExport written = write_export(packing, output_of("povray"), folder / "a.pov");
    const ReadBack read = read_povray(folder / "a.pov");
    double length = 1;
    if (const std::size_t at = written.note.find("a length of 1 is "); at != written.note.npos)
      length = std::stod(written.note.substr(at + 17));
    const std::string head = text_of(folder / "a.pov").substr(0, 200);
    EXPECT_EQ(length == 1, scale == 1 || scale == 1e3) << written.note;
    EXPECT_NE(head.find(length == 1 ? "lengths in mm;" : fmt::format("lengths in {} mm", length)),
              std::string::npos)
        << head;
    ASSERT_EQ(read.radii.size(), packing.spheres.size());
    for (std::size_t i = 0; i < read.radii.size(); ++i) {
      EXPECT_GT(read.radii[i], 1e-4);
      EXPECT_LT(read.radii[i], 1e4);
      EXPECT_NEAR(read.radii[i] * length, packing.spheres.r[i], 1e-12 * packing.spheres.r[i]);
      for (std::size_t k = 0; k < 3; ++k)  // one middle for all
        EXPECT_NEAR((read.centers[i][k] - read.centers[0][k]) * length,
                    packing.spheres.x[k == 0 ? 0 : 3 - k][i] - packing.spheres.x[k == 0 ? 0 : 3 - k][0],
                    1e-12 * scale);
    }
  }
}

TEST(Export, LammpsIsToldHowFarNeighboursAre) {
  const Folder folder;
  EXPECT_NE(text_of(exported_to(folder, periodic(), "lammps")).find("; neighbor 5e-05 bin;"),
            std::string::npos)
      << text_of(folder / "a.lammps").substr(0, 300);
}

TEST(Export, ArraysReadBack) {
  const Packing packing = in_cylinder();
  const std::size_t n = packing.spheres.size();
  const Folder folder;
  const Array all = read_npy(exported_to(folder, packing, "npy"));
  EXPECT_EQ(all.shape, (std::vector<std::size_t>{n, 4}));
  const Array centers = read_npy(exported_to(folder, packing, "openmc")),
              radii = read_npy(folder / "a_radii.npy");
  EXPECT_EQ(centers.shape, (std::vector<std::size_t>{n, 3}));
  EXPECT_EQ(radii.shape, std::vector<std::size_t>{n});
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(all.values[4 * i + k], packing.spheres.x[k][i]);
      EXPECT_EQ(centers.values[3 * i + k], packing.spheres.x[k][i] / 10);
    }
    EXPECT_EQ(all.values[4 * i + 3], packing.spheres.r[i]);
    EXPECT_EQ(radii.values[i], packing.spheres.r[i] / 10);
  }
  const std::string module = text_of(folder / "a.py");
  for (const char* word : {"\"a.openmc\"", "\"a_radii.npy\"", "openmc.Cylinder(0.1, 0.2, -0.1, 0.2,"})
    EXPECT_NE(module.find(word), std::string::npos) << word << "\n" << module;
}

TEST(Export, ArraysHoldAnyDimension) {
  for (const int dimension : {1, 2, 5}) {
    Packing packing;
    packing.spheres = example_in(dimension);
    packing.domain = periodic_box(Vector<dynamic>::Constant(dimension, 9));
    packing.volume = volume_of(packing.domain);
    packing.scene = parse_scene(fmt::format("[container]\nkind = \"periodic\"\ndimension = {}\nedge = 9\n"
                                            "[spheres]\npacking_fraction = 0.01\nradius = 0.1\n",
                                            dimension),
                                "");
    const Folder folder;
    const Array all = read_npy(exported_to(folder, packing, "npy"));
    const auto columns = static_cast<std::size_t>(dimension) + 1;
    ASSERT_EQ(all.shape, (std::vector<std::size_t>{packing.spheres.size(), columns}));
    EXPECT_EQ(all.values[columns - 1], packing.spheres.r[0]);
    EXPECT_EQ(all.values[columns], packing.spheres.x[0][1]);
  }
}

TEST(Export, GsdHoldsTheBoxAroundTheOrigin) {
  for (const Packing& packing : packings()) {
    const Folder folder;
    const auto chunks = read_gsd(exported_to(folder, packing, "gsd"));
    const std::size_t n = packing.spheres.size();
    EXPECT_EQ(chunks.at("particles/N").as<std::uint32_t>(),
              std::vector<std::uint32_t>{static_cast<std::uint32_t>(n)});
    EXPECT_EQ(chunks.at("configuration/dimensions").bytes, "\x03");
    const auto box = chunks.at("configuration/box").as<float>();
    const auto positions = chunks.at("particles/position").as<float>(),
               diameters = chunks.at("particles/diameter").as<float>();
    const auto types = chunks.at("particles/typeid").as<std::uint32_t>();
    ASSERT_EQ(box.size(), 6u);
    ASSERT_EQ(positions.size(), 3 * n);
    EXPECT_EQ(chunks.at("particles/position").columns, 3u);
    EXPECT_EQ(chunks.at("particles/types").rows, 1 + *std::max_element(types.begin(), types.end()));
    const Bounds<3> bounds = bounds_of(packing.domain);
    for (int k = 0; k < 3; ++k)
      EXPECT_GE(box[static_cast<std::size_t>(k)], static_cast<float>(bounds.size()[k]));
    if (!has_walls(packing.domain)) {
      EXPECT_EQ(box[2], 5.3F);
    }
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(diameters[i], static_cast<float>(2 * packing.spheres.r[i]));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        const double middle = 0.5 * (bounds.lower[axis] + bounds.upper[axis]);
        EXPECT_EQ(positions[3 * i + k], static_cast<float>(packing.spheres.x[k][i] - middle));
        EXPECT_LE(std::abs(positions[3 * i + k]), 0.5F * box[k]);
      }
    }
  }
}

// A coordinate just below the end of a period becomes the end itself in single precision, which is no place
// in the box of a program that has half-open ones.
TEST(Export, SinglePrecisionKeepsCentresInThePeriod) {
  Packing packing = periodic();
  packing.spheres.x[1][0] = std::nextafter(4.0, 0.0);
  const Folder folder;
  const auto chunks = read_gsd(exported_to(folder, packing, "gsd"));
  EXPECT_EQ(chunks.at("particles/position").as<float>()[1], -2.0F);
}

TEST(Export, TypesAreRadiiWhereFewOccurElseOneElseBins) {
  const auto types_of = [](const Packing& packing, const std::map<std::string, std::string>& words) {
    const Folder folder;
    double density = 0;
    return read_lammps(exported_to(folder, packing, "lammps", words), density).types;
  };
  const Packing three = periodic(), many = periodic(false);
  const std::vector<int> by_radius = types_of(three, {});
  for (std::size_t i = 0; i < by_radius.size(); ++i)
    EXPECT_EQ(by_radius[i], three.spheres.r[i] == 0.1 ? 3 : three.spheres.r[i] == 0.0625 ? 2 : 1);
  for (const int type : types_of(many, {})) EXPECT_EQ(type, 1);
  const std::vector<int> bins = types_of(many, {{"types", "4"}});
  const auto [low, high] = std::minmax_element(many.spheres.r.begin(), many.spheres.r.end());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double place = 4 * (many.spheres.r[i] - *low) / (*high - *low);
    EXPECT_LE(std::abs(bins[i] - 0.5 - place), 0.5 + 1e-9) << place;
  }
}

}  // namespace export_test
}  // namespace bernal
