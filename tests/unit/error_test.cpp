#include "bernal/core/error.hpp"

#include <gtest/gtest.h>

namespace bernal {
namespace error_test {

TEST(Error, SaysWhereAsFarAsKnown) {
  EXPECT_STREQ(Error(ErrorCode::bad_scene, "no such key", {"a.toml", 7, 3}).what(), "a.toml:7: no such key");
  EXPECT_STREQ(Error(ErrorCode::bad_mesh, "empty", {"a.stl"}).what(), "a.stl: empty");
  EXPECT_STREQ(Error(ErrorCode::bad_argument, "radius < 0").what(), "radius < 0");
  EXPECT_STREQ(Error(ErrorCode::bad_packing, "no number", {"", 2}).what(), "line 2: no number");
}

}  // namespace error_test
}  // namespace bernal
