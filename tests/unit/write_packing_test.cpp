#include "bernal/result/write_packing.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bernal/result/read_packing.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace write_packing_test {

namespace fs = std::filesystem;
using testing::error_of;
using testing::example;
using testing::Folder;
using testing::text_of;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

const std::set<std::string> all_files = {"packing.svg", "report.html", "report.json", "scene.toml",
                                         "section.svg", "spheres.csv", "spheres.vtp"};

std::vector<std::string> texts_of(const fs::path& folder) {
  std::vector<std::string> texts;
  for (const std::string& name : all_files) texts.push_back(text_of(folder / name));
  return texts;
}

TEST(WritePacking, WritesTheSevenFilesIntoAFolderThatItMakes) {
  const Folder folder;
  const fs::path target = folder / "some/where";
  const Packing packing = example();
  const WrittenPacking result = write_packing(packing, target);
  EXPECT_EQ(names_in(target), all_files);
  ASSERT_EQ(result.files.size(), all_files.size());
  EXPECT_EQ(result.files.front(), target / "spheres.csv");
  for (const fs::path& file : result.files) EXPECT_TRUE(fs::is_regular_file(file)) << file;
  EXPECT_TRUE(result.certificate.certified);
  EXPECT_EQ(read_csv(target / "spheres.csv").spheres, packing.spheres);
}

TEST(WritePacking, ReplacesAnEarlierResultAndNothingElse) {
  const Folder folder;
  folder.write("mine.txt", "keep");
  write_packing(example(1), folder.path());
  const Packing second = example(2);
  write_packing(second, folder.path());
  EXPECT_EQ(read_csv(folder / "spheres.csv").spheres, second.spheres);
  EXPECT_EQ(text_of(folder / "mine.txt"), "keep");
  std::set<std::string> expected = all_files;
  expected.insert("mine.txt");
  EXPECT_EQ(names_in(folder.path()), expected);
}

TEST(WritePacking, TheSeedThatWasUsedIsInTheScene) {
  const Folder folder;
  Packing packing = example();
  packing.seed = 77;
  write_packing(packing, folder.path());
  EXPECT_EQ(read_scene(folder / "scene.toml").seed, 77u);
}

TEST(WritePacking, CertifiesWhatIsWrittenAndHidesNothing) {
  Packing packing = example();
  const Vector<3> c = packing.spheres.center(0);
  packing.spheres.push_back(c + Vector<3>(1e-9, 0, 0), packing.spheres.r[0]);
  const Folder folder;
  const WrittenPacking result = write_packing(packing, folder.path());
  EXPECT_FALSE(result.certificate.certified);
  EXPECT_GE(result.certificate.overlapping_pairs, 1u);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder / "report.json")).at("certified"), false);
  EXPECT_NE(text_of(folder / "report.html").find(">no</b>"), std::string::npos);
}

/// While it lives no file may grow beyond `bytes`: what a full disk does to a program, but for the errno.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(WritePacking, AFullDiskLeavesEarlierOutputUntouched) {
  const Folder folder;
  write_packing(example(1), folder.path());
  const std::vector<std::string> before = texts_of(folder.path());
  // Whichever file is the one that no longer fits: report.json is the smallest, report.html the largest.
  std::set<std::string> refused;
  for (const rlim_t bytes : {0, 100, 4000, 20'000, 30'000, 45'000, 60'000}) {
    std::string message;
    {
      const FileSizeLimit limit(bytes);
      try {
        write_packing(example(2), folder.path());
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::cannot_write);
        message = error.what();
        refused.insert(fs::path(error.location().file).filename());
      }
    }
    if (message.empty()) continue;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(names_in(folder.path()), all_files) << bytes;
    EXPECT_EQ(texts_of(folder.path()), before) << bytes;
  }
  EXPECT_TRUE(refused.contains("spheres.csv"));
  EXPECT_TRUE(refused.contains("report.html"));
}

TEST(WritePacking, AFailureLeavesNoNewFolderBehind) {
  const Folder folder;
  {
    const FileSizeLimit limit(100);
    error_of([&] { write_packing(example(), folder / "new/deep"); });
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(WritePacking, ARenameThatFailsTakesBackTheOthers) {
  // A folder stands where the last file is to go: everything before it has been renamed by then.
  const Folder folder;
  write_packing(example(1), folder.path());
  fs::remove(folder / "section.svg");
  fs::remove(folder / "spheres.vtp");
  fs::create_directory(folder / "section.svg");
  const std::string csv = text_of(folder / "spheres.csv"), json = text_of(folder / "report.json");
  const Error error = error_of([&] { write_packing(example(2), folder.path()); });
  EXPECT_EQ(error.code(), ErrorCode::cannot_write);
  EXPECT_EQ(error.location().file, (folder / "section.svg").string());
  EXPECT_EQ(text_of(folder / "spheres.csv"), csv);
  EXPECT_EQ(text_of(folder / "report.json"), json);
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"packing.svg", "report.html", "report.json",
                                                            "scene.toml", "section.svg", "spheres.csv"}));
}

TEST(CheckWritable, LeavesNothingBehind) {
  const Folder folder;
  check_writable(folder.path());
  check_writable(folder / "new/deep");
  check_writable(folder / "new/deep/");
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(CheckWritable, SaysWhatIsInTheWay) {
  const Folder folder;
  const fs::path file = folder.write("file", "");
  for (const fs::path& target : {file, file / "below"}) {
    const Error error = error_of([&] { check_writable(target); });
    EXPECT_EQ(error.code(), ErrorCode::cannot_write);
    EXPECT_TRUE(std::string(error.what()).starts_with(folder.path().string())) << error.what();
  }
  EXPECT_EQ(error_of([&] { check_writable("/proc/bernal"); }).code(), ErrorCode::cannot_write);
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"file"});
}

}  // namespace write_packing_test
}  // namespace bernal
