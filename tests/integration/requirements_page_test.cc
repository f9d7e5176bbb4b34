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
  ExpectCommandsSayWhatIsQuoted(kPage, 4, 5);
}

TEST(RequirementsPageTest, ItsExampleIsTheShippedOne) {
  EXPECT_THAT(ReadFile(GAUNTLET_SOURCE_DIR "/experiments/flocking-required.toml"),
              testing::HasSubstr(FencedText(kPage, "toml")));
}

}  // namespace
}  // namespace gauntlet::testing_support
