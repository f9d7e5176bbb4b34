// What an earlier version has stored is read, shown, replayed and continued (data/earlier_version/README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

class EarlierVersionTest : public testing::Test {
 protected:
  // A copy of what is kept, for the test to write into.
  std::string CopyOf(const std::string& name) const {
    const std::filesystem::path copy = std::filesystem::path(scratch_ / name);
    std::filesystem::copy(GAUNTLET_SOURCE_DIR "/tests/integration/data/earlier_version/" + name, copy,
                          std::filesystem::copy_options::recursive);
    return copy;
  }
  static std::string Done(const std::vector<std::string>& command) {
    const ProcessResult result = Gauntlet(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out + result.err;
  }
  TemporaryDirectory scratch_;
};

TEST_F(EarlierVersionTest, ItsCampaignIsShownReplayedAndMadeLonger) {
  const std::string dir = CopyOf("archive");
  EXPECT_THAT(Done({"show", dir}),
              HasSubstr("f4efc46e5135965b87704159b91303cfa17088b2937680fc8e129cbba29216e7"));
  EXPECT_THAT(Done({"replay", dir, "7"}), HasSubstr("(the same)"));
  Done({"report", dir, "-o", scratch_ / "report.html"});
  EXPECT_THAT(Done({"resume", dir, "--workers", "1", "--set", "search.runs=30"}), HasSubstr("30 runs"));
}

TEST_F(EarlierVersionTest, ItsStoppedCampaignEndsAsItWouldHaveAndIsComparedWithANewOne) {
  const std::string dir = CopyOf("stopped");
  EXPECT_THAT(Done({"resume", dir, "--workers", "1"}),
              HasSubstr("8b67df05c7fc6a1c9a4847704065137b124a3080bc4845533b2a354c806129bb"));
  const std::string anew = scratch_ / "anew";
  Done({"evolve", "flocking", "--population", "6", "--generations", "6", "--seed", "3", "--dir", anew});
  EXPECT_THAT(Done({"compare", dir, anew}), HasSubstr("same 6 cases"));
}

TEST_F(EarlierVersionTest, ItsStudyGoesOnWhateverDefaultsItsSearchesDoNotRead) {
  EXPECT_THAT(Done({"resume", CopyOf("study"), "--workers", "1"}), HasSubstr("evolved"));
}

}  // namespace
}  // namespace gauntlet::testing_support
