// What bash and zsh offer: the scripts are asked as the shells ask them.
#include <set>
#include <sstream>

#include "bernal/core/unit.hpp"
#include "bernal/formats/export.hpp"
#include "command_tree.hpp"

namespace bernal::testing {
namespace completion_test {

using Words = std::set<std::string>;

Words words_in(const std::string& text) {
  std::istringstream lines(text);
  Words words;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) words.insert(line);
  return words;
}

/// What bash offers for the last of the words, in a folder with some files.
class Bash {
 public:
  Bash() {
    std::filesystem::create_directories(folder_.path() / "a folder");
    for (const char* file : {"bed.toml", "part.stl", "PART.STEP", "notes.txt", "bed.csv"})
      folder_.write(file, "");
    script_ = folder_.write(".script", bernal({"completion", "bash"}).out).string();
  }
  Words offers(const std::vector<std::string>& words) const {
    std::string line = "cd '" + folder_.path().string() + "'; source " + script_ + "; COMP_WORDS=(bernal";
    for (const std::string& word : words) line += " '" + word + "'";
    line += "); COMP_CWORD=" + std::to_string(words.size()) +
            "; set -u; _bernal bernal; printf '%s\\n' \"${COMPREPLY[@]}\"";
    const Ended ended = Process({"bash", "--norc", "-c", line}).wait();
    EXPECT_EQ(ended.err, "");
    return words_in(ended.out);
  }

 private:
  Folder folder_;
  std::string script_;
};

TEST(Completion, BashKnowsEveryCommandAndOption) {
  const Bash bash;
  for (const ToldCommand& command : all_told_commands()) {
    std::vector<std::string> words = command.words;
    words.emplace_back("-");
    EXPECT_EQ(bash.offers(words), Words(command.options.begin(), command.options.end())) << words.front();
    if (command.commands.empty()) continue;
    words.back() = "";
    EXPECT_EQ(bash.offers(words), Words(command.commands.begin(), command.commands.end()));
  }
}

TEST(Completion, BashOffersWhatAValueMayBe) {
  const Bash bash;
  const auto names = unit_names();
  const Words units(names.begin(), names.end());
  EXPECT_EQ(bash.offers({"pack", "part.stl", "--unit", ""}), units);
  EXPECT_EQ(bash.offers({"pack", "part.stl", "--unit", "=", ""}), units);
  EXPECT_EQ(bash.offers({"pack", "--unit", "="}), units);
  EXPECT_EQ(bash.offers({"pack", "--unit", "=", "m"}), (Words{"m", "mm"}));
  Words formats;
  for (const ExportFormat& format : export_formats()) formats.insert(format.name);
  EXPECT_EQ(bash.offers({"export", "out", "--to", ""}), formats);
  EXPECT_EQ(bash.offers({"export", "out", "--to", "lamm"}), Words{"lammps"});
  EXPECT_TRUE(bash.offers({"export", "out", "--contact", ""}).contains("bridge"));
  EXPECT_TRUE(bash.offers({"keys", ""}).contains("relax"));
  EXPECT_EQ(bash.offers({"design", "target", "--family", "f"}), Words{"fuller"});
  EXPECT_TRUE(bash.offers({"manual", "design", ""}).contains("pack")) << "several may follow each other";
  EXPECT_EQ(bash.offers({"completion", ""}), (Words{"bash", "zsh"}));
  EXPECT_EQ(bash.offers({"pack", "bed.toml", "--seed", ""}), Words{});
}

TEST(Completion, BashOffersFilesOfTheKindThatIsAskedFor) {
  const Bash bash;
  EXPECT_EQ(bash.offers({"pack", ""}), (Words{"a folder", "bed.toml", "part.stl", "PART.STEP"}));
  EXPECT_EQ(bash.offers({"pack", "--quiet", "P"}), Words{"PART.STEP"});
  EXPECT_EQ(bash.offers({"explain", ""}), (Words{"a folder", "bed.toml", "part.stl", "PART.STEP"}));
  EXPECT_EQ(bash.offers({"inspect", ""}), (Words{"a folder", "part.stl", "PART.STEP"}));
  EXPECT_EQ(bash.offers({"verify", ""}), (Words{"a folder", "bed.csv"}));
  EXPECT_EQ(bash.offers({"measure", ""}), Words{"a folder"});
  EXPECT_EQ(bash.offers({"pack", "bed.toml", "-o", ""}), Words{"a folder"});
  EXPECT_EQ(bash.offers({"export", "a folder", "-o", "n"}), Words{"notes.txt"});
  EXPECT_EQ(bash.offers({"pack", "bed.toml", ""}), Words{}) << "there is no second scene";
  for (const char* begun : {"a\\ fo", "\"a fo", "a fo"})
    EXPECT_EQ(bash.offers({"measure", begun}), Words{"a folder"}) << begun;
}

// A value that has the name of a command is none; nor is one an option that has the name of one.
TEST(Completion, BashIsNotMisledByValues) {
  const Bash bash;
  EXPECT_TRUE(bash.offers({"design", "target", "--family", "fuller", "-"}).contains("--phi"));
  EXPECT_TRUE(bash.offers({"pack", "-o", "verify", "--"}).contains("--with-mesh"));
  EXPECT_TRUE(bash.offers({"verify", "pack", "--l"}).contains("--list"));
  EXPECT_TRUE(bash.offers({"verify", "--list", ""}).contains("bed.csv")) << "--list takes no second word";
}

TEST(Completion, ZshReadsItsScript) {
  const Ended zsh = bernal({"completion", "zsh"});
  EXPECT_EQ(zsh.status, 0);
  EXPECT_TRUE(zsh.out.starts_with("#compdef bernal\n"));
  for (const ToldCommand& command : all_told_commands()) {
    std::string function = "_bernal";
    for (const std::string& word : command.words) function += "_" + word;
    const std::size_t at = zsh.out.find("\n" + function + "()\n");
    ASSERT_NE(at, std::string::npos) << function;
    const std::string body = zsh.out.substr(at, zsh.out.find("\n}\n", at) - at);
    for (const std::string& option : command.options)
      EXPECT_NE(body.find(option), std::string::npos) << option;
    for (const std::string& of : command.commands)
      EXPECT_NE(body.find("'" + of + ":"), std::string::npos) << of;
  }
  if (Process({"sh", "-c", "command -v zsh"}).wait().status != 0) GTEST_SKIP() << "zsh is not installed";
  const Folder folder;
  const std::string file = folder.write("_bernal", zsh.out);
  const Ended read = Process({"zsh", "-f", "-n", file}).wait();
  EXPECT_EQ(read.status, 0) << read.err;
}

TEST(Completion, OtherShellsAreRefused) {
  expect_refused_in_one_line(bernal({"completion", "fish"}), {"fish", "bash"});
  expect_refused_in_one_line(bernal({"completion"}), {"SHELL"});
}

}  // namespace completion_test
}  // namespace bernal::testing
