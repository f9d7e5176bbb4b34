// A campaign is bound to how the controllers that it uses behave, and to nothing else of a build.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/integration/campaign_driver.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::ProcessResult;
using testing_support::SmallCampaign;
using testing_support::TemporaryDirectory;

class GoldenHashes : public testing::Test {
 protected:
  // gauntlet with a worker program whose golden hashes went through a command of sed.
  ProcessResult GauntletWhere(const std::string& sed, const std::vector<std::string>& arguments) {
    const std::string program = scratch_ / "worker";
    std::ofstream(program) << "#!/bin/sh\n"
                           << "[ \"$1\" != --golden ] || { '" << testing_support::WorkerPath()
                           << "' \"$@\" | sed '" << sed << "'; exit; }\n"
                           << "exec '" << testing_support::WorkerPath() << "' \"$@\"\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    return testing_support::StartGauntlet(arguments, {"GAUNTLET_WORKER=" + program})->Wait();
  }
  ProcessResult ResumeWhere(const std::string& sed) {
    return GauntletWhere(sed, {"resume", dir_, "--quiet"});
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "c";
};

TEST_F(GoldenHashes, OnlyOfControllersThatTheCampaignUsesMatter) {
  SmallCampaign campaign;
  campaign.generations = 2;
  // Made when there was no foraging yet.
  const ProcessResult made = GauntletWhere("/^foraging/d", EvolveArguments(campaign, dir_, 1));
  ASSERT_EQ(made.exit_code, 0) << made.err;

  const ProcessResult later = ResumeWhere("");
  EXPECT_EQ(later.exit_code, 0) << later.err;
  const ProcessResult other = ResumeWhere("s/^\\(foraging.*\\) .*/\\1 0000000000000bad/");
  EXPECT_EQ(other.exit_code, 0) << other.err;

  const ProcessResult changed = ResumeWhere("s/^flocking .*/flocking 0000000000000bad/");
  EXPECT_NE(changed.exit_code, 0);
  EXPECT_THAT(changed.err, AllOf(HasSubstr("the campaign was begun by version"),
                                 HasSubstr("controller 'flocking'"), HasSubstr("0000000000000bad")));
  const ProcessResult gone = ResumeWhere("/^flocking /d");
  EXPECT_NE(gone.exit_code, 0);
  EXPECT_THAT(gone.err, HasSubstr("the campaign uses controller 'flocking', which this build"));
}

}  // namespace
}  // namespace gauntlet
