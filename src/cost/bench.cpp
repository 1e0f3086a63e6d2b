#include "bernal/cost/bench.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "core/input_file.hpp"
#include "core/parallel.hpp"
#include "cost/bench_tables.hpp"
#include "io/staged_folder.hpp"

namespace bernal {
namespace {

/// A table of its own.
struct BenchTable {
  Bench bench;
  cost::BenchFiles (*make)(const BenchOptions&);
};

/// A line a table.
const std::vector<BenchTable>& tables() {
  static const std::vector<BenchTable> all = {
      {{"methods", "every method on the same spheres: packing fraction over seconds", "5 minutes"},
       cost::methods},
      {{"effects", "every effect off and on: what it buys in packing fraction and costs in time",
        "2 minutes"},
       cost::effects},
      {{"arithmetic", "decisions about walls in double, filtered and exact", "a minute"},
       cost::bench_arithmetic}};
  return all;
}

void check_names(std::span<const std::string> names) {
  std::vector<std::string_view> known;
  for (const Bench& bench : all_benches()) known.push_back(bench.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw Error(ErrorCode::bad_argument,
                  fmt::format("there is no bench \"{}\"{}", name, remedy(name, known)));
}

/// The same, which reports so much of the whole.
BenchOptions part_of(const BenchOptions& options, double from, double to) {
  BenchOptions part = options;
  if (options.monitor.on_progress)
    part.monitor.on_progress = [=, whole = options.monitor](const Progress& progress) {
      const double share = progress.fraction < 0 ? progress.fraction : from + (to - from) * progress.fraction;
      whole.report({progress.activity, share, progress.detail});
    };
  return part;
}

std::string first_line_of(const std::filesystem::path& file) {
  InputFile in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

std::span<const Bench> all_benches() {
  static const auto all = [] {
    std::vector<Bench> list(cost::scenes_to_bench().begin(), cost::scenes_to_bench().end());
    for (const BenchTable& table : tables()) list.push_back(table.bench);
    return list;
  }();
  return all;
}

std::vector<BenchFile> run_benches(std::span<const std::string> names, const BenchOptions& options) {
  check_names(names);
  const auto is_named = [&](const Bench& bench) {
    return std::ranges::find(names, bench.name) != names.end() || (names.empty() && !bench.has_own_table());
  };
  std::vector<std::string_view> scenes;
  for (const Bench& bench : cost::scenes_to_bench())
    if (is_named(bench)) scenes.push_back(bench.name);
  std::vector<const BenchTable*> own;
  for (const BenchTable& table : tables())
    if (is_named(table.bench)) own.push_back(&table);

  const std::size_t parts = own.size() + (scenes.empty() ? 0 : 1);
  std::vector<BenchFile> files;
  try {
    const Interruptible listening(options.monitor);
    for (std::size_t k = 0; k < parts; ++k) {
      const BenchOptions part = part_of(options, static_cast<double>(k) / static_cast<double>(parts),
                                        static_cast<double>(k + 1) / static_cast<double>(parts));
      const bool of_scenes = k == own.size();
      const cost::BenchFiles made = of_scenes ? cost::bench_scenes(scenes, part) : own[k]->make(part);
      if (made.empty()) return {};
      files.insert(of_scenes ? files.begin() : files.end(), made.begin(), made.end());
    }
  } catch (const Cancelled&) {
    return {};
  }
  return files;
}

std::vector<std::filesystem::path> write_benches(const std::vector<BenchFile>& files,
                                                 const std::filesystem::path& folder) {
  if (files.empty()) return {};
  StagedFolder staged(folder);
  std::vector<std::string> earlier;
  for (const BenchFile& file : files) {
    if (first_line_of(folder / file.name) == file.text.substr(0, file.text.find('\n')))
      earlier.push_back(file.name);
    staged.write(file.name, file.text);
  }
  return staged.publish(earlier);
}

}  // namespace bernal
