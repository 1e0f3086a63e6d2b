#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "bernal/core/error.hpp"
#include "bernal/result/read_packing.hpp"
#include "files/output_file.hpp"
#include "result/write_csv.hpp"
#include "scene/read_spheres.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace csv_fuzz_test {

constexpr std::array<std::string_view, 16> tokens = {
    "nan",  "inf", "1e999", "5e-324", "-0", ",,",           "\n",        "\r\n",
    "\n\n", "#",   "0x1p3", "+1",     " ",  "\xef\xbb\xbf", "x,y,z,r\n", "1,2,3,4\n"};

/// Whatever the bytes: `read` gives spheres, or one line that says where they are wrong.
template <typename Read>
bool are_spheres(const testing::Folder& folder, const std::string& text, const Read& read) {
  std::filesystem::remove(folder / "fuzz.csv");  // file systems wait for the disk when a file is overwritten
  const auto file = folder.write("fuzz.csv", text);
  try {
    const Spheres<dynamic> spheres = read(file).spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      EXPECT_TRUE(spheres.center(i).allFinite());
      EXPECT_TRUE(std::isfinite(spheres.r[i]) && spheres.r[i] > 0);
    }
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_packing);
    EXPECT_TRUE(std::string_view(error.what()).starts_with(file.string())) << error.what();
    EXPECT_EQ(std::strpbrk(error.what(), "\n\r"), nullptr) << error.what();
    return false;
  }
}

/// They can be written and read again, too. Writing waits for the disk, so that not every call does it.
bool is_a_packing(const testing::Folder& folder, const std::string& text, bool write_again) {
  if (!are_spheres(folder, text, read_csv)) return false;
  if (!write_again) return true;
  const auto file = folder / "fuzz.csv";
  const SpheresFile read = read_csv(file);
  std::filesystem::remove(file);
  OutputFile again(file);
  write_csv(again, testing::spheres_in(read.spheres));
  again.close();
  EXPECT_EQ(read_csv(file).spheres, read.spheres) << text;
  return true;
}

TEST(FuzzCsv, EveryMutationIsAPackingOrAnError) {
  const std::string valid =
      "# unit: mm\nx,y,z,r\n0.1,-2.5,1e-07,0.5\n1e+300,0,-0,5e-324\n3,4,5,6.25\n-7.125,8,9.5,10\n";
  const testing::Folder folder;
  ASSERT_TRUE(is_a_packing(folder, valid, true));
  const std::size_t mutations = testing::fuzz_inputs(3000);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < mutations; ++i) {
    Random random(1, stream(Stream::test, i));
    accepted += is_a_packing(folder, testing::mutated(valid, tokens, random), i % 50 == 0);
  }
  // The mutations must reach both sides of the line, or they test nothing.
  EXPECT_GT(accepted, mutations / 50);
  EXPECT_LT(accepted, mutations / 2);
}

TEST(FuzzCsv, OfAnotherProgramIsSpheresOrAnError) {
  const std::string valid =
      "# made elsewhere\nid; X; diameter; y; z\n1; 0.1; 0.5; -2.5; 1e-07\n2; 3; 4; 5; 6.25\n";
  const testing::Folder folder;
  const auto read = [](const std::filesystem::path& file) { return read_spheres(file); };
  ASSERT_TRUE(are_spheres(folder, valid, read));
  const std::size_t mutations = testing::fuzz_inputs(3000);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < mutations; ++i) {
    Random random(2, stream(Stream::test, i));
    accepted += are_spheres(folder, testing::mutated(valid, tokens, random), read);
  }
  EXPECT_GT(accepted, mutations / 50);
  EXPECT_LT(accepted, mutations / 2);
}

}  // namespace csv_fuzz_test
}  // namespace bernal
