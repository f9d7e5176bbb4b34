// Every command of docs/requirements.md, run in its order, and its example held against the shipped one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kPage = "requirements.md";

TEST(RequirementsPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  const DocumentedPage page = ReadPage(kPage);
  EXPECT_EQ(page.commands.size(), 4U);
  EXPECT_EQ(page.quoted.size(), 5U);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
}

TEST(RequirementsPageTest, ItsExampleIsTheShippedOne) {
  EXPECT_THAT(ReadFile(GAUNTLET_SOURCE_DIR "/experiments/flocking-required.toml"),
              testing::HasSubstr(FencedText(kPage, "toml")));
}

}  // namespace
}  // namespace gauntlet::testing_support
