#include <sstream>

#include <fmt/format.h>

#include "bernal/formats/export.hpp"
#include "check.hpp"
#include "support/level_packings.hpp"

// What is said of levels of spheres, in files and of them: names of materials, lines, what is left out.
namespace bernal::testing {
namespace level_words_test {

using namespace levels;

TEST(LevelWords, MaterialsAreKeptApart) {
  const Folder folder;
  const std::string longer = "a_name_of_more_than_thirty_letters_";
  const Packing packing =
      with_layers(layered_cylinder({0, 0, 1}),
                  fmt::format(R"([{{name = "background", share = 0.3}}, {{name = "{0}1", share = 0.3}}, )"
                              R"({{name = "{0}2"}}])",
                              longer));
  for (const char* format : {"openmc", "serpent", "scone", "mcnp"}) {
    const auto file = folder / (std::string(format) + (format == std::string("openmc") ? ".xml" : ".inp"));
    const std::string note = write_export(packing, output_of(format), file).note;
    const bool cuts = format == std::string("scone");
    EXPECT_NE(note.find(fmt::format("materials background, background_2, {}, {}",
                                    cuts ? longer.substr(0, 30) : longer + "1",
                                    cuts ? longer.substr(0, 28) + "_2" : longer + "2")),
              std::string::npos)
        << format << ": " << note;
  }
}

TEST(LevelWords, LinesOfMcnpAreAsLongAsItReads) {
  const Folder folder;
  write_export(layered_cylinder({0, 0, -1}), output_of("mcnp"), folder / "m");
  std::istringstream lines(text_of(folder / "m"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("c ")) {  // of comments MCNP leaves the rest
      EXPECT_LE(line.size(), 80u) << line;
    }
    EXPECT_EQ((line + " ").find(" -0 "), line.npos) << line;
  }
}

TEST(LevelWords, WhatAFormatLeavesOutIsSaid) {
  const Folder folder;
  const Packing nest = nested(false), layers = layered_cylinder({0, 0, 1});
  for (const auto& [format, name] :
       {std::pair{"openmc", "m.npy"}, {"extxyz", "m.xyz"}, {"lammps", "m.data"}}) {
    EXPECT_NE(
        write_export(nest, output_of(format), folder / name)
            .note.find("; the layers of spheres and what lies inside of them are left out: openmc, as .xml"),
        std::string::npos)
        << format;
    EXPECT_NE(
        write_export(layers, output_of(format), folder / name).note.find("; the layers of spheres are left"),
        std::string::npos)
        << format;
  }
  EXPECT_EQ(write_export(nest, output_of("openmc"), folder / "m.xml").note.find("left out"),
            std::string::npos);
  EXPECT_EQ(write_export(nest, output_of("flat"), folder / "m.csv").note.find("left out"), std::string::npos);
  expect_refusal([&] { write_export(nest, output_of("openmc"), folder / "c.dat"); },
                 {"c.dat", ".npy", ".xml"});
}

TEST(LevelWords, AContainerThatIsRefusedIsNamedAsItsSceneDoes) {
  const Folder folder;
  const Mesh walls{{{0, 0, 0}, {90, 0, 0}, {0, 90, 0}, {0, 0, 90}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  for (const auto& [keys, words] :
       {std::pair{"kind = \"box\"\nsize = [9, 9, 9]\nrounding = 1", "a box with \"rounding\""},
        {"kind = \"box\"\nsize = [9, 9, 9]\nobstacles = [{ kind = \"sphere\", radius = 1 }]",
         "a box with \"obstacles\""},
        {"kind = \"extruded\"\npolygon = [[0, 0], [9, 0], [0, 9]]\nheight = 9", "of kind \"extruded\""}}) {
    const Packing packing = packing_in(walls, keys);
    for (const char* format : {"openmc", "serpent", "scone", "mcnp"})
      expect_refusal([&] { write_export(packing, output_of(format), folder / "m"); }, {words, format});
  }
}

}  // namespace level_words_test
}  // namespace bernal::testing
