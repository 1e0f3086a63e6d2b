// bernal sweep as users call it, once.
#include <algorithm>
#include <fstream>
#include <string>

#include "swept.hpp"

namespace bernal::testing {
namespace sweep_command_test {

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

/// Where a cell says the packings number of the bernal that runs, it now says another.
void let_be_of_other_packings(const fs::path& file) {
  std::string text = text_of(file);
  for (const std::string mark : {"\"packings_number\": ", "packings_number = "})
    if (const std::size_t at = text.find(mark); at != text.npos) {
      const std::size_t first = at + mark.size(), end = text.find_first_not_of("0123456789", first);
      text.replace(first, end - first, "7");
      std::ofstream(file) << text;
      return;
    }
  FAIL() << "no packings number in " << file;
}

TEST(SweepCommand, MakesCellsOfOtherPackingsAnewAndSaysHowMany) {
  const Swept swept;
  ASSERT_EQ(swept.run().status, 0);
  const auto before = swept.reports();
  for (const std::size_t k : {1, 4})
    let_be_of_other_packings(swept.out + "/" + swept.rows()[k].at("folder") + "/report.json");
  const json collected = swept.report({"--collect"}, 3);
  EXPECT_EQ(collected["outcomes"]["missing"], 2);
  const Ended again = swept.run();
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.err.find("again      2 of other packings"), std::string::npos) << again.err;
  EXPECT_NE(again.err.find("(packings 7, commit "), std::string::npos) << again.err;
  EXPECT_EQ(again.err.find("not as they were written"), std::string::npos) << again.err;
  EXPECT_EQ(swept.report()["ran"], 0);
  EXPECT_EQ(swept.report()["outdated"], 0);
  std::size_t anew = 0;
  for (const auto& [cell, file] : swept.reports()) anew += before.at(cell) != file;
  EXPECT_EQ(anew, 2u);
}

TEST(SweepCommand, KeepsAFailureThatIsLaterThanAResultOfOtherPackings) {
  const Swept swept;
  ASSERT_EQ(swept.run().status, 0);
  const std::string cell = swept.out + "/" + swept.rows()[1].at("folder");
  const std::string number = std::to_string(report_of(cell)["packings_number"].get<int>());
  let_be_of_other_packings(cell + "/report.json");
  std::ofstream(cell + "/failed.toml")
      << "outcome = \"refused\"\nexit_code = 2\nreason = \"it is too large\"\n"
         "version = \"0.2.0\"\npackings_number = "
      << number << "\n";
  const json again = swept.report({}, 3);
  EXPECT_EQ(again["ran"], 0);
  EXPECT_EQ(again["outcomes"]["refused"], 1);
  EXPECT_EQ(swept.rows()[1].at("packings_number"), number);
}

TEST(SweepCommand, TriesWhatABernalOfOtherPackingsRefused) {
  // Of the last combination alone the spheres are larger than the container.
  const Swept swept("scene = \"bed.toml\"\n[grid]\nspheres.radius = [0.5, 4]\ncontainer.radius = [9, 3]\n",
                    "[container]\nkind = \"sphere\"\nradius = 9\n[spheres]\ncount = 2\nradius = 0.5\n"
                    "[[stage]]\ndo = \"insert\"\nattempts = 50\n");
  EXPECT_EQ(swept.report({}, 3)["outcomes"]["refused"], 1);
  EXPECT_EQ(swept.report({}, 3)["ran"], 0);
  let_be_of_other_packings(swept.out + "/" + swept.rows()[3].at("folder") + "/failed.toml");
  const json again = swept.report({}, 3);
  EXPECT_EQ(again["ran"], 1);
  EXPECT_EQ(again["outdated"], 1);
}

}  // namespace sweep_command_test
}  // namespace bernal::testing
