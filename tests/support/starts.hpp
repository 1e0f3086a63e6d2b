#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "result/write_csv.hpp"
#include "support/written_files.hpp"

// What tests of packings that start from spheres share.
namespace bernal::testing::starts {

/// A scene in a folder, beside the files that it starts from.
class StartFixture : public ::testing::Test {
 protected:
  Scene scene(const std::string& toml) const { return read_scene(folder.write("scene.toml", toml)); }
  Packing packed(const std::string& toml, int threads = 1) const {
    return run(build(scene(toml)), {.threads = threads});
  }
  /// What is wrong with it, on one line that names a file.
  std::string refusal(const std::string& toml) const {
    const Error error = error_of([&] { packed(toml); });
    EXPECT_FALSE(error.location().file.empty()) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  void write(const std::string& name, const Spheres<dynamic>& spheres, double radii = 1) const {
    Spheres<dynamic> written = spheres;
    for (double& r : written.r) r *= radii;
    std::filesystem::remove(folder / name);
    OutputFile file(folder / name);
    write_csv(file, spheres_in(written, Unit::m));
    file.close();
  }

  Folder folder;
};

inline const std::string box = "[container]\nkind = \"box\"\nsize = [8.0, 8.0, 8.0]\n";
inline const std::string two = "x,y,z,r\n2,2,2,0.5\n4,4,6,1\n";
inline const std::string from_two = "[spheres]\nstart = \"two.csv\"\n";
inline std::string stage(const std::string& name, const std::string& more = "") {
  return "[[stage]]\ndo = \"" + name + "\"\n" + more;
}
inline std::string periodic(double edge, const std::string& more = "") {
  return fmt::format("[container]\nkind = \"periodic\"\nedge = {}\n{}", edge, more);
}
inline std::string periodic_of(const Packing& packing, const std::string& more = "") {
  const Vector<dynamic> edges = bounds_of<dynamic>(packing.domain).size();
  return fmt::format("[container]\nkind = \"periodic\"\ndimension = {}\nsize = [{}]\n{}", edges.size(),
                     fmt::join(edges, ", "), more);
}

inline void expect_certified(const Packing& packing) {
  const Certificate certificate =
      certify(packing.spheres, packing.domain, {.allowed_overlap = packing.scene.overlap});
  EXPECT_TRUE(certificate.certified) << certificate.statement;
}

/// What a run leaves that is told to stop when it asks for so many times, on one thread.
inline Packing stopped_after(const Plan& plan, int polls) {
  Monitor monitor;
  monitor.cancelled = [&] { return polls-- <= 0; };
  return run(plan, {.seed = {}, .threads = 1, .monitor = monitor});
}

/// Random close packing of few spheres, as another program might leave it.
inline Packing relaxed(int dimension, int count, const std::string& sizes = "radius = 1.0\n") {
  return run(
      build(parse_scene(fmt::format("[container]\nkind = \"periodic\"\ndimension = {}\n[spheres]\ncount = "
                                    "{}\n{}[[stage]]\ndo = \"relax\"\nalpha = 2\n",
                                    dimension, count, sizes),
                        "test.toml")),
      {.threads = 1});
}

}  // namespace bernal::testing::starts
