#include "bernal/core/text.hpp"

#include <gtest/gtest.h>

#include <array>

namespace bernal {
namespace text_test {

constexpr std::array<std::string_view, 6> names = {"box", "cylinder", "sphere", "mesh", "radius", "diameter"};

TEST(NearestName, FindsWhatWasMeant) {
  EXPECT_EQ(nearest_name("cylnder", names), "cylinder");    // left out
  EXPECT_EQ(nearest_name("cylinnder", names), "cylinder");  // inserted
  EXPECT_EQ(nearest_name("cylimder", names), "cylinder");   // replaced
  EXPECT_EQ(nearest_name("raduis", names), "radius");       // swapped: one edit, not two
  EXPECT_EQ(nearest_name("bxo", names), "box");
  EXPECT_EQ(nearest_name("SPHERE", names), "sphere");
  EXPECT_EQ(nearest_name("box", names), "box");
}

TEST(NearestName, IsSilentWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("torus", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("x", names), "");
  EXPECT_EQ(nearest_name("box", {}), "");
}

// A third of the letters of the longer word may differ, no more.
TEST(NearestName, TheLimitIsAThirdOfTheLetters) {
  constexpr std::array<std::string_view, 1> six = {"abcdef"};
  EXPECT_EQ(nearest_name("abcdxy", six), "abcdef");
  EXPECT_EQ(nearest_name("abcxyz", six), "");
}

TEST(NearestName, TheNearestWinsAndTheFirstOfEquals) {
  constexpr std::array<std::string_view, 3> three = {"shapes", "shake", "shale"};
  EXPECT_EQ(nearest_name("shakes", three), "shapes");
  EXPECT_EQ(nearest_name("shape", three), "shapes");
  EXPECT_EQ(nearest_name("shakee", three), "shake");
}

// Escape sequences, control characters of C1, marks of direction, ends of lines, bytes that are no UTF-8.
TEST(PlainText, HoldsNothingThatMovesATerminal) {
  EXPECT_EQ(plain_text("Gehäuse Ø 12 µm, 外壳, 🔩"), "Gehäuse Ø 12 µm, 外壳, 🔩");
  EXPECT_EQ(plain_text("\x1b[2Ja\x07\nb\x7f"), " [2Ja  b ");
  EXPECT_EQ(plain_text("a\xc2\x9b"
                       "31m"),
            "a 31m");
  EXPECT_EQ(plain_text("gpj.\xe2\x80\xaetrap\xe2\x81\xa6"), "gpj. trap ");
  EXPECT_EQ(plain_text("\xff\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80\xc3"), "???????????");
  EXPECT_EQ(plain_text(""), "");
}

TEST(IsUtf8, TellsWhatPlainTextWouldReplace) {
  for (const char* good : {"", "part?.stl", "Gehäuse Ø 12 µm, 外壳, 🔩", "\x1b[2J"})
    EXPECT_TRUE(is_utf8(good)) << good;
  for (const char* bad : {"\xff", "a\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "?\xc3"})
    EXPECT_FALSE(is_utf8(bad));
}

TEST(EscapedControls, StandAsNumbersAndAllElseAsItIs) {
  EXPECT_EQ(with_escaped_controls("Gehäuse Ø 12 µm, 外壳, 🔩"), "Gehäuse Ø 12 µm, 外壳, 🔩");
  EXPECT_EQ(with_escaped_controls("\x1b[2Ja\nb\x7f"), "\\u001B[2Ja\\u000Ab\\u007F");
  EXPECT_EQ(with_escaped_controls("a\xc2\x9b"
                                  "31m gpj.\xe2\x80\xaetrap"),
            "a\\u009B31m gpj.\\u202Etrap");
  EXPECT_EQ(with_escaped_controls("\xff\x9b"), "\xff\x9b");
}

TEST(PlainText, LeavesOutTheMiddleOfWhatIsLong) {
  const std::string text = std::string(1000, 'a') + std::string(1000, 'z');
  EXPECT_EQ(plain_text(text, 2000), text);
  const std::string shortened = plain_text(text, 100);
  EXPECT_LE(shortened.size(), 100u);
  EXPECT_GE(shortened.size(), 95u);
  EXPECT_TRUE(shortened.starts_with(std::string(60, 'a')) && shortened.ends_with(std::string(30, 'z')));
  for (std::size_t most = 5; most < 40; ++most)
    EXPECT_LE(plain_text("ääääääääääääääääääääääää", most).size(), most);
}

TEST(WithOptions, NamesThemAsTheFrontEndDoes) {
  const auto loud = [](std::string_view name, std::string_view value) {
    return "<" + std::string(name) + "|" + std::string(value) + ">";
  };
  EXPECT_EQ(with_options("a.csv:1: give ‹with_mesh›, such as ‹columns=x=3,y=4› ", loud),
            "a.csv:1: give <with_mesh|>, such as <columns|x=3,y=4> ");
  for (const char* text : {"", "no option", "‹", "›", "‹›", "‹=1›", "‹a", "a‹b c›d", "‹ÄÖ›"})
    EXPECT_EQ(with_options(text, loud), text);
  EXPECT_EQ(with_options("‹‹box››", loud), "‹<box|>›");
}

TEST(InDimension, SpheresOfThePlaneAreDiscs) {
  EXPECT_EQ(in_dimension(2, "all 12 spheres are placed; every sphere rests"),
            "all 12 discs are placed; every disc rests");
  EXPECT_EQ(in_dimension(2, "Spheres. The sphere's centre; spheres, (sphere) hard-spheres."),
            "Discs. The disc's centre; discs, (disc) hard-discs.");
  for (const int dimension : {1, 3, 4}) EXPECT_EQ(in_dimension(dimension, "2 spheres"), "2 spheres");
  // Names of keys and files, and words of which it is a part.
  for (const char* text : {"[spheres]", "kind = \"sphere\"", "spheres.csv", "out/spheres/a", "spherefoam",
                           "atmosphere", "most_spheres", "spheres_of", "class=\"spheres\"", ""})
    EXPECT_EQ(in_dimension(2, text), text);
  // Columns of a table stay where they are.
  EXPECT_EQ(in_dimension(2, "spheres    12\n    share  spheres  fraction\n   spheres\n"),
            "discs      12\n    share  discs    fraction\n     discs\n");
}

}  // namespace text_test
}  // namespace bernal
