// Every command of docs/from-argos.md, with the ARGoS of this machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

// Of what the shell calls argos3; empty where there is none.
fs::path ArgosProgram() {
  const std::vector<std::string> path = Words(RunProcess({"/bin/sh", "-c", "command -v argos3"}).out);
  return path.empty() ? fs::path() : fs::canonical(path.front());
}

TEST(FromArgosPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const fs::path argos = ArgosProgram();
  if (argos.empty())
    GTEST_SKIP() << "there is no argos3 in PATH: docs/from-argos.md is tested where ARGoS3 is installed";
  // The page tells people to give it to cmake.
  setenv("CMAKE_PREFIX_PATH", argos.parent_path().parent_path().c_str(), /*overwrite=*/1);
  const TemporaryDirectory scratch;
  fs::create_directories(scratch / "examples");
  fs::copy(GAUNTLET_SOURCE_DIR "/examples/argos-project", scratch / "examples/argos-project");
  const DocumentedPage page = ReadPage("from-argos.md");
  EXPECT_GE(page.commands.size(), 16U);
  EXPECT_GE(page.quoted.size(), 9U);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
  EXPECT_THAT(ReadFile(scratch / "failure.svg"), HasSubstr("<svg"));
  const std::string exported = ReadFile(scratch / "for-argos/run-121.argos");
  EXPECT_THAT(exported, HasSubstr("<qt-opengl"));
  EXPECT_THAT(exported, Not(HasSubstr("gauntlet_recorder")));
}

}  // namespace
}  // namespace gauntlet::testing_support
