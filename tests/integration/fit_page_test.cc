// Every command of docs/fit.md, run in its order, and what can be asked of a fit afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

TEST(FitPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "targets.toml") << FencedText("fit.md", "toml");
  const DocumentedPage page = ReadPage("fit.md");
  EXPECT_GE(page.commands.size(), 8U);
  EXPECT_GE(page.quoted.size(), 9U);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
  EXPECT_THAT(ReadFile(scratch / "fit.html"), HasSubstr("The chosen setting meets every target."));
  EXPECT_THAT(ReadFile(scratch / "fit.toml"), HasSubstr("algorithm = \"fit\""));

  const std::string fit = scratch / "campaigns/fit";
  const ProcessResult refused = Gauntlet({"compare", fit, fit + ":all"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is a fit: its runs have different settings"));
  // Of run 1, whose speed is none of the experiment's.
  const ProcessResult confirmed = Gauntlet({"confirm", fit, "1", "--replicates", "2", "--quiet"});
  EXPECT_EQ(confirmed.exit_code, 0) << confirmed.err;
  for (const auto& call : std::filesystem::directory_iterator(fit + "/confirm")) {
    if (!call.is_directory()) continue;
    EXPECT_THAT(ReadFile(call.path() / "experiment.toml"), testing::Not(HasSubstr("\nspeed = 0.05 ")));
  }
  const ProcessResult again =
      Gauntlet({"fit", fit, "--predict", "task-partitioning", "--draws", "2", "--json", "--set",
                "search.population=6", "--set", "search.generations=2"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, testing::Not(HasSubstr("draw 1 of 2"))) << "its draws are known";
}

}  // namespace
}  // namespace gauntlet::testing_support
