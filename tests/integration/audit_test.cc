// --audit: some runs are simulated by a second worker, and nothing else changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

TEST(AuditTest, ComparesRunsAndLeavesTheStateAlone) {
  const TemporaryDirectory scratch;
  std::vector<std::string> plain = EvolveArguments(SmallCampaign{}, scratch / "plain", 2);
  std::vector<std::string> audited = EvolveArguments(SmallCampaign{}, scratch / "audited", 2);
  std::erase(audited, "--quiet");
  audited.insert(audited.end(), {"--audit", "0.5"});
  ASSERT_EQ(Gauntlet(plain).exit_code, 0);
  const ProcessResult result = Gauntlet(audited);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // On a crowded machine the second worker may come late: then some are repeated on the only one.
  EXPECT_THAT(result.err, ContainsRegex("[1-9][0-9]* runs simulated on a second worker,.* all equal"));
  EXPECT_EQ(StateHash(scratch / "audited"), StateHash(scratch / "plain"));
}

TEST(AuditTest, AnImpossibleShareIsNamedBeforeAnythingIsWritten) {
  const TemporaryDirectory scratch;
  for (const std::string share : {"1.5", "-0.1", "some", "nan"}) {
    const ProcessResult result = Gauntlet({"evolve", "flocking", "--audit=" + share, "--dir", scratch / "c"});
    EXPECT_EQ(result.exit_code, 2) << share;
    EXPECT_THAT(result.err, HasSubstr("--audit " + share + ": must be a share from 0 to 1")) << share;
    EXPECT_EQ(Gauntlet({"show", scratch / "c"}).err,
              "gauntlet: there is no directory " + (scratch / "c") + "\n")
        << share;
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
