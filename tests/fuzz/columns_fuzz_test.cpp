// One or two columns of numbers, which scenes name as the "file" of a list, a table or a sieve.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "files/npy_file.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"

namespace bernal {
namespace columns_fuzz_test {

constexpr std::array<std::string_view, 14> tokens = {"nan",  "inf",   "1e999", "5e-324", "-0", ";",  "\n",
                                                     "\r\n", ",,,\n", "#",     "0x1p3",  "+1", "\t", "1 2\n"};

/// Whatever the bytes: a scene that holds the numbers and can be written, or one line that says what is
/// wrong.
bool are_columns(const testing::Folder& folder, const std::string& text, const std::string& distribution) {
  const std::string columns = folder.write("columns.csv", text), scene = folder / "scene.toml";
  try {
    const Scene read = parse_scene(
        "[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\n"
        "diameter = { distribution = \"" +
            distribution + "\", file = \"columns.csv\" }\n",
        scene);
    EXPECT_FALSE(scene_as_toml(read).empty());
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    const std::string_view what = error.what();
    EXPECT_TRUE(what.starts_with(columns) || what.starts_with(scene)) << what;
    EXPECT_EQ(std::strpbrk(error.what(), "\n\r"), nullptr) << what;
    return false;
  }
}

std::string npy_of(const std::vector<double>& numbers) {
  std::string bytes = npy_header(numbers.size(), 0);
  for (const double number : numbers) bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  return bytes;
}

TEST(FuzzColumns, EveryMutationIsColumnsOrAnError) {
  const std::array<std::string, 4> valid = {
      "\xef\xbb\xbf# measured\nsize, density\n0.5, 0\n0.75; 1.5e-1\n1\t2\n1.25 1\r\n1.5, 0\n",
      "size passing\n0.5 0\n1 0.25\n2 0.75\n4 1\n", "# unit: mm\nd (mm)\n0.5\n 1 \n\n2e0\r\n0.5\n",
      npy_of({0.5, 1, 2})};
  const std::array<std::string, 4> of = {"table", "sieve", "list", "list"};
  const testing::Folder folder;
  for (std::size_t k = 0; k < valid.size(); ++k) EXPECT_TRUE(are_columns(folder, valid[k], of[k])) << of[k];
  const std::size_t mutations = testing::fuzz_inputs(3000);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < mutations; ++i) {
    Random random(1, stream(Stream::test, i));
    accepted += are_columns(folder, testing::mutated(valid[i % 4], tokens, random), of[i % 4]);
  }
  if (mutations < 1000) return;
  EXPECT_GT(accepted, mutations / 50);
  EXPECT_LT(accepted, mutations - mutations / 10);
}

// A file of one line without an end is not read to its end.
TEST(FuzzColumns, ALineThatIsTooLongIsRefusedAtOnce) {
  const testing::Folder folder;
  EXPECT_FALSE(are_columns(folder, std::string(1 << 20, '1'), "table"));
  EXPECT_TRUE(are_columns(folder, "1 2\n" + std::string(990, ' ') + "2 3\n", "table"));
}

}  // namespace columns_fuzz_test
}  // namespace bernal
