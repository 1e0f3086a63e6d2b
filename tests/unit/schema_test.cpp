#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "scene/output_table.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace schema_test {

using schema::Entry;
using schema::Key;
using schema::Type;
using testing::expect_equal;
using testing::with_spheres;
using testing::with_stage;

/// A file that any distribution accepts whose columns may stand in one.
std::string file_of_columns(std::string_view entry) {
  static const testing::Folder folder;
  static const auto list = folder.write("list.csv", "1\n0.30000000000000004\n3\n");
  static const auto sieve = folder.write("sieve.csv", "0, 0\n1, 5\n2, 50\n3, 100\n");  // with a pan
  static const auto table = folder.write("columns.csv", "1, 0\n2, 50\n3, 100\n");
  return fmt::format("\"{}\"", (entry == "list" ? list : entry == "sieve" ? sieve : table).string());
}

/// TOML that a key accepts.
std::string sample(const Key& key, int choice) {
  // Of a sieve with a pan: nothing lies on the coarsest.
  if (key.name == "sizes") return "[1, 2, 0]";
  if (key.name == "retained") return "[25.5, 0, 30]";
  if (key.name == "spacing") return "3";  // as that does, and no less than the spheres are wide
  if (key.name == "edges") return "[0.3, 1, 2, 1e3]";
  if (key.type == Type::length && key.is_diameter && key.name != "d43" && key.name != "d32")
    return fmt::format("10.{:0>2}", key.name.substr(1));  // D10 = 10.10, and so on: they ascend, near any law
  switch (key.type) {
    case Type::flag:
      return "true";
    case Type::integer:
      return choice == 0 || key.name == "dimension"
                 ? "3"
                 : fmt::format("{}", static_cast<std::int64_t>(key.range.min));
    case Type::number:
      if (key.range.min > 0.1) return fmt::format("{}", key.range.min + 0.1);
      return choice == 0 ? "0.1" : "0.30000000000000004";
    case Type::length:  // keys come in the order min, max and d43, d32
      return key.name == "max" || key.name == "d43" ? "2.5e3" : "0.1";
    case Type::word: {
      std::vector<std::string> said;
      for (const std::string_view word : key.words) said.push_back(fmt::format("\"{}\"", word));
      std::erase(said, key.unsaid);
      return said[choice % said.size()];
    }
    case Type::file:
      return choice == 0 ? "\"part.stl\"" : "'''/tmp/a \"strange\" \\ name.stl'''";
    case Type::direction:  // along an axis, as columns need it
      return choice == 0 ? "[0, -1e-5, 0]" : "[4.000000000000001, 0, 0]";
    case Type::push:
      return choice == 0 ? "[0, -1e-5, 0]" : "[4.000000000000001, 0, 0]";
    case Type::corner:
      return choice == 0 ? "[0, -1, 1e-5]" : "[3, 4.000000000000001, 0]";
    case Type::points:
      return "[[0, 0], [9, -1e-5], [0, 9.000000000000002]]";
    case Type::lines:
      return choice == 0 ? "[[[1, 1], [2, 1], [1, 2]]]"
                         : "[[[1, 1], [2, 1], [1, 2]], [[3, 3], [4, 3], [3, 4]]]";
    case Type::coordinates:  // of no key, only of columns
      return "[1, -2, 0]";
    case Type::position:
      return choice == 0 ? "[0, -1, 1e-5]" : "[3, 4.000000000000001, 0]";
    case Type::extents:
      return "[1, 2.5, 1e-9]";
    case Type::lengths:
      return "[1, 2, 0.3]";
    case Type::shares:
      return "[30, 70, 1e3]";
    case Type::amounts:  // of the sizes 1, 2, 0.3: a sieve's passing may not fall
      return "[25.5, 100, 0]";
    case Type::axes:
      return "[0]";
    case Type::text:
      return choice == 0 ? "\"sand\"" : "\"glass of 3 mm\"";
    case Type::names:
      if (key.name.ends_with("sha256"))
        return fmt::format("[\"{}\"]", std::string(64, choice == 0 ? '0' : 'F'));
      if (key.name == "names") return "[\"sand\", \"a \\\"b\\\"\", \"c\"]";  // one for each of three
      if (!key.words.empty()) return fmt::format("[\"{}\"]", key.words[choice % key.words.size()]);
      return choice == 0 ? "[\"first\", \"second one\"]" : "[\"/tmp/3\"]";
    case Type::parts:
      return choice == 0 ? "[1, { distribution = \"fuller\", max = 2, min = 0.1 }, 3]"
                         : "[1, 2, { distribution = \"mixture\", of = [1, 2], shares = [1, 2] }]";
    case Type::distribution:
      return "1";
    case Type::solids:
      return choice == 0 ? "[\"part.stl\", { kind = \"sphere\", radius = 0.1 }]" : "[\"/tmp/a.stl\"]";
    case Type::table:
      return choice == 0 ? "{ volume = 2.5, rounds = 1 }"
                         : "{ diameter = { distribution = \"uniform\", min = 1, max = 2 } }";
    case Type::tables:
      if (key.name == "inside")
        return choice == 0 ? "[{ scene = \"inner.toml\" }]"
                           : "[{ scene = \"/tmp/a \\\"b\\\".toml\", templates = 3 }]";
      return choice == 0 ? "[{ name = \"core\" }]"
                         : "[{ name = \"core\", material = \"UO2\", material_density = 10800 }, "
                           "{ name = \"shell\", share = 0.30000000000000004 }]";
    case Type::table_lists:  // one for each of three
      return "[[{ name = \"core\" }, { name = \"shell\", thickness = { distribution = \"normal\", "
             "mean = 0.01, sd = 0.001, max = 0.012 } }], [], [{ name = \"core\" }]]";
  }
  return "";
}

/// A file of the points of a polygon.
std::string file_of_points() {
  static const testing::Folder folder;
  static const auto file = folder.write("points.csv", "x, y\n0, 0\n9, 0\n0, 9\n");
  return fmt::format("\"{}\"", file.string());
}

std::string sample_of(const Entry& entry, const Key& key, int choice) {
  const auto has_points = [](const Key& other) { return other.type == Type::points; };
  if (key.type == Type::file && std::ranges::any_of(entry.keys, has_points)) return file_of_points();
  if (key.name == "radii") return choice == 0 ? "[2, 0]" : "[1e-5, 3.0000000000000004]";
  if (key.name == "inner_radius") return "0.05";
  if (key.name == "values" && entry.find("material")) return "\"fraction\"";  // which has that
  if (key.name == "surface" && entry.find("layer")) return "\"spheres\"";     // which have layers
  if (key.name == "rounding") return "1e-10";                                 // of a box that is 1e-9 thick
  for (const OutputTable* format : output_tables())
    if (&format->keys == &entry && key.type == Type::file)
      return choice == 0 ? "\"mine.x\"" : "'a \"b\" \\c'";
  // With which every other key acts.
  if (key.name == "top") return "\"heap\"";
  if (key.name == "layout") return "\"sc\"";  // which fits into the periods of 9
  for (const OutputTable* format : output_tables())
    if (&format->keys == &entry && key.name == "contact")
      return format->has_bridges() ? "\"bridge\"" : choice == 0 ? "\"gap\"" : "\"shrink\"";
  return key.type == Type::file && !entry.columns.empty() ? file_of_columns(entry.name) : sample(key, choice);
}

/// All keys of an entry that go with the n-th set of its choices.
std::vector<Key> keys_of(const Entry& entry, std::size_t n) {
  std::vector<Key> keys = entry.keys;
  if (entry.find("periodic") && entry.find("obstacles"))  // which exclude each other
    std::erase_if(keys, [&](const Key& k) {
      return n % 2 == 0 ? k.name == "periodic" : k.name == "obstacles" || k.name == "rounding";
    });
  if (entry.find("tilt") && entry.find("walls"))  // so do these
    std::erase_if(keys, [&](const Key& k) { return k.name == (n % 2 == 0 ? "tilt" : "walls"); });
  for (const schema::Choice& choice : entry.choices)
    for (std::size_t i = 0; i < choice.size(); ++i)
      if (i != n % choice.size())
        for (const std::string_view name : choice[i])
          std::erase_if(keys, [&](const Key& k) {
            const auto& chosen = choice[n % choice.size()];
            const bool is_needed = k.required && std::ranges::find(chosen, name) != chosen.end();
            return k.name == name && !is_needed;
          });
  // A tilt is a length beside lengths, which "proportions" of a box that follows are not.
  if (std::ranges::any_of(keys, [](const Key& k) { return k.name == "tilt"; }) &&
      std::ranges::none_of(keys, [&](const Key& k) { return k.name == "size" || k.name == "edge"; }))
    std::erase_if(keys, [](const Key& k) { return k.name == "tilt"; });
  return keys;
}

/// Calls `visit` for a stage wherever it works, with the keys that act there and go with the n-th set of its
/// choices.
template <class Visit>
void visit_stage(const StageTable& stage, std::size_t n, Visit visit) {
  const Scene container = parse_scene(with_spheres("radius = 1"), "s.toml");
  Scene box = container;
  box.container = PeriodicBox{};
  for (const Scene& where : {container, box}) {
    if (!stage.traits.works_in(where)) continue;
    std::vector<Key> keys = keys_of(stage.keys, n);
    std::erase_if(keys, [&](const Key& key) { return !key.acts_here(stage.traits.stands_in_bed(where)); });
    visit(stage.keys, keys, [&](const std::vector<std::string>& lines) {
      const std::string body = fmt::format("do = \"{}\"\n{}", stage.name(), fmt::join(lines, "\n"));
      const char* edge = stage.name() == "insert" ? "edge = 9\n" : "";  // of a crystal
      return where.is_periodic() ? fmt::format(
                                       "[container]\nkind = \"periodic\"\n{}[spheres]\ncount = 9\nradius = "
                                       "1\n[[stage]]\n{}\n",
                                       edge, body)
                                 : with_stage(body);
    });
  }
}

/// Calls `visit(keys, text_of_value → scene)` for every entry of the schema and every set of its choices.
template <class Visit>
void for_every_entry(Visit visit) {
  const auto joined = [](const std::vector<std::string>& parts, const char* with) {
    return fmt::format("{}", fmt::join(parts, with));
  };
  for (std::size_t n = 0; n < 6; ++n) {
    for (const Entry& e : schema::container_entries())
      visit(e, keys_of(e, n), [&](const std::vector<std::string>& lines) {
        return fmt::format(
            "unit = \"mm\"\n[container]\nkind = \"{}\"\n{}\n[spheres]\ncount = 5\nradius = 1\n", e.name,
            joined(lines, "\n"));
      });
    for (const Entry& e : schema::size_entries())
      visit(e, keys_of(e, n), [&](const std::vector<std::string>& lines) {
        return with_spheres(
            fmt::format("diameter = {{ distribution = \"{}\", {} }}", e.name, joined(lines, ", ")));
      });
    for (const StageTable* stage : stage_tables()) visit_stage(*stage, n, visit);
    for (const OutputTable* format : output_tables())
      visit(format->keys, keys_of(format->keys, n), [&](const std::vector<std::string>& lines) {
        // Of layers that the samples of names call so.
        return with_spheres(fmt::format(
            "radius = 1\nlayers = [{{ name = \"sand\" }}, {{ name = \"glass of 3 mm\", share = 0.5 }}]\n"
            "[[output]]\nformat = \"{}\"\n{}",
            format->name(), joined(lines, "\n")));
      });
    visit(schema::scene_entry(), keys_of(schema::scene_entry(), n),
          [&](const std::vector<std::string>& lines) {
            return joined(lines, "\n") + "\n" + with_spheres("radius = 1");
          });
    for (const bool periodic : {false, true}) {
      std::vector<Key> keys = keys_of(schema::spheres_entry(), n);
      const bool is_open = std::ranges::none_of(keys, [](const Key& key) {
        return key.name == "count" || key.name == "packing_fraction" || key.name == "height" ||
               key.name == "bed_layers";
      });
      const bool of_cells = std::ranges::find(keys, "cells", &Key::name) != keys.end();
      if (of_cells && !periodic) continue;  // they are of boxes
      std::erase_if(keys, [&](const Key& key) {
        if (of_cells && (key.name == "scale" || key.name == "draw" || key.name == "fill" ||
                         key.name == "mass" || key.name.starts_with("start")))
          return true;
        const bool of_heap = key.name == "top" || key.name == "heap_angle";
        const bool of_bed = of_heap || key.name == "bed" || key.name == "porosity" || key.name == "height" ||
                            key.name == "bed_layers";
        if (key.name == "start_box") return !periodic;
        if (key.name == "bulk_density") return true;    // becomes a porosity, see amounts_test.cpp
        return periodic ? of_bed : is_open && of_heap;  // no heap fills its container, no bed a period
      });
      visit(schema::spheres_entry(), keys, [&](const std::vector<std::string>& lines) {
        return periodic ? "[container]\nkind = \"periodic\"\nedge = 9\n[spheres]\n" + joined(lines, "\n")
                        : with_spheres(joined(lines, "\n"));
      });
    }
    visit(schema::accuracy_entry(), keys_of(schema::accuracy_entry(), n),
          [&](const std::vector<std::string>& lines) {
            return with_spheres("radius = 1\n[accuracy]\n" + joined(lines, "\n"));
          });
  }
}

TEST(SchemaLaw, EveryKeyIsReadAndSurvivesBeingWritten) {
  int scenes = 0;
  for_every_entry([&](const Entry& entry, const std::vector<Key>& keys, const auto& scene_with) {
    for (const int choice : {0, 1}) {
      std::vector<std::string> lines;
      for (const Key& key : keys)
        lines.push_back(fmt::format("{} = {}", key.name, sample_of(entry, key, choice)));
      SCOPED_TRACE(scene_with(lines));
      const Scene scene = parse_scene(scene_with(lines), "s.toml");
      EXPECT_FALSE(entry.help.empty());
      const std::string written = scene_as_toml(scene);
      for (const Key& key : keys) {
        EXPECT_TRUE(!key.member.set || written.find(fmt::format("{} = ", key.name)) != written.npos)
            << key.name << " is lost in\n"
            << written;
      }
      expect_equal(scene, parse_scene(written, "s.toml"));
      EXPECT_EQ(scene_as_toml(parse_scene(written, "s.toml")), written);
      ++scenes;
    }
  });
  EXPECT_GT(scenes, 60);
}

TEST(SchemaLaw, EveryKeyRefusesAWrongTypeByName) {
  for_every_entry([&](const Entry& entry, const std::vector<Key>& keys, const auto& scene_with) {
    for (const Key& wrong : keys) {
      std::vector<std::string> lines;
      for (const Key& key : keys)
        lines.push_back(
            fmt::format("{} = {}", key.name, &key == &wrong ? "1979-05-27" : sample_of(entry, key, 0)));
      SCOPED_TRACE(scene_with(lines));
      try {
        parse_scene(scene_with(lines), "s.toml");
        ADD_FAILURE() << "was accepted";
      } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(fmt::format("\"{}\"", wrong.name)), std::string::npos) << what;
        EXPECT_NE(what.find("not a date or time"), std::string::npos) << what;
        EXPECT_FALSE(wrong.help.empty());
      }
    }
  });
}

TEST(SchemaLaw, EveryDefaultIsAcceptedByItsKey) {
  for_every_entry([](const Entry& entry, const std::vector<Key>& keys, const auto&) {
    for (const Key& key : keys) {
      const auto otherwise = key.of(entry.defaults.get());
      EXPECT_TRUE(key.required || !otherwise || schema::accepts(key, *otherwise))
          << entry.name << " " << key.name;
    }
  });
}

}  // namespace schema_test
}  // namespace bernal
