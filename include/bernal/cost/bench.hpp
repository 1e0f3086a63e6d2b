#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"

namespace bernal {

/// Something whose time is measured, by name: a scene that is built in, which is a line of the common table,
/// or a table of its own.
struct Bench {
  std::string_view name;  ///< "relax", …, "methods"
  std::string_view what;  ///< one line
  std::string_view takes =
      {};  ///< of what has a table of its own, which runs only where it is named: "4 min"

  bool has_own_table() const { return !takes.empty(); }
};
std::span<const Bench> all_benches();

struct BenchOptions {
  /// Spheres of every packing; 0: as many as each bench says. Times grow with them.
  std::int64_t spheres = 0;
  /// Of the table of arithmetic, in all; 0: a million, which take less than a minute.
  std::int64_t decisions = 0;
  std::uint64_t seed = 1;  ///< the first, where several packings are made
  Monitor monitor = {};
};

/// A table as Markdown, the numbers behind it as CSV, a picture as SVG.
struct BenchFile {
  std::string name, text;
};

/// Runs those benches in one thread, all scenes where none is named. Returns bench.md and bench.csv of the
/// scenes, then of each table NAME.md, NAME.csv and its pictures; nothing where the monitor stopped it. Times
/// are those of the processor, so that whoever computes beside it counts less. Throws Error{bad_argument} for
/// another name, and where something is packed that is not certified.
std::vector<BenchFile> run_benches(std::span<const std::string> names, const BenchOptions& options = {});

/// Writes them into `folder`, all or none; returns where they are. A file of such a name that begins
/// otherwise is somebody else's and is kept under another name. Throws Error{cannot_write}.
std::vector<std::filesystem::path> write_benches(const std::vector<BenchFile>& files,
                                                 const std::filesystem::path& folder);

}  // namespace bernal
