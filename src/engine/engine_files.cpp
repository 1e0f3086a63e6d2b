#include "engine/engine_files.hpp"

#include <numbers>

#include <fmt/format.h>

#include "files/output_file.hpp"

namespace bernal::engine {
namespace {

/// Bytes of text that are put together before they are written.
constexpr std::size_t block = 1 << 20;

/// A file that takes the place of an older one.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path) : file_((remove(path), path)) {}

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() < block) return;
    file_.append({text_.data(), text_.size()});
    text_.clear();
  }
  void close() {
    file_.append({text_.data(), text_.size()});
    file_.close();
  }

 private:
  static void remove(const std::filesystem::path& path) {
    std::error_code gone;
    std::filesystem::remove(path, gone);
  }
  OutputFile file_;
  fmt::memory_buffer text_;
};

}  // namespace

const Dialect& dialect_of(const SceneEngine& engine) {
  static const Dialect lammps{.title = "LAMMPS",
                              .package = "lammps",
                              .executable = "lmp",
                              .script = "in.lammps",
                              .log = "log.lammps",
                              .atoms = "Atoms # sphere",
                              .wall_types = 0,
                              .script_of = lammps_script};
  static const Dialect liggghts{.title = "LIGGGHTS",
                                .package = "liggghts",
                                .executable = "liggghts",
                                .script = "in.liggghts",
                                .log = "log.liggghts",
                                .atoms = "Atoms",
                                .wall_types = 1,
                                .script_of = liggghts_script};
  return std::holds_alternative<Lammps>(engine) ? lammps : liggghts;
}

void write_data(const std::filesystem::path& path, const EngineTask& task, const Dialect& dialect) {
  const SizeClasses& classes = task.spheres.classes;
  const Bounds<3> region = region_of(task);
  NewFile file(path);
  file.add("# {} spheres\n\n{} atoms\n{} atom types\n\n", task.spheres.count, task.spheres.count,
           classes.count + dialect.wall_types);
  for (int k = 0; k < 3; ++k)
    file.add("{} {} {}lo {}hi\n", region.lower[k], region.upper[k], "xyz"[k], "xyz"[k]);
  file.add("\n{}\n\n", dialect.atoms);
  std::uint64_t id = 0;
  task.spheres.for_each([&](const Vector<3>& c, double r) {
    const double density = task.mass(r) / (4.0 / 3 * std::numbers::pi * r * r * r);
    file.add("{} {} {} {} {} {} {}\n", ++id, classes.of(r) + 1, 2 * r, density, c[0], c[1], c[2]);
  });
  file.close();
}

void write_walls_stl(const std::filesystem::path& path, const Mesh& mesh) {
  NewFile file(path);
  file.add("solid walls\n");
  for (const auto& triangle : mesh.triangles) {
    file.add("facet normal 0 0 0\n outer loop\n");
    for (const std::uint32_t corner : triangle) {
      const Vector<3>& p = mesh.vertices[corner];
      file.add("  vertex {} {} {}\n", p[0], p[1], p[2]);
    }
    file.add(" endloop\nendfacet\n");
  }
  file.add("endsolid walls\n");
  file.close();
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  NewFile file(path);
  file.add("{}", text);
  file.close();
}

}  // namespace bernal::engine
