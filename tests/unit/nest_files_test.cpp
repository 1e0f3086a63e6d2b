// The folder of a packing with packings inside of its spheres: what is written is read, and files that do not
// go together are refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>

#include "bernal/result/certify_levels.hpp"
#include "bernal/result/layers_table.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/packing_bytes.hpp"
#include "files/bytes_of_file.hpp"
#include "support/nests.hpp"

namespace bernal {
namespace nest_files_test {

using testing::expect_same;
using testing::Nested;
using testing::pebbles;

void rewrite(const std::filesystem::path& file, const std::function<void(std::string&)>& change) {
  std::string text = bytes_of_file(file);
  change(text);
  std::ofstream(file, std::ios::binary) << text;
}

TEST(NestFiles, HoldAllOfIt) {
  const Nested scenes;
  const Packing packing = scenes.packed();
  const testing::Folder out;
  const WrittenPacking written = write_packing(packing, out / "nest");
  EXPECT_TRUE(written.certificate.certified) << written.certificate.statement;
  const Packing read = read_packing(out / "nest");
  expect_same(packing, read);
  EXPECT_TRUE(certify_levels(read).certified);
  expect_same(packing, packing_of_bytes(bytes_of(packing)));
  // What is written makes the same again, and so does each packing inside by itself.
  expect_same(packing, run(build(read_scene(out / "nest/scene.toml"))));
  const Packing inner = run(build(read_scene(out / "nest/inside/pebble/template-002/scene.toml")));
  EXPECT_EQ(inner.spheres.x, packing.inside[0].templates[1]->spheres.x);
  // Of those inside, of which there may be many, no more than it takes.
  const auto inner_folder = out / "nest/inside/pebble/template-002";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(inner_folder))
    names.insert(entry.path().filename().string());
  EXPECT_EQ(names, (std::set<std::string>{"spheres.csv", "scene.toml", "report.json"}));
  EXPECT_NE(bytes_of_file(inner_folder / "report.json").find("\"not_measured\""), std::string::npos);
  // A second result takes the place of all of the first.
  const Packing plain = run(build(parse_scene(pebbles(""), "plain.toml")));
  write_packing(plain, out / "nest");
  EXPECT_FALSE(std::filesystem::exists(out / "nest/inside"));
  EXPECT_FALSE(std::filesystem::exists(out / "nest/nest.json"));
}

// How a run ended stands in no other file that is read.
TEST(NestFiles, OfRunsThatFellShortAreRead) {
  const Nested scenes("{ scene = \"inner.toml\", templates = 2 }",
                      "unit = \"cm\"\n[spheres]\ncount = 10\nradius = 1\n[[stage]]\ndo = \"insert\"\n");
  const Packing packing = scenes.packed();
  ASSERT_EQ(packing.outcome, Outcome::full) << packing.reason;
  const testing::Folder out;
  write_packing(packing, out / "nest");
  const Packing read = read_packing(out / "nest");
  expect_same(packing, read);
  for (std::size_t t = 0; t < 2; ++t)
    EXPECT_EQ(read.inside[0].templates[t]->outcome, packing.inside[0].templates[t]->outcome);
  EXPECT_TRUE(certify_levels(read).certified);
}

TEST(NestFiles, ThatDoNotGoTogetherAreRefused) {
  const Packing packing = Nested().packed();
  const auto refusal = [&](const std::function<void(const std::filesystem::path&)>& spoil) {
    const testing::Folder out;
    write_packing(packing, out / "nest");
    spoil(out / "nest");
    try {
      read_packing(out / "nest");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal([](const auto&) {}), "");
  EXPECT_NE(refusal([&](const auto& nest) {
              rewrite(nest / "inside/pebble/rotations.csv", [](std::string& text) {
                text.erase(text.rfind('\n', text.size() - 2) + 1);  // the last of its lines
              });
            }).find("nest.json"),
            std::string::npos);
  EXPECT_NE(refusal([](const auto& nest) {
              const auto inside = nest / "inside/pebble";
              std::filesystem::rename(inside / "template-001", inside / "other");
              std::filesystem::rename(inside / "template-002", inside / "template-001");
              std::filesystem::rename(inside / "other", inside / "template-002");
            }).find("inside[0].packings[0]"),
            std::string::npos);
  EXPECT_NE(refusal([&](const auto& nest) {
              rewrite(nest / "nest.json", [](std::string& text) {
                const std::string all = "\"spheres_of_all_levels\": ";
                text.insert(text.find(all) + all.size(), "1");
              });
            }).find("spheres_of_all_levels"),
            std::string::npos);
}

// As in the folder itself: said before the run, and only of what would be replaced.
TEST(NestFiles, OfAUserAreNotReplaced) {
  const Nested scenes("{ scene = \"inner.toml\", templates = 2 }",
                      std::string(testing::particles) + "[[output]]\nformat = \"extxyz\"\n");
  const Scene scene = read_scene(scenes.folder / "outer.toml");
  const Packing packing = scenes.packed();
  const auto refusal = [&](const std::filesystem::path& folder) {
    try {
      check_writable(folder, scene);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cannot_write);
      return std::string(error.what());
    }
    return std::string();
  };
  const testing::Folder out;
  const auto pebble = out / "inside/pebble";
  std::filesystem::create_directories(pebble / "template-001");
  std::filesystem::create_directories(pebble / "template-003");
  for (const char* name : {"rotations.csv", "template-001/spheres.csv", "template-001/report.html",
                           "template-001/extxyz.xyz", "template-001/nest.json", "template-002"}) {
    std::ofstream(pebble / name) << "mine";
    EXPECT_NE(refusal(out.path()).find((pebble / name).string() + ": is no result of bernal's"),
              std::string::npos)
        << name << ": " << refusal(out.path());
    EXPECT_EQ(bytes_of_file(pebble / name), "mine");
    std::filesystem::remove(pebble / name);
  }
  for (const char* name : {"notes.txt", "template-001/notes.txt", "template-003/spheres.csv"})
    std::ofstream(pebble / name) << "mine";
  EXPECT_EQ(refusal(out.path()), "");
  write_packing(packing, out.path());
  EXPECT_EQ(refusal(out.path()), "");  // an earlier result may go
  std::ofstream(pebble / "template-001/scene.toml", std::ios::app) << "# mine\n";
  EXPECT_NE(refusal(out.path()).find("template-001/scene.toml"), std::string::npos);
  const testing::Folder blocked;
  blocked.write("inside", "mine");
  EXPECT_NE(refusal(blocked.path()).find("inside: is no result"), std::string::npos)
      << refusal(blocked.path());
}

TEST(NestFiles, AStartSaysWhatItLeavesOut) {
  const testing::Folder out;
  write_packing(Nested().packed(), out / "nest");
  const auto notes_of = [&](const std::string& keys) {
    out.write(
        "again.toml",
        "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\nstart = \"nest\"\n" +
            keys + "[[stage]]\ndo = \"insert\"\n");
    std::string all;
    for (const std::string& hint : build(read_scene(out / "again.toml")).hints) all += hint;
    return all;
  };
  EXPECT_EQ(notes_of(""),
            "the start gives places and sizes of spheres alone; left out: what lies inside of them, their "
            "layers, their classes");
  EXPECT_EQ(
      notes_of("material = \"pebble\"\nlayers = [{ name = \"fuel\", radius = 2.5 }, { name = \"shell\" }]\n"),
      "the start gives places and sizes of spheres alone; left out: what lies inside of them");
}

TEST(NestFiles, TablesOfLayersAreHeldAgainstEveryLevel) {
  // Layers inside of spheres too, and drawn ones, so that a sphere's number matters.
  const Nested scenes(
      "{ scene = \"inner.toml\", templates = 2 }",
      "unit = \"mm\"\n[spheres]\ncount = 20\nradius = 1.5\nlayers = [{ name = \"kernel\" }, "
      "{ name = \"coat\", thickness = { distribution = \"normal\", mean = 0.2, sd = 0.02 } }]\n"
      "[[stage]]\ndo = \"insert\"\n");
  const testing::Folder out;
  const auto nest = out / "nest";
  write_packing(scenes.packed(), nest);
  const auto table = [&] { return layers_table_of(read_packing(nest), nest).value(); };
  EXPECT_EQ(table().fault, "");
  EXPECT_EQ(table().layers, 2U * (10 + 2 * 20));
  Certificate certificate;
  certificate.certified = true;
  add_to(certificate, table());
  EXPECT_TRUE(certificate.certified);
  EXPECT_NE(certificate.statement.find("100 layers"), std::string::npos) << certificate.statement;

  const auto inner = nest / "inside/pebble/template-002/layers.csv",
             other = nest / "inside/pebble/template-001/layers.csv";
  const std::string written = bytes_of_file(inner);
  std::ofstream(inner, std::ios::binary) << bytes_of_file(other);  // that of another packing
  EXPECT_NE(table().fault.find("template-002/layers.csv:3: says otherwise"), std::string::npos)
      << table().fault;
  add_to(certificate, table());
  EXPECT_FALSE(certificate.certified);
  EXPECT_TRUE(certificate.statement.starts_with("Not certified: ")) << certificate.statement;
  EXPECT_EQ(certificate.statement.find("Certified"), std::string::npos) << certificate.statement;
  for (const auto& file : {inner, nest / "layers.csv"}) {
    const std::string kept = bytes_of_file(file);
    std::ofstream(inner, std::ios::binary) << written;
    std::filesystem::remove(file);
    EXPECT_NE(table().fault.find(file.string() + " is missing"), std::string::npos) << table().fault;
    std::ofstream(file, std::ios::binary) << kept;
  }
  std::ofstream(inner, std::ios::binary) << written;
  EXPECT_EQ(table().fault, "");
  rewrite(nest / "layers.csv", [](std::string& text) { text.insert(text.rfind("3\n"), "1"); });
  EXPECT_NE(table().fault.find("layers.csv:22: "), std::string::npos) << table().fault;
}

}  // namespace nest_files_test
}  // namespace bernal
