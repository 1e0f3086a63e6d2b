// bernal sweep in several calls: interrupted, killed, side by side, and by the script for Slurm.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <string>

#include "bernal/sweep/sweep.hpp"
#include "swept.hpp"

namespace bernal::testing {
namespace sweep_command_test {

/// Takes seconds where nobody stops it.
std::string long_bed() {
  std::string text = tiny_bed;
  text.replace(text.find("count = 30"), 10, "count = 1500");
  return text;
}

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

/// As soon as there are any.
std::vector<pid_t> children_once_there(const Process& process) {
  std::vector<pid_t> children;
  for (int k = 0; k < 3000 && children.empty(); ++k) {
    children = children_of(process.pid());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return children;
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
  // As of those that were killed between their last file and letting go of their claims, or over removing
  // their own folders, and of the call itself over its table.
  fs::create_directories(swept.out + "/cells/.claims");
  for (const auto& [name, file] : done) {
    std::ofstream(swept.out + "/cells/.claims/" + name);
    fs::create_directories(swept.out + "/cells/" + name + "/.bernal-staging-killed/.earlier");
  }
  fs::create_directories(swept.out + "/.bernal-staging-killed");
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

TEST(SweepCommand, AReportThatIsNoFileStopsNoOtherCell) {
  const Swept swept;
  EXPECT_EQ(swept.report()["ran"], 6);
  const auto done = swept.reports();
  const std::string cells = swept.out + "/cells/";
  const std::string pipe = cells + done.begin()->first + "/report.json";
  const std::string folder = cells + done.rbegin()->first + "/report.json";
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::remove(folder);
  fs::create_directory(folder);
  const Ended ended = swept.run();
  EXPECT_EQ(ended.status, 3) << ended.err;
  const std::vector<Row> rows = swept.rows();
  EXPECT_EQ(std::ranges::count_if(rows, [](Row row) { return row["outcome"] == "converged"; }), 4)
      << ended.err;
}

// What a report says of files that are not there any more, or are those of another cell, is believed by
// nobody.
TEST(SweepCommand, ACellIsDoneWhereItsFilesAreThoseOfItsReport) {
  const Swept swept;
  EXPECT_EQ(swept.report()["ran"], 6);
  const auto done = swept.reports();
  std::vector<fs::path> cells;
  for (const auto& [hash, report] : done) cells.push_back(fs::path(swept.out) / "cells" / hash);
  const std::string first = text_of(cells[0] / "spheres.csv"), third = text_of(cells[2] / "spheres.csv");
  fs::remove(cells[0] / "spheres.csv");
  fs::copy_file(cells[3] / "spheres.csv", cells[1] / "spheres.csv", fs::copy_options::overwrite_existing);
  std::ofstream(cells[2] / "spheres.csv") << third.substr(0, third.rfind('\n', third.size() - 2) + 1);
  fs::copy_file(cells[4] / "scene.toml", cells[3] / "scene.toml", fs::copy_options::overwrite_existing);
  fs::remove(cells[4] / "spheres.csv");
  ASSERT_EQ(mkfifo((cells[4] / "spheres.csv").c_str(), 0600), 0);

  const Ended collected = swept.run({"--collect"});
  std::size_t missing = 0;
  for (Row row : swept.rows()) missing += row["outcome"] == "missing" && row["certified"].empty();
  EXPECT_EQ(missing, 5u) << collected.err;
  EXPECT_EQ(swept.reports(), done) << "who only looks changes nothing";

  swept.run();
  EXPECT_EQ(text_of(cells[0] / "spheres.csv"), first) << "one seed, one packing";
  EXPECT_EQ(text_of(cells[2] / "spheres.csv"), third);
  std::size_t converged = 0;
  for (Row row : swept.rows()) converged += row["outcome"] == "converged";
  EXPECT_GE(converged, 4u) << "a scene or a pipe that somebody put there may be in the way";
}

// Its figures and its words come from the report, beside spheres that nobody has touched.
TEST(SweepCommand, ACellIsDoneWhereNobodyHasChangedItsReport) {
  const Swept swept;
  EXPECT_EQ(swept.report()["ran"], 6);
  const std::vector<Row> rows = swept.rows();
  const auto change = [&](std::size_t row, const std::string& from, const std::string& to) {
    const fs::path file = fs::path(swept.out) / rows[row].at("folder") / "report.json";
    std::string text = text_of(file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    std::ofstream(file) << text.replace(at, from.size(), to);
  };
  change(0, "\"phi\": 0.", "\"phi\": 0.7");
  change(1, "\"n\": ", "\"n\": 1");
  change(2, "\"certified\": true", "\"certified\": false");
  change(3, ",\n  \"seal\": ", ",\n  \"unsealed\": ");
  // And a whole cell in the place of another.
  for (const auto& file : fs::directory_iterator(fs::path(swept.out) / rows[5].at("folder")))
    fs::copy_file(file.path(), fs::path(swept.out) / rows[4].at("folder") / file.path().filename(),
                  fs::copy_options::overwrite_existing);

  const Ended collected = swept.run({"--collect"});
  EXPECT_NE(collected.err.find("report.json"), std::string::npos) << collected.err;
  std::size_t missing = 0;
  for (Row row : swept.rows())
    missing += row["outcome"] == "missing" && row["phi"].empty() &&
               row["reason"].find("report.json") != std::string::npos;
  EXPECT_EQ(missing, 5u) << collected.err;

  const Ended again = swept.run();
  EXPECT_NE(again.err.find("5 that were there and not as they were written"), std::string::npos) << again.err;
  const std::vector<Row> now = swept.rows();
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const char* column : {"outcome", "n", "phi", "certified", "hash"})
      EXPECT_EQ(now[k].at(column), rows[k].at(column)) << k << ": " << column;
}

TEST(SweepCommand, StartsFromAResultThatIsAnArray) {
  const Folder folder;
  const std::string bed = folder.write("bed.toml", tiny_bed).string(), start = (folder / "start").string();
  ASSERT_EQ(bernal({"pack", bed, "-o", start, "--binary", "--quiet"}).status, 0);
  ASSERT_TRUE(fs::exists(start + "/spheres.npy"));
  folder.write("again.toml",
               "unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\nstart = \"start\"\n[[stage]]\n"
               "do = \"relax\"\n");
  const std::string sweep = folder.write("sweep.toml", "scene = \"again.toml\"\nrepeats = 2\n").string();
  const Ended ended = bernal({"sweep", sweep, "-o", (folder / "out").string(), "--quiet"});
  EXPECT_EQ(ended.status, 0) << ended.err;
}

// A folder of somebody else may lead elsewhere.
TEST(SweepCommand, WritesThroughNoLink) {
  for (const char* link : {"cells", "cells/.claims", "cells/HASH"}) {
    const Swept swept("scene = \"bed.toml\"\nrepeats = 1\n");
    const Folder home;
    std::string name = link;
    if (const std::size_t at = name.find("HASH"); at != name.npos)
      name.replace(at, 4, Sweep::read(swept.sweep).cell(1).hash);
    fs::create_directories((fs::path(swept.out) / name).parent_path());
    fs::create_directory_symlink(home.path(), fs::path(swept.out) / name);
    expect_refused(swept.run(), {name, "is a link"});
    EXPECT_TRUE(fs::is_empty(home.path())) << link;
  }
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

}  // namespace sweep_command_test
}  // namespace bernal::testing
