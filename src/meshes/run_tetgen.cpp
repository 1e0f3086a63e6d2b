#include "meshes/tetgen.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "files/bytes_of_file.hpp"
#include "files/descriptor.hpp"
#include "process/child.hpp"
#include "process/find_program.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr std::uintmax_t smallest_room = 1 << 20;  // bytes
constexpr const char* log_name = "said.txt";
/// Vertices that TetGen puts in may come to lie in one plane with three others, which ends it by an assertion
/// of its own; with a slightly larger limit it puts in others.
constexpr int most_tries_again = 3;
constexpr double another_radius_over_edge = 1.01;
bool is_its_own_fault(const ChildEnd& end) { return end.signal == SIGABRT || end.signal == SIGSEGV; }

/// A folder for the mesher's files, which goes with this object.
class FolderOfMesher {
 public:
  FolderOfMesher() {
    std::error_code unknown;
    const fs::path in = fs::temp_directory_path(unknown);
    if (unknown)
      throw Error(ErrorCode::cannot_write,
                  "the folder for files in passing is not there: set TMPDIR to one that is",
                  {plain_text(std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp")});
    std::string name = (in / "bernal-mesh-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(ErrorCode::cannot_write, "no folder can be made for the mesher: is TMPDIR full?",
                  {in.string()});
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

std::vector<std::string> words_for(const TetgenOptions& options) {
  const fs::path tetgen = require_tetgen();
  std::vector<std::string> words;
  // Its lines are to be heard when it prints them, not when it ends.
  if (const fs::path stdbuf = program_at("stdbuf"); !stdbuf.empty()) words = {stdbuf.string(), "--output=L"};
  words.push_back(tetgen.string());
  // p: a surface; Y: it stays; M: coplanar triangles stay; A: parts that hang together are numbered; F: no
  // files of faces; J: vertices that no tetrahedron has stay; q: radius over edge and least angle; o:
  // dihedral angles above are optimised.
  words.push_back(fmt::format("-pYMAFJq{}/{}o/140", options.radius_over_edge, options.least_angle));
  words.push_back("packing.smesh");
  return words;
}

ChildEnd run_child(const TetgenOptions& options, const fs::path& folder, const Monitor& monitor) {
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
  if (fs::space(folder, unknown).available < smallest_room)
    throw Error(ErrorCode::cannot_write, "the disk is full: set TMPDIR to a folder with more room",
                {folder.parent_path().string()});
  throw Error(ErrorCode::bad_mesh, fmt::format("TetGen made no mesh ({}): {}",
                                               end.signal != 0 ? fmt::format("signal {}", end.signal)
                                                               : fmt::format("exit status {}", end.code),
                                               said.empty() ? "it said nothing" : end_of(said)));
}

}  // namespace

fs::path require_tetgen() {
  fs::path tetgen = program_at("tetgen");
  if (tetgen.empty())
    throw Error(ErrorCode::bad_argument,
                "meshes are made by the program \"tetgen\", which is not installed: apt-get install tetgen");
  return tetgen;
}

VolumeMesh run_tetgen(const ConformingSurface& surface, const TetgenOptions& options, double& peak_bytes,
                      const Monitor& monitor) {
  require_tetgen();  // before anything is written
  const FolderOfMesher folder;
  monitor.report({"fill", 0, "the surface for TetGen"});
  write_for_tetgen(surface, points_of_holes(surface), folder.path());
  TetgenOptions tried = options;
  ChildEnd end = run_child(tried, folder.path(), monitor);
  for (int again = 0; again < most_tries_again && is_its_own_fault(end); ++again) {
    tried.radius_over_edge *= another_radius_over_edge;
    end = run_child(tried, folder.path(), monitor);
  }
  peak_bytes = end.peak_bytes;
  require_done(end, folder.path());
  monitor.report({"fill", 0.95, "what TetGen left is read"});
  return read_from_tetgen(surface, folder.path());
}

}  // namespace bernal
