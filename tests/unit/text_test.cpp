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

}  // namespace text_test
}  // namespace bernal
