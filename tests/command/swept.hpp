#pragma once
#include <sys/stat.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "check.hpp"

namespace bernal::testing {
namespace sweep_command_test {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* tiny_bed = R"(unit = "mm"
[container]
kind = "periodic"
[spheres]
count = 30
diameter = { distribution = "lognormal", median = 1.0, sigma = 0.3 }
[[stage]]
do = "relax"
)";

constexpr const char* six_cells = R"(scene = "bed.toml"
[grid]
spheres.diameter.sigma = [0.1, 0.3]
seed = { from = 1, to = 3 }
)";

/// A line of results.csv by the names of its columns; no cell of these tests is quoted.
using Row = std::map<std::string, std::string>;
inline std::vector<Row> rows_of(const fs::path& folder) {
  std::istringstream lines(text_of(folder / "results.csv"));
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line + ",");
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size() && k < cells.size(); ++k) row[names[k]] = cells[k];
  }
  return rows;
}

/// A sweep of the bed above and the folder that it writes.
struct Swept {
  Folder folder;
  std::string sweep, out;

  explicit Swept(const std::string& text = six_cells, std::string bed = tiny_bed) {
    folder.write("bed.toml", bed);
    sweep = folder.write("sweep.toml", text).string();
    out = (folder / "out").string();
  }
  std::vector<std::string> call(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"sweep", sweep, "-o", out});
    return more;
  }
  Ended run(const std::vector<std::string>& more = {}) const { return bernal(call(more)); }
  json report(std::vector<std::string> more = {}, int status = 0) const {
    more.emplace_back("--json");
    const Ended ended = run(more);
    EXPECT_EQ(ended.status, status) << ended.err;
    return json::parse(ended.out);
  }
  std::vector<Row> rows() const { return rows_of(out); }
  /// The reports that are there, with what tells a file from one that was written again.
  std::map<std::string, std::pair<ino_t, std::int64_t>> reports() const {
    std::map<std::string, std::pair<ino_t, std::int64_t>> all;
    if (!fs::exists(out + "/cells")) return all;
    for (const auto& entry : fs::directory_iterator(out + "/cells")) {
      struct stat info {};
      if (::stat((entry.path() / "report.json").c_str(), &info) == 0)
        all[entry.path().filename().string()] = {info.st_ino,
                                                 info.st_mtim.tv_sec * 1000000000 + info.st_mtim.tv_nsec};
    }
    return all;
  }
  bool wait_for(std::size_t reports_there) const {
    for (int k = 0; k < 6000; ++k) {
      if (reports().size() >= reports_there) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
};

}  // namespace sweep_command_test
}  // namespace bernal::testing
