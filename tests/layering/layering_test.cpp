// Fails on an include that the table in src/README.md forbids; and shows, on planted ones, that it would.
#include "layering.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace bernal::layering {
namespace {

namespace fs = std::filesystem;

const fs::path source = BERNAL_SOURCE;

TEST(Layering, NoRoomIncludesWhatItsRuleForbids) {
  const auto rules = read_rules(source / "src/README.md");
  ASSERT_GT(rules.size(), 10u) << "the table of rooms was not found";
  for (const std::string& violation : violations(source, rules)) ADD_FAILURE() << violation;
}

TEST(Layering, TheTableIsReadAsItIsMeant) {
  const auto rules = read_rules(source / "src/README.md");
  EXPECT_TRUE(rules.at("core").rooms.empty());
  EXPECT_TRUE(rules.at("domain").rooms.contains("kernels"));
  EXPECT_FALSE(rules.at("verify").rooms.contains("domain"));
  EXPECT_EQ(rules.at("verify").files.at("domain"), std::set<std::string>{"domain.hpp"});
  EXPECT_FALSE(rules.at("work").rooms.contains("run"));
  EXPECT_TRUE(rules.at("run").rooms.contains("settle"));
  EXPECT_FALSE(rules.at("run").rooms.contains("verify"));
  EXPECT_FALSE(rules.at("plan").rooms.contains("result"));
  EXPECT_TRUE(rules.at("plan").files.empty());
  EXPECT_TRUE(rules.at("cost").rooms.contains("verify"));
  EXPECT_FALSE(rules.at("cost").rooms.contains("apps"));
  EXPECT_TRUE(rules.at("apps").public_headers_only);
}

TEST(Layering, TheTableHasFewExceptions) {
  std::size_t exceptions = 0;
  for (const auto& [room, rule] : read_rules(source / "src/README.md"))
    for (const auto& [other, files] : rule.files) exceptions += files.size();
  EXPECT_LE(exceptions, 10u);
}

fs::path scratch() { return fs::temp_directory_path() / ("bernal_layering_" + std::to_string(getpid())); }

TEST(Layering, ARoomStandsBelowThoseThatItIncludes) {
  const fs::path readme = scratch().concat(".md");
  const auto rules_of = [&](const std::string& table) {
    std::ofstream(readme) << table;
    return read_rules(readme);
  };
  const std::string near = "| search | `near/` | trees | ", domain = "| shapes | `domain/` | walls | ";
  EXPECT_TRUE(rules_of(near + "nothing |\n" + domain + "near |\n").at("domain").rooms.contains("near"));
  EXPECT_THROW(rules_of(near + "domain |\n" + domain + "nothing |\n"), std::runtime_error);
  EXPECT_THROW(rules_of(near + "domain (boundary.hpp only) |\n" + domain + "near |\n"), std::runtime_error);
  EXPECT_THROW(rules_of(near + "near |\n"), std::runtime_error);
  EXPECT_THROW(rules_of(near + "the attic |\n"), std::runtime_error);
  fs::remove(readme);
}

TEST(Layering, TheLibraryDoesNotSpeakCommandLine) {
  for (const std::string& word : option_words(source)) ADD_FAILURE() << word;
}

/// What `look` finds in a source tree of one file.
template <class Look>
auto found_in(const std::string& file, const std::string& text, const Look& look) {
  const fs::path root = scratch();
  fs::create_directories((root / file).parent_path());
  std::ofstream(root / file) << text << '\n';
  const auto found = look(root);
  fs::remove_all(root);
  return found;
}

std::vector<std::string> violations_of(const std::string& file, const std::string& text) {
  const auto rules = read_rules(source / "src/README.md");
  return found_in(file, text, [&](const fs::path& root) { return violations(root, rules); });
}

TEST(Layering, PlantedOptionWordsAreFound) {
  const auto words_in = [](const std::string& text) {
    return found_in("src/core/a.cpp", text, &option_words);
  };
  EXPECT_EQ(words_in("\n// \"--no\"\nf('\"', \"a \\\" give --with-mesh\");").at(0),
            "src/core/a.cpp:3: --with-mesh");
  for (const char* text :
       {"f(\"--unit: {}\");", "f(\"(see --help)\");", "f(R\"(\"give --box\")\");", "f(\"by -o, or\");"})
    EXPECT_EQ(words_in(text).size(), 1u) << text;
  for (const char* text : {"--count;", "// give --unit", "/* \" */ --k; /* \" */", "f(\"mpi --mpi=pmix\");",
                           "f(\"{ --ink:#111; fill:var(--ink) }\");", "f(\"non-overlapping a--b\");"})
    EXPECT_TRUE(words_in(text).empty()) << text;
}

TEST(Layering, NoTwoClassesAreOneToTheLinker) {
  for (const std::string& doubled : doubled_classes(source)) ADD_FAILURE() << doubled;
}

TEST(Layering, PlantedClassesOfOneNameAreFound) {
  const auto found_with = [](const std::string& text) {
    const fs::path root = scratch();
    fs::create_directories(root / "src/b");
    std::ofstream(root / "src/b/b.hpp")
        << "namespace bernal {\nstruct Inside {\n};\n}  // namespace bernal\n";
    const auto found = found_in("src/a/a.cpp", text, &doubled_classes);
    fs::remove_all(root);
    return found;
  };
  EXPECT_EQ(found_with("namespace bernal {\nclass Inside final : Side {\n};\n}  // namespace bernal").at(0),
            "bernal::Inside: src/a/a.cpp, src/b/b.hpp");
  for (const char* text :
       {"namespace bernal {\nstruct Inside;\n}  // namespace bernal",
        "namespace bernal::voxels {\nclass Inside {\n};",
        "namespace bernal {\nnamespace {\nstruct Inside {\n};\n}  // namespace\n}  // namespace bernal"})
    EXPECT_TRUE(found_with(text).empty()) << text;
}

TEST(Layering, PlantedViolationsAreFound) {
  const std::pair<const char*, const char*> planted[] = {
      {"src/core/a.cpp", "#include \"bernal/domain/domain.hpp\""},
      {"src/core/a.cpp", "#  include <bernal/domain/domain.hpp>"},
      {"src/kernels/a.hpp", "#include \"bernal/domain/facet.hpp\""},
      {"src/domain/a.cpp", "#include \"cad/tree.hpp\""},
      {"src/verify/a.cpp", "#include \"bernal/domain/container.hpp\""},
      {"src/verify/a.cpp", "#include \"kernels/first_contact.hpp\""},
      {"src/verify/a.cpp", "#include \"near/cell_grid.hpp\""},
      {"src/settle/a.cpp", "#include \"bernal/run/run.hpp\""},
      {"src/run/a.cpp", "#include \"bernal/verify/certificate.hpp\""},
      {"src/predict/a.cpp", "#include \"bernal/domain/domain.hpp\""},
      {"src/domain/a.cpp", "#include <CGAL/AABB_tree.h>"},
      {"src/cad/a.hpp", "#include <assimp/scene.h>"},
      {"src/measure/a.cpp", "#include <CGAL/Regular_triangulation_3.h>"},
      {"include/bernal/cad/a.hpp", "#include <CGAL/AABB_tree.h>"},
      {"src/run/a.cpp", "#include \"cad/tree_traversals.hpp\""},
      {"include/bernal/run/a.hpp", "#include \"work/bed.hpp\""},
      {"apps/a.cpp", "#include \"core/philox.hpp\""},
      {"src/python/a.cpp", "#include \"core/philox.hpp\""},
      {"src/domain/a.cpp", "#include \"box.hpp\""},
      {"src/domain/a.cpp", "#include \"../core/philox.hpp\""},
      {"src/attic/a.cpp", ""},
  };
  for (const auto& [file, text] : planted)
    EXPECT_EQ(violations_of(file, text).size(), 1u) << file << ": " << text;
  EXPECT_EQ(violations_of("src/core/a.cpp", "\n\n#include \"cad/b.hpp\"").front(),
            "src/core/a.cpp:3: cad/b.hpp: core must not see it");
}

TEST(Layering, AllowedIncludesAreNotFound) {
  const std::pair<const char*, const char*> allowed[] = {
      {"src/core/a.cpp",
       "#include <vector>\n#include \"bernal/core/error.hpp\"\n#include \"core/philox.hpp\""},
      {"src/domain/a.cpp",
       "#include \"kernels/first_contact.hpp\"\n#include <boost/multiprecision/cpp_int.hpp>"},
      {"src/cad/a.cpp", "#include <CGAL/AABB_tree.h>\n#include <assimp/scene.h>"},
      {"src/cad/wall_tree.hpp", "#include <CGAL/AABB_tree.h>"},
      {"src/work/a.cpp", "#include \"bernal/scene/packing.hpp\""},
      {"src/verify/a.cpp", "#include \"bernal/domain/domain.hpp\""},
      {"src/run/a.cpp", "#include \"work/bed.hpp\"\n#include \"bernal/cad/read_mesh.hpp\""},
      {"src/python/a.cpp",
       "#include <pybind11/pybind11.h>\n#include \"bernal/run/run.hpp\"\n#include \"python/b.hpp\""},
      {"apps/a.cpp",
       "#include <CLI/CLI.hpp>\n#include \"bernal/verify/certificate.hpp\"\n#include \"a.cpp\""},
  };
  for (const auto& [file, text] : allowed) {
    for (const std::string& violation : violations_of(file, text)) ADD_FAILURE() << violation;
  }
}

}  // namespace
}  // namespace bernal::layering
