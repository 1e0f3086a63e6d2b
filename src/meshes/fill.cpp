#include "meshes/fill.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "core/disjoint_sets.hpp"
#include "files/bytes_of_file.hpp"
#include "files/descriptor.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/triangle_sides.hpp"
#include "process/child.hpp"
#include "process/find_program.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr const char* log_name = "said.txt";
constexpr double most_volume_error = 1e-10;

/// A folder for the mesher's files, which goes with this object.
class FolderOfMesher {
 public:
  FolderOfMesher() {
    std::string name = (fs::temp_directory_path() / "bernal-mesh-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(ErrorCode::cannot_write, "no folder can be made for the mesher: is TMPDIR full?",
                  {fs::temp_directory_path().string()});
    path_ = name;
  }
  ~FolderOfMesher() {
    std::error_code gone;
    fs::remove_all(path_, gone);
  }
  FolderOfMesher(const FolderOfMesher&) = delete;
  FolderOfMesher& operator=(const FolderOfMesher&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What TetGen prints where a step begins, and the share of its time that has then gone by.
struct Step {
  std::string_view says, name;
  double fraction;
};
constexpr std::array<Step, 6> steps = {{{"Delaunizing vertices", "tetrahedra of the vertices", 0.05},
                                        {"Creating surface mesh", "the surface", 0.5},
                                        {"Recovering boundaries", "the surface among them", 0.55},
                                        {"Removing exterior", "what is outside", 0.7},
                                        {"Refining mesh", "vertices within", 0.75},
                                        {"Optimizing mesh", "better tetrahedra", 0.9}}};

const Step* step_of(const std::string& said) {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
    if (said.find(step->says) != std::string::npos) return &*step;
  return nullptr;
}

/// The last lines of what it said, in one.
std::string end_of(const std::string& said) {
  constexpr std::size_t most = 300;
  std::string text = said.substr(said.size() - std::min(said.size(), most));
  std::ranges::replace(text, '\n', ' ');
  return plain_text(text);
}

std::vector<std::string> words_for(const TetrahedraOptions& options) {
  const fs::path tetgen = program_at("tetgen");
  if (tetgen.empty())
    throw Error(ErrorCode::bad_argument,
                "meshes are made by the program \"tetgen\", which is not installed: apt-get install tetgen");
  std::vector<std::string> words;
  // Its lines are to be heard when it prints them, not when it ends.
  if (const fs::path stdbuf = program_at("stdbuf"); !stdbuf.empty()) words = {stdbuf.string(), "--output=L"};
  words.push_back(tetgen.string());
  // p: a surface; Y: it stays; M: coplanar triangles stay; A: parts that hang together are numbered; F: no
  // files of faces; q: radius over edge and least angle; o: dihedral angles above are optimised.
  words.push_back(fmt::format("-pYMAFq{}/{}o/140", options.radius_over_edge, options.least_angle));
  words.push_back("packing.smesh");
  return words;
}

ChildEnd run_mesher(const TetrahedraOptions& options, const fs::path& folder, const Monitor& monitor) {
  constexpr std::chrono::milliseconds between_looks(50);
  constexpr std::chrono::seconds patience(1);
  const std::vector<std::string> words = words_for(options);
  const fs::path said = folder / log_name;
  const Descriptor output(::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!output.is_open())
    throw Error(ErrorCode::cannot_write, fmt::format("cannot be written: {}", strerror(errno)),
                {said.string()});
  try {
    Child child = start({.words = words,
                         .folder = folder,
                         .output = output.number(),
                         .errors = output.number(),
                         .apart = true});
    for (;; std::this_thread::sleep_for(between_looks)) {
      if (const auto end = child.ended()) return *end;
      if (monitor.stop()) {
        child.stop(patience);
        throw Cancelled();
      }
      if (const Step* step = step_of(bytes_of_file(said)))
        monitor.report({"fill", step->fraction, fmt::format("TetGen: {}", step->name)});
    }
  } catch (const std::system_error& failed) {
    throw Error(ErrorCode::bad_argument,
                fmt::format("\"{}\" cannot be started: {}", words[0], failed.code().message()));
  }
}

void require_done(const ChildEnd& end, const fs::path& folder) {
  const std::string said = bytes_of_file(folder / log_name);
  std::error_code unknown;
  const bool left_mesh =
      fs::exists(folder / "packing.1.ele", unknown) && fs::exists(folder / "packing.1.node", unknown);
  if (end.code == 0 && end.signal == 0 && left_mesh) return;
  if (end.signal == SIGKILL)
    throw Error(ErrorCode::bad_mesh,
                fmt::format("TetGen was killed at {:.1f} GB of memory; fewer and larger triangles need less",
                            end.peak_bytes / 1e9));
  throw Error(ErrorCode::bad_mesh, fmt::format("TetGen made no mesh: {}", end_of(said)));
}

double volume_error(const VolumeMesh& mesh, const ConformingSurface& surface) {
  const std::vector<double> found = volumes_of_regions(mesh), wanted = volumes_between(surface);
  double error = 0;
  for (std::size_t r = 0; r < found.size(); ++r) {
    const double off = std::abs(found[r] - wanted[r]) / std::abs(wanted[r]);
    if (!(off <= most_volume_error && wanted[r] > 0))
      throw Error(ErrorCode::bad_mesh,
                  fmt::format("a region of the mesh has the volume {:.9g}, and between its triangles it is "
                              "{:.9g}: is the surface closed?",
                              found[r], wanted[r]));
    error = std::max(error, off);
  }
  return error;
}

}  // namespace

std::vector<Vector<3>> points_of_holes(const ConformingSurface& surface) {
  constexpr double into = 0.02;  // of an edge
  const auto is_wall = [&](std::size_t t) {
    return surface.patches[surface.patch[t]].kind == SurfacePatch::Kind::wall;
  };
  // Walls stand around something in the domain where they enclose a negative volume, bridges' feet left out.
  DisjointSets walls(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_wall(t))
      for (const std::size_t k : {1, 2}) walls.unite(surface.triangles[t][0], surface.triangles[t][k]);
  std::map<std::uint32_t, Bounds<3>> bounds;
  const auto wall_of = [&](std::size_t t) { return walls.find(surface.triangles[t][0]); };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_wall(t))
      for (const std::uint32_t c : surface.triangles[t])
        bounds.try_emplace(wall_of(t), Bounds<3>::of_nothing()).first->second.add(surface.vertices[c]);
  std::map<std::uint32_t, double> volume;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!is_wall(t)) continue;
    const FaceCorners& c = surface.triangles[t];
    const Vector<3> middle = bounds.at(wall_of(t)).center();
    volume[wall_of(t)] += (surface.vertices[c[0]] - middle)
                              .dot((surface.vertices[c[1]] - middle).cross(surface.vertices[c[2]] - middle));
  }
  const auto is_hole = [&](std::size_t t) {
    const SurfacePatch& patch = surface.patches[surface.patch[t]];
    if (patch.kind == SurfacePatch::Kind::wall) return volume.at(wall_of(t)) < 0;
    return patch.kind != SurfacePatch::Kind::period_end &&
           std::ranges::find(patch.regions, SurfacePatch::nothing) != patch.regions.end();
  };
  DisjointSets parts(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (is_hole(t))
      for (const std::size_t k : {1, 2}) parts.unite(surface.triangles[t][0], surface.triangles[t][k]);
  struct Largest {
    double area = 0;
    Vector<3> point = Vector<3>::Zero();
  };
  std::map<std::uint32_t, Largest> of_part;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!is_hole(t)) continue;
    const FaceCorners& c = surface.triangles[t];
    const Vector<3>&a = surface.vertices[c[0]], &b = surface.vertices[c[1]], &d = surface.vertices[c[2]];
    const Vector<3> normal = (b - a).cross(d - a);
    const double area = normal.norm();
    Largest& largest = of_part[parts.find(c[0])];
    if (area <= largest.area) continue;
    const bool is_behind = surface.patches[surface.patch[t]].regions[0] == SurfacePatch::nothing;
    const double far = into * std::sqrt(area);
    largest = {area, (a + b + d) / 3 + (is_behind ? -far : far) * (normal / area)};
  }
  std::vector<Vector<3>> points;
  for (const auto& [part, largest] : of_part) points.push_back(largest.point);
  return points;
}

VolumeMesh fill(const ConformingSurface& surface, const TetrahedraOptions& options, FillReport& report,
                const Monitor& monitor) {
  const Stopwatch watch;
  words_for(options);  // before anything is written
  VolumeMesh mesh;
  {
    const FolderOfMesher folder;
    monitor.report({"fill", 0, "the surface for TetGen"});
    write_for_tetgen(surface, points_of_holes(surface), folder.path());
    const ChildEnd end = run_mesher(options, folder.path(), monitor);
    report.peak_bytes = end.peak_bytes;
    require_done(end, folder.path());
    monitor.report({"fill", 0.95, "what TetGen left is read"});
    mesh = read_from_tetgen(surface, folder.path());
  }
  report.seconds = watch.seconds();
  const Stopwatch improving;
  report.improvements = improve(mesh, {.goal = options.goal}, monitor);
  report.seconds_improving = improving.seconds();
  sides_of_triangles(mesh);  // which throws unless the surface is kept
  report.volume_error = volume_error(mesh, surface);
  return mesh;
}

}  // namespace bernal
