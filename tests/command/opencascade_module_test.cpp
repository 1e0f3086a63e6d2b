#include <filesystem>

#include "check.hpp"

namespace bernal::testing {
namespace opencascade_module_test {

namespace fs = std::filesystem;

const fs::path command = BERNAL_COMMAND;
const fs::path module = command.parent_path() / "src/libbernal_opencascade.so";
const std::string part = BERNAL_DATA "/meshes/block_fillets_bore.step";

/// Whether a command reads STEP when it is started in a folder.
bool reads_step(const fs::path& program, const fs::path& where) {
  const Ended ended = Process({"env", "--chdir=" + where.string(), program.string(), "inspect", part}).wait();
  if (ended.status != 0) {
    EXPECT_NE(ended.err.find("runs without OpenCASCADE"), std::string::npos) << ended.err;
  }
  return ended.status == 0;
}

class ModuleOfOpenCascade : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(module)) GTEST_SKIP() << "built without OpenCASCADE";
    fs::copy(command, folder_ / "bernal");
    if (reads_step(folder_ / "bernal", folder_.path()))
      GTEST_SKIP() << "a module is installed on this machine";
  }

  Folder folder_;
};

TEST_F(ModuleOfOpenCascade, IsNotTakenFromTheFolderThatOneStandsIn) {
  Folder elsewhere;
  fs::copy(module, elsewhere / "libbernal_opencascade.so");
  EXPECT_FALSE(reads_step(folder_ / "bernal", elsewhere.path()));
  EXPECT_TRUE(reads_step(command, elsewhere.path()));
}

TEST_F(ModuleOfOpenCascade, IsFoundWhereATreeIsCopied) {
  fs::create_directory(folder_ / "src");
  fs::copy(module, folder_ / "src/libbernal_opencascade.so");
  EXPECT_TRUE(reads_step(folder_ / "bernal", "/"));
}

TEST_F(ModuleOfOpenCascade, IsNotTakenWhereEverybodyMayWriteToIt) {
  fs::create_directory(folder_ / "src");
  fs::copy(module, folder_ / "src/libbernal_opencascade.so");
  fs::permissions(folder_ / "src/libbernal_opencascade.so", fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(reads_step(folder_ / "bernal", "/"));
}

}  // namespace opencascade_module_test
}  // namespace bernal::testing
