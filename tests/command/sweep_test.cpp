// bernal sweep as users call it: to the end, interrupted, killed, side by side, and by the script for Slurm.
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <thread>

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
std::vector<Row> rows_of(const fs::path& folder) {
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

/// The processes that a process has started.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != name.npos) continue;
    std::ifstream in(entry.path() / "stat");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t end = text.rfind(')');
    if (end == text.npos || end + 4 >= text.size()) continue;
    if (std::atoi(text.c_str() + end + 4) == parent) found.push_back(std::atoi(name.c_str()));
  }
  return found;
}

TEST(SweepCommand, RunsAllCellsOnceAndAnswersInOneTable) {
  const Swept swept;
  const Ended ended = swept.run();
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, swept.out + "/results.csv\n" + swept.out + "/results.svg\n");
  const std::vector<Row> rows = swept.rows();
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Row row = rows[k];
    EXPECT_EQ(row["cell"], std::to_string(k + 1));
    EXPECT_EQ(row["spheres.diameter.sigma"], k < 3 ? "0.1" : "0.3");
    EXPECT_EQ(row["seed"], std::to_string(k % 3 + 1));
    EXPECT_EQ(row["outcome"], "converged") << row["reason"];
    EXPECT_EQ(row["certified"], "true");
    const json report = report_of(swept.out + "/" + row["folder"]);
    EXPECT_EQ(report["hash"], row["hash"]);
    EXPECT_EQ(report["seed"], k % 3 + 1);
    EXPECT_EQ(std::to_string(report["n"].get<int>()), row["n"]);
    EXPECT_EQ(report["phi"].get<double>(), std::stod(row["phi"]));
  }
  // A cell is what `pack` makes of the scene that it says.
  const std::string cell = swept.out + "/" + Row(rows[4])["folder"];
  ASSERT_EQ(
      bernal({"pack", cell + "/scene.toml", "-o", (swept.folder / "packed").string(), "--quiet"}).status, 0);
  EXPECT_EQ(text_of(swept.folder / "packed" / "spheres.csv"), text_of(cell + "/spheres.csv"));
  EXPECT_EQ(bernal({"verify", cell}).status, 0);
  EXPECT_NE(text_of(swept.out + "/results.svg").find("6 of 6 cells"), std::string::npos);

  const auto before = swept.reports();
  EXPECT_EQ(swept.report()["ran"], 0);
  EXPECT_EQ(swept.reports(), before) << "nothing is run twice";
  // Another sweep uses what it still asks for, with other words for the same.
  swept.folder.write("sweep.toml",
                     "scene = \"bed.toml\"\nrepeats = 4\n[grid]\nspheres.diameter = { sigma = [0.3] }\n");
  EXPECT_EQ(swept.report()["ran"], 1);
  EXPECT_EQ(swept.rows().size(), 4u);
  EXPECT_EQ(swept.reports().size(), 7u) << "what nobody asks for any more is kept";
  EXPECT_FALSE(fs::exists(swept.out + "/cells/.claims"));
}

TEST(SweepCommand, AnyNumberOfJobsGivesTheSamePackings) {
  const Swept one, two;
  ASSERT_EQ(one.run({"--jobs", "1", "--threads", "2"}).status, 0);
  ASSERT_EQ(two.run({"--jobs", "3", "--threads", "1"}).status, 0);
  const std::vector<Row> a = one.rows(), b = two.rows();
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].at("hash"), b[k].at("hash"));
    EXPECT_EQ(a[k].at("folder"), b[k].at("folder"));
  }
}

TEST(SweepCommand, CellsThatFailStopNothingElse) {
  // Of the last combination alone the spheres are larger than the container; another cannot hold so many.
  const Swept swept(
      "scene = \"bed.toml\"\n[grid]\nspheres.radius = [0.5, 4]\ncontainer.radius = [9, 3]\nspheres.count = "
      "[2, 500]\n",
      "[container]\nkind = \"sphere\"\nradius = 9\n[spheres]\ncount = 2\nradius = 0.5\n"
      "[[stage]]\ndo = \"insert\"\nattempts = 50\n");
  const Ended ended = swept.run({"--jobs", "2"});
  EXPECT_EQ(ended.status, 3) << ended.err;
  std::map<std::string, int> outcomes;
  for (Row row : swept.rows()) {
    ++outcomes[row["outcome"]];
    const bool is_refused = row["spheres.radius"] == "4" && row["container.radius"] == "3";
    EXPECT_EQ(row["outcome"] == "refused", is_refused) << row["cell"];
    EXPECT_EQ(row["exit_code"], is_refused ? "2" : row["outcome"] == "converged" ? "0" : "3");
  }
  EXPECT_EQ(outcomes["refused"], 2) << ended.err;
  EXPECT_GT(outcomes["full"], 0) << ended.err;
  EXPECT_GT(outcomes["converged"], 0);
  EXPECT_NE(ended.err.find("refused: "), std::string::npos) << ended.err;
  EXPECT_EQ(swept.report({}, 3)["ran"], 0) << "they would end in the same way";
  EXPECT_EQ(swept.report({"--retry"}, 3)["ran"], 2);
}

/// Takes seconds where nobody stops it.
std::string long_bed() {
  std::string text = tiny_bed;
  text.replace(text.find("count = 30"), 10, "count = 1500");
  return text;
}

TEST(SweepCommand, AnInterruptLeavesWholeCellsAndTheSweepGoesOn) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Swept swept(six_cells, long_bed());
    const Process process = start_bernal(swept.call({"--jobs", "2"}));
    ASSERT_TRUE(swept.wait_for(1));
    process.signal(signal);
    const Ended ended = process.wait();
    EXPECT_EQ(ended.status, 3) << ended.err;
    EXPECT_NE(ended.err.find("the same call goes on"), std::string::npos) << ended.err;
    const auto done = swept.reports();
    EXPECT_LT(done.size(), 6u) << "it was stopped too late to show anything";
    EXPECT_EQ(swept.rows().size(), 6u);
    EXPECT_EQ(std::ranges::count_if(swept.rows(), [](Row row) { return row["outcome"] == "missing"; }),
              6 - static_cast<int>(done.size()));
    EXPECT_EQ(swept.report()["ran"], 6 - done.size());
    const auto all = swept.reports();
    for (const auto& [name, file] : done) EXPECT_EQ(all.at(name), file) << "a finished cell is not run again";
  }
}

TEST(SweepCommand, WhatIsKilledIsRunAgain) {
  const Swept swept(six_cells, long_bed());
  const Process process = start_bernal(swept.call({"--jobs", "2"}));
  ASSERT_TRUE(swept.wait_for(1));
  const std::vector<pid_t> children = children_of(process.pid());
  process.signal(SIGKILL);
  for (const pid_t child : children) kill(child, SIGKILL);
  EXPECT_EQ(process.wait().status, 128 + SIGKILL);
  const auto done = swept.reports();
  EXPECT_LT(done.size(), 6u);
  // As of one that was killed between its last file and letting go of its claim.
  fs::create_directories(swept.out + "/cells/.claims");
  for (const auto& [name, file] : done) std::ofstream(swept.out + "/cells/.claims/" + name);
  EXPECT_EQ(swept.report()["ran"], 6 - done.size());
  const auto all = swept.reports();
  for (const auto& [name, file] : done) EXPECT_EQ(all.at(name), file);
  for (const auto& entry : fs::recursive_directory_iterator(swept.out))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path() << " is left over";
}

TEST(SweepCommand, WhatIsNoClaimOfItsOwnStays) {
  const Swept swept;
  EXPECT_EQ(swept.report()["ran"], 6);
  const std::string mine = swept.folder.write("mine", "kept").string(), claims = swept.out + "/cells/.claims";
  fs::create_directory_symlink(swept.folder.path(), claims);
  EXPECT_EQ(swept.report()["ran"], 0);
  EXPECT_TRUE(fs::exists(mine));
  fs::remove(claims);
  fs::create_directory(claims);
  std::ofstream(claims + "/mine");
  EXPECT_EQ(swept.report()["ran"], 0);
  EXPECT_TRUE(fs::exists(claims + "/mine"));
}

/// As soon as there are any.
std::vector<pid_t> children_once_there(const Process& process) {
  std::vector<pid_t> children;
  for (int k = 0; k < 3000 && children.empty(); ++k) {
    children = children_of(process.pid());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return children;
}

TEST(SweepCommand, ACellThatIsKilledIsRecordedAndTheRestGoesOn) {
  const Swept swept(six_cells, long_bed());
  const Process process = start_bernal(swept.call({"--jobs", "1"}));
  const std::vector<pid_t> children = children_once_there(process);
  ASSERT_EQ(children.size(), 1u);
  kill(children.front(), SIGKILL);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 3);
  const std::vector<Row> rows = swept.rows();
  EXPECT_EQ(rows.at(0).at("outcome"), "crashed") << ended.err;
  EXPECT_EQ(rows.at(0).at("exit_code"), "137");
  EXPECT_EQ(std::ranges::count_if(rows, [](Row row) { return row["outcome"] == "converged"; }), 5)
      << ended.err;
  EXPECT_EQ(swept.report()["ran"], 1);
  EXPECT_FALSE(fs::exists(swept.out + "/" + rows.at(0).at("folder") + "/failed.toml"));
}

TEST(SweepCommand, ACellThatIsKilledAndDoneByAnotherCallIsThatOnes) {
  const Swept swept(six_cells, long_bed());
  const Process one = start_bernal(swept.call({"--jobs", "1", "--json"}));
  const std::vector<pid_t> children = children_once_there(one);
  ASSERT_EQ(children.size(), 1u);
  one.signal(SIGSTOP);
  kill(children.front(), SIGKILL);
  const Ended second = start_bernal(swept.call({"--jobs", "1", "--json"})).wait();
  one.signal(SIGCONT);
  const Ended first = one.wait();
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(json::parse(first.out)["ran"], 0);
  EXPECT_EQ(json::parse(second.out)["ran"], 6);
  for (Row row : swept.rows()) EXPECT_EQ(row["outcome"], "converged");
}

TEST(SweepCommand, SeveralCallsShareTheWork) {
  const Swept swept;
  const Process one = start_bernal(swept.call({"--jobs", "1", "--json"}));
  const Process two = start_bernal(swept.call({"--jobs", "1", "--json"}));
  std::map<std::string, std::pair<ino_t, std::int64_t>> as_first_seen;
  for (int k = 0; k < 6000 && as_first_seen.size() < 6; ++k) {
    as_first_seen.merge(swept.reports());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const Ended first = one.wait(), second = two.wait();
  EXPECT_EQ(swept.reports(), as_first_seen) << "each cell is packed once";
  ASSERT_EQ(first.status, 0) << first.err;
  ASSERT_EQ(second.status, 0) << second.err;
  const int ran = json::parse(first.out)["ran"].get<int>() + json::parse(second.out)["ran"].get<int>();
  EXPECT_EQ(ran, 6) << "each cell counts in the call that packed it";
  EXPECT_EQ(swept.rows().size(), 6u);
}

TEST(SweepCommand, TimeEndsACellWithWhatItHas) {
  std::string bed = tiny_bed;
  bed.replace(bed.find("count = 30"), 10, "count = 20000");
  const Swept swept("scene = \"bed.toml\"\nrepeats = 1\n", bed + "alpha = 200\n");
  EXPECT_EQ(swept.report({"--time", "1"}, 3)["ran"], 1);
  Row row = swept.rows().at(0);
  EXPECT_EQ(row["outcome"], "cancelled");
  EXPECT_NE(row["reason"].find("1 s"), std::string::npos) << row["reason"];
  EXPECT_EQ(swept.report({"--time", "1"}, 3)["ran"], 0);
}

TEST(SweepCommand, ListsAndCollectsWithoutRunning) {
  const Swept swept;
  const Ended listed = swept.run({"--list"});
  EXPECT_EQ(listed.status, 0) << listed.err;
  EXPECT_EQ(std::ranges::count(listed.out, '\n'), 6);
  EXPECT_NE(listed.out.find("missing    spheres.diameter.sigma = 0.1, seed = 1\n"), std::string::npos)
      << listed.out;
  EXPECT_FALSE(fs::exists(swept.out));
  ASSERT_EQ(swept.run({"--cell", "2-3"}).status, 0);
  EXPECT_FALSE(fs::exists(swept.out + "/results.csv")) << "a task writes no table";
  ASSERT_EQ(swept.run({"--cell", "5", "--here"}).status, 0);
  EXPECT_EQ(swept.run({"--collect"}).status, 3);
  std::string missing;
  for (Row row : swept.rows())
    if (row["outcome"] == "missing") missing += row["cell"];
  EXPECT_EQ(missing, "146");
}

TEST(SweepCommand, TheScriptForSlurmRunsEveryCell) {
  const Swept swept;
  const Ended made = swept.run({"--slurm", "--jobs", "4", "--threads", "2", "--time", "10m"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.out, swept.out + "/sweep.sbatch\n");
  const std::string script = text_of(swept.out + "/sweep.sbatch");
  for (const char* line : {"#!/bin/bash\n", "\n#SBATCH --array=1-6%4\n", "\n#SBATCH --cpus-per-task=2\n",
                           "\n#SBATCH --time=0-00:15:00\n", "\n#SBATCH --mem=512M\n"})
    EXPECT_NE(script.find(line), std::string::npos) << line << "is not in\n" << script;
  EXPECT_TRUE(swept.reports().empty());
  for (int task = 1; task <= 6; ++task)
    EXPECT_EQ(
        Process({"env", "SLURM_ARRAY_TASK_ID=" + std::to_string(task), "bash", swept.out + "/sweep.sbatch"})
            .wait()
            .status,
        0);
  EXPECT_EQ(swept.run({"--collect"}).status, 0);
  EXPECT_EQ(swept.rows().size(), 6u);
  // Tasks of a sweep that has changed would run other cells than those that were asked for.
  std::ofstream(swept.sweep, std::ios::app) << "# another\n";
  const Ended late = Process({"env", "SLURM_ARRAY_TASK_ID=1", "bash", swept.out + "/sweep.sbatch"}).wait();
  expect_refused(late, {"sweep.toml", "changed"});
  EXPECT_EQ(swept.run({"--slurm"}).status, 0) << "its own script it replaces";
  std::ofstream(swept.out + "/sweep.sbatch", std::ios::app) << "# mine\n";
  expect_refused_in_one_line(swept.run({"--slurm"}), {"sweep.sbatch", "remove it"});
}

TEST(SweepCommand, OddNamesAreNames) {
  const Folder folder;
  folder.write("b'é $x.toml", tiny_bed);
  folder.write("-s w.toml", "scene = \"b'é $x.toml\"\nrepeats = 2\n");
  const std::string out = (folder / "o'ut $HOME").string(), odd = (folder / "-s w.toml").string();
  const Ended here =
      Process({"env", "-C", folder.path().string(), BERNAL_COMMAND, "sweep", "-o", out, "--", "-s w.toml"})
          .wait();
  EXPECT_EQ(here.status, 0) << here.err;
  ASSERT_EQ(bernal({"sweep", odd, "-o", out, "--slurm"}).status, 0);
  fs::remove_all(out + "/cells");
  EXPECT_EQ(Process({"env", "SLURM_ARRAY_TASK_ID=2", "bash", out + "/sweep.sbatch"}).wait().status, 0);
}

TEST(SweepCommand, ManyCellsBecomeFewTasks) {
  const Swept swept("scene = \"bed.toml\"\n[grid]\nseed = { from = 1, to = 2345 }\n");
  ASSERT_EQ(swept.run({"--slurm"}).status, 0);
  const std::string script = text_of(swept.out + "/sweep.sbatch");
  EXPECT_NE(script.find("\n#SBATCH --array=1-782\n"), std::string::npos) << script;
  const Ended last = Process({"env", "SLURM_ARRAY_TASK_ID=782", "bash", swept.out + "/sweep.sbatch"}).wait();
  EXPECT_EQ(last.status, 0) << last.err;
  EXPECT_EQ(swept.reports().size(), 2u) << "cells 2344 and 2345";
}

TEST(SweepCommand, RefusesAbsurdInputInOneLine) {
  const Swept swept;
  expect_refused_in_one_line(swept.run({"--plot", "sigma,ph"}), {"\"sigma\""});
  expect_refused_in_one_line(swept.run({"--plot", "seed"}), {"x,y"});
  expect_refused_in_one_line(swept.run({"--cell", "0"}), {"--cell"});
  expect_refused_in_one_line(swept.run({"--cell", "5-2"}), {"--cell"});
  expect_refused_in_one_line(swept.run({"--cell", "7"}), {"6 cells"});
  expect_refused_in_one_line(swept.run({"--here"}), {"--cell"});
  expect_refused_in_one_line(swept.run({"--time", "soon"}), {"--time"});
  expect_refused_in_one_line(swept.run({"--list", "--slurm"}), {"--list"});
  expect_refused_in_one_line(swept.run({"--as-of", "0"}), {"changed"});
  expect_refused_in_one_line(bernal({"sweep", swept.sweep}), {"output"});
  expect_refused_in_one_line(bernal({"sweep", swept.sweep, "-o", "/proc/none"}), {"/proc/none"});
  swept.folder.write("sweep.toml", "scene = \"bed.toml\"\n[grid]\nspheres.diameter.sigma = [0.1, -1]\n");
  expect_refused_in_one_line(swept.run(), {"sweep.toml:3", "\"sigma\"", "cell 2"});
  EXPECT_TRUE(swept.reports().empty()) << "all is checked before anything runs";

  const Swept other;
  fs::create_directory(other.out);
  std::ofstream(other.out + "/results.csv") << "x,y\n1,2\n";
  expect_refused_in_one_line(other.run(), {"results.csv", "remove it"});
  EXPECT_EQ(text_of(other.out + "/results.csv"), "x,y\n1,2\n");
  EXPECT_TRUE(other.reports().empty());
}

TEST(SweepCommand, TheExamplesAreSweeps) {
  for (const auto& entry : fs::directory_iterator(fs::path(BERNAL_DATA) / "sweeps")) {
    const Folder folder;
    const std::string out = (folder / "out").string();
    EXPECT_EQ(bernal({"sweep", entry.path().string(), "-o", out, "--cell", "1-3"}).status, 0) << entry.path();
    EXPECT_EQ(bernal({"sweep", entry.path().string(), "-o", out, "--list"}).status, 0) << entry.path();
  }
}

}  // namespace sweep_command_test
}  // namespace bernal::testing
