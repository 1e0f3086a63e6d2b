// The pages of the manual, which are made from what --help is made of.
#include <algorithm>

#include "command_tree.hpp"

namespace bernal::testing {
namespace manual_test {

Ended shell(const std::string& line) { return Process({"bash", "-c", line}).wait(); }

std::string page_name(const std::vector<std::string>& words) {
  std::string name = "bernal";
  for (const std::string& word : words) name += "-" + word;
  return name;
}

TEST(Manual, HasAPageForEveryCommandWithAllThatHelpTells) {
  const Folder folder;
  const Ended ended = bernal({"manual", "-o", folder / "man"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  const std::vector<ToldCommand> all = all_told_commands();
  EXPECT_GE(all.size(), 19u);
  for (const ToldCommand& command : all) {
    const std::string name = page_name(command.words);
    SCOPED_TRACE(name);
    const std::string page = text_of(folder.path() / "man" / (name + ".1"));
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "SEE ALSO"})
      EXPECT_NE(page.find(std::string("\n.SH ") + section + "\n"), std::string::npos) << section;
    EXPECT_EQ(page.find("\n.SH EXIT STATUS\n") == std::string::npos,
              command.words == std::vector<std::string>{"design"});
    for (std::string option : command.options) {
      for (std::size_t at = 0; (at = option.find('-', at)) != std::string::npos; at += 2)
        option.insert(at, "\\");
      EXPECT_NE(page.find("\\fB" + option + "\\fR"), std::string::npos) << option;
    }
    for (const std::string& of : command.commands) {
      EXPECT_NE(page.find("\\fB" + of + "\\fR"), std::string::npos) << of;
      EXPECT_NE(page.find("\\-" + of + " (1)"), std::string::npos) << of;
    }
    EXPECT_TRUE(
        std::ranges::all_of(page, [](unsigned char c) { return c == '\n' || (c >= ' ' && c < 127); }));
  }
  const auto pages = std::distance(std::filesystem::directory_iterator(folder.path() / "man"), {});
  EXPECT_EQ(static_cast<std::size_t>(pages), all.size()) << "pages and nothing else";
}

// As far as those are here who set pages: a page that they complain of is wrong.
TEST(Manual, IsSetWithoutAComplaint) {
  const Folder folder;
  ASSERT_EQ(bernal({"manual", "-o", folder.path().string()}).status, 0);
  const std::string all = "'" + folder.path().string() + "'/*.1";
  const bool mandoc = shell("command -v mandoc").status == 0, man = shell("command -v groff").status == 0;
  if (!mandoc && !man) GTEST_SKIP() << "neither mandoc nor groff is installed";
  if (mandoc) {
    const Ended ended = shell("mandoc -T lint -W warning " + all);
    EXPECT_EQ(ended.out + ended.err, "");
  }
  if (man) {
    const Ended ended =
        shell("for page in " + all + "; do groff -man -ww -Tutf8 -rLL=78n -z \"$page\"; done");
    EXPECT_EQ(ended.out + ended.err, "");
  }
}

TEST(Manual, OnePageIsPrintedOnStandardOutput) {
  const Folder folder;
  ASSERT_EQ(bernal({"manual", "-o", folder.path().string()}).status, 0);
  EXPECT_EQ(bernal({"manual", "design", "target"}).out, text_of(folder.path() / "bernal-design-target.1"));
  EXPECT_EQ(bernal({"manual"}).out, text_of(folder.path() / "bernal.1"));
  expect_refused_in_one_line(bernal({"manual", "pak"}), {"bernal-pak", "did you mean \"bernal-pack\"?"});
  expect_refused_in_one_line(bernal({"manual", "pack", "-o", folder.path().string()}), {"leave COMMAND out"});
  expect_refused_in_one_line(bernal({"manual", "-o", folder / "bernal.1"}), {"bernal.1"});
}

TEST(Manual, BearsTheDayThatItIsGiven) {
  const std::string command = "'" BERNAL_COMMAND "' manual | head -1";
  EXPECT_NE(shell("SOURCE_DATE_EPOCH=1000000000 " + command).out.find(" 2001-09-09 "), std::string::npos);
  const std::string refused = "SOURCE_DATE_EPOCH=yesterday '" BERNAL_COMMAND "' manual";
  expect_refused_in_one_line(shell(refused), {"SOURCE_DATE_EPOCH", "yesterday"});
}

}  // namespace manual_test
}  // namespace bernal::testing
