// Every command of docs/bring-your-own-controller.md, run in its order.
// Covers: cli/argos_files.cc, cli/commands/build_controller_command.cc, sdk/example/my_bird.cc
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;

TEST(OwnControllerPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  // As in the source folder after a build, but for what the page writes.
  const TemporaryDirectory scratch;
  fs::create_directories(scratch / "build");
  fs::create_directory_symlink(fs::path(GAUNTLET_BINARY_DIR).parent_path(), scratch / "build/release");
  for (const char* folder : {"argos", "sdk"})
    fs::create_directory_symlink(std::string(GAUNTLET_SOURCE_DIR) + "/" + folder, scratch / folder);

  const DocumentedPage page = ReadPage("bring-your-own-controller.md");
  EXPECT_GE(page.commands.size(), 15U);
  EXPECT_GE(page.quoted.size(), 10U);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
  EXPECT_TRUE(fs::exists(scratch / "cases/case-04.argos"));
  EXPECT_TRUE(fs::exists(scratch / "corpus/run-139.json"));
}

}  // namespace
}  // namespace gauntlet::testing_support
