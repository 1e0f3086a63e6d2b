#include "scene/read_spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace read_spheres_test {

using testing::error_of;
using testing::Folder;

TEST(ReadSpheres, TakesTheColumnsThatTheHeaderNames) {
  const Folder folder;
  const std::vector<std::string> texts = {
      "x,y,z,r\n1,2,3,4\n",
      "# unit: mm\nx,y,z,r\n1,2,3,4\n",
      "id,d,z,y,x\n7,8,3,2,1\n",
      "X;Y;Z;Radius\r\n1;2;3;4\r\n",
      "x\ty\tz\tdiameter\n1\t2\t3\t8\n",
      "  x   y z    r \n   1 2.0   3   4\n",
      "\"\",\"x\",\"y\",\"z\",\"D\"\n0,1,2,3,8\n",
      "# x y z r\n1 2 3 4\n",
      "# by another program\n#\n# x, y, z, r\n1, 2, 3, 4\n",
      "\xEF\xBB\xBFx,y,z,r\n1,2,3,4\n",
      "x0,x1,x2,r,vx\n1,2,3,4,0.5\n",
      "r,x0,x1,x2\n4,1,2,3\n",
  };
  for (const std::string& text : texts) {
    const NamedColumns read = read_spheres(folder.write("s.csv", text));
    ASSERT_EQ(read.spheres.size(), 1u) << text;
    EXPECT_EQ(read.spheres.center(0), Vector<3>(1, 2, 3)) << text;
    EXPECT_EQ(read.spheres.r[0], 4) << text;
    EXPECT_EQ(read.first_line, std::count(text.begin(), text.end(), '\n')) << text;
    EXPECT_EQ(read.unit, text.starts_with("# unit") ? "mm" : "") << text;
  }
}

TEST(ReadSpheres, CountsTheDimensionsInTheHeader) {
  const Folder folder;
  EXPECT_EQ(read_spheres(folder.write("s.csv", "x,y,r\n1,2,3\n")).spheres.dimension(), 2);
  EXPECT_EQ(read_spheres(folder.write("s.csv", "x0,r\n1,2\n")).spheres.dimension(), 1);
  EXPECT_EQ(read_spheres(folder.write("s.csv", "x0,x1,x2,x3,x4,x5,x6,x7,d\n1,2,3,4,5,6,7,8,2\n"))
                .spheres.dimension(),
            8);
  EXPECT_TRUE(read_spheres(folder.write("s.csv", "x,y,z,r\n")).spheres.empty());
}

/// A unit that is not seen is an error of a factor of a thousand.
TEST(ReadSpheres, SeesTheUnitHoweverItIsWritten) {
  const Folder folder;
  const std::vector<std::string> texts = {
      "\xEF\xBB\xBF# unit: m\nx,y,z,r\n1,2,3,4\n",
      "#unit: m\nx,y,z,r\n1,2,3,4\n",
      "# Unit: m\nx,y,z,r\n1,2,3,4\n",
      "# unit : m\r\nx,y,z,r\r\n1,2,3,4\r\n",
      "# units:m \nx,y,z,r\n1,2,3,4\n",
      "#\tUNIT:\tm,,,\nx,y,z,r\n1,2,3,4\n",
      "\n# unit: m\n# unit: m\nx,y,z,r\n1,2,3,4\n",
      "id,x [m],y[m],z [ m ],D [m]\n1,1,2,3,8\n",
      "x (m);y (m);z (m);r (m)\n1;2;3;4\n",
      "x [m] y [m] z [m] r [m]\n1 2 3 4\n",
      "\"x [m]\",\"y [m]\",\"z [m]\",\"mass [kg]\",\"r [m]\"\n1,2,3,9,4\n",
      "# unit: m\nx (m),y (m),z (m),r (m)\n1,2,3,4\n",
  };
  for (const std::string& text : texts) {
    const NamedColumns read = read_spheres(folder.write("s.csv", text));
    EXPECT_EQ(read.unit, "m") << text;
    ASSERT_EQ(read.spheres.size(), 1u) << text;
    EXPECT_EQ(read.spheres.center(0), Vector<3>(1, 2, 3)) << text;
    EXPECT_EQ(read.spheres.r[0], 4) << text;
  }
  EXPECT_EQ(read_spheres(folder.write("s.csv", "# united: m\nx,r\n1,2\n")).unit, "");
}

TEST(ReadSpheres, TakesWhatIsHarmless) {
  const Folder folder;
  const std::vector<std::string> texts = {
      "x,y,z,r\n1,2,3,4\n\n\n",
      "x,y,z,r\n1,2,3,4\n \t\r\n",
      "x,y,z,r\n1,2,3,4",
      "x,y,z,r\r\n1,2,3,4\r",
      "\nx,y,z,r\n\n1,2,3,4\n",
      "x,y,z,r\n\"1\",\"2\",'3',\" 4 \"\n",
      "x,y,z,r\n+1,+2.0,3,+.4e1\n",
      "# Columns: id, x, y, z, r\nx,y,z,r\n1,2,3,4\n",
      "# Columns: id, x, y, z, r\n7,1,2,3,4\n",
      "# x y z r are what follows\n# x,y,z,r\n1,2,3,4\n",
      "# x, x and r\nx,y,z,w,r\n1,2,3,9,4\n",
  };
  for (const std::string& text : texts) {
    const NamedColumns read = read_spheres(folder.write("s.csv", text));
    ASSERT_EQ(read.spheres.size(), 1u) << text;
    EXPECT_EQ(read.spheres.center(0), Vector<3>(1, 2, 3)) << text;
    EXPECT_EQ(read.spheres.r[0], 4) << text;
    EXPECT_EQ(read.unit, "") << text;
  }
  const NamedColumns after = read_spheres(folder.write("s.csv", "x,r\n\n1,2\n3,4\n\n"));
  EXPECT_EQ(after.spheres.size(), 2u);
  EXPECT_EQ(after.first_line, 3);
}

/// The digest is taken of them, so they must be those that the spheres come from, all of them and once.
TEST(ReadSpheres, TellsTheBytesThatItReads) {
  const Folder folder;
  std::string text = "\xEF\xBB\xBFx,r\r\n";
  while (text.size() < 700'000) text += std::to_string(text.size()) + ",1\r\n";
  for (const std::string& whole : {text, text + "1,2", text + "\n \n"}) {
    std::string seen;
    read_spheres(folder.write("s.csv", whole), [&](std::string_view bytes) { seen += bytes; });
    EXPECT_EQ(seen, whole);
  }
}

struct Refused {
  std::string text;
  int line;
  std::string says;
};

TEST(ReadSpheres, SaysWhereAndWhatIsWrong) {
  const std::vector<Refused> cases = {
      {"", 0, "the header is missing"},
      {"# a remark\n", 1, "the header is missing"},
      {"1,2,3,4\n", 1, "expected a header that names columns such as x,y,z and r, radius, d or diameter"},
      {"x,y,z\n1,2,3\n", 1, "found \"x,y,z\""},
      {"a,b,c,r\n1,2,3,4\n", 1, "found \"a,b,c,r\""},
      {"x,y,z,r,d\n1,2,3,4,8\n", 1, "more than once, as r and d"},
      {"x,y,z,radius,r\n1,2,3,4,4\n", 1, "more than once, as r and radius"},
      {"x,y,x,r\n1,2,3,4\n", 1, "names the column x twice"},
      {"x,y,z,r,R\n1,2,3,4,4\n", 1, "names the column r twice"},
      {"x,y,z,x0,r\n1,2,3,1,4\n", 1, "as x and as x0"},
      {"x0,x1,x2,x3,x4,x5,x6,x7,x8,r\n", 1, "names 9 coordinates; there are at most 8"},
      {"# unit: parsec\nx,y,z,r\n", 1, "unknown unit \"parsec\""},
      {"x,y,z,r\n1,2,3\n", 2, "3 fields, but the header has 4"},
      {"x,y,z,r\n1,2,3,4\n1,2,3,4,5\n", 3, "5 fields, but the header has 4"},
      {"x,y,z,r\n1,2,3,4\n\n1,2,3,4\n", 4, "line 3 is empty, and spheres follow"},
      {"x,y,z,r\n1\n", 2, "1 field, but the header has 4"},
      {"x,y,z,r\n1,2", 2, "2 fields, but the header has 4"},
      {"x,y,z,r\n1,2,+-3,4\n", 2, "z = \"+-3\" is not a number"},
      {"x [mm],y [mm],z [mm],r\n1,2,3,4\n", 1, "x is in \"mm\" and r in no unit"},
      {"x (mm),y (mm),z (m),r (mm)\n1,2,3,4\n", 1, "x is in \"mm\" and z in \"m\""},
      {"x [px],y [px],z [px],r [px]\n1,2,3,4\n", 1, "unknown unit \"px\""},
      {"# unit: m\nx [mm],y [mm],z [mm],r [mm]\n1,2,3,4\n", 2, "is mm, and one before it says m"},
      {"# unit: m\n# unit: mm\nx,y,z,r\n1,2,3,4\n", 2, "is mm, and one before it says m"},
      {"# Columns: id, x, y, z, r\n1,2,3,4\n", 2, "expected a header"},
      {"x,y,z,r\n1,two,3,4\n", 2, "y = \"two\" is not a number"},
      {"x,y,z,r\n1,nan,3,4\n", 2, "y = \"nan\" is not finite"},
      {"x,y,z,r\n1,2,1e31,4\n", 2, "z = 1e+31 is beyond 1e+30"},
      {"x,y,z,r\n1,2,3,0\n", 2, "the radius 0 is not a length"},
      {"x,y,z,d\n1,2,3,-4\n", 2, "the diameter -4 is not a length"},
      {"x,y,z,d\n1,2,3,1e-31\n", 2, "the diameter 1e-31 is not a length"},
  };
  const Folder folder;
  for (const Refused& refused : cases) {
    const std::filesystem::path file = folder.write("bad.csv", refused.text);
    const Error error = error_of([&] { read_spheres(file); });
    EXPECT_EQ(error.code(), ErrorCode::bad_packing) << refused.text;
    EXPECT_EQ(error.location().line, refused.line) << error.what();
    EXPECT_NE(std::string(error.what()).find(refused.says), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

}  // namespace read_spheres_test
}  // namespace bernal
