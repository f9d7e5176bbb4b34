#include "base/system/program_path.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace gauntlet {
namespace {

TEST(WorkerProgramPathTest, StandsBesideTheExecutableUnlessTheEnvironmentSaysOtherwise) {
  unsetenv("GAUNTLET_WORKER");
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  EXPECT_EQ(WorkerProgramPath(), self.substr(0, self.rfind('/')) + "/gauntlet-worker");
  setenv("GAUNTLET_WORKER", "/opt/other", 1);
  EXPECT_EQ(WorkerProgramPath(), "/opt/other");
  unsetenv("GAUNTLET_WORKER");
}

TEST(MasterProgramPathTest, IsTheExecutableUnlessTheEnvironmentSaysOtherwise) {
  unsetenv("GAUNTLET_PROGRAM");
  EXPECT_EQ(MasterProgramPath(), std::filesystem::read_symlink("/proc/self/exe"));
  setenv("GAUNTLET_PROGRAM", "", 1);
  EXPECT_EQ(MasterProgramPath(), std::filesystem::read_symlink("/proc/self/exe"));
  setenv("GAUNTLET_PROGRAM", "/opt/other", 1);
  EXPECT_EQ(MasterProgramPath(), "/opt/other");
  unsetenv("GAUNTLET_PROGRAM");
}

}  // namespace
}  // namespace gauntlet
