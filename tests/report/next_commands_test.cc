#include "report/tables/next_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/swept_campaign.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> CommandsFor(const CampaignSummary& summary, const CampaignAnswers& answers = {}) {
  std::vector<std::string> commands;
  for (const NextCommand& one : NextCommandsOf(summary, answers, "g", "d")) commands.push_back(one.command);
  return commands;
}

Confirmation FailingCase(RunId run) {
  Confirmation confirmation;
  confirmation.run = run;
  confirmation.verdict = FailureVerdict::kFail;
  confirmation.tally.failures = 5;
  return confirmation;
}

TEST(NextCommands, OfASweepNameTheRunBySearchAndCompareTheSettings) {
  CampaignSummary swept = SweptCampaign({SearchOfCases("a=1", 0, 2), SearchOfCases("a=2", 1, 2)});
  swept.searches[1].population[0].runs = {(RunId{1} << 40U) + 7};
  EXPECT_THAT(CommandsFor(swept),
              ElementsAre("g replay d 2:7 --svg run-2-7.svg", "g confirm d --all-failing --replicates 20",
                          "g compare d:search:1 d:search:2"));
}

TEST(NextCommands, AfterConfirmLeadOnToMinimiseAndBlame) {
  const CampaignSummary found = SweptCampaign({SearchOfCases("", 1, 2)});
  CampaignAnswers answers;
  answers.confirmations = {FailingCase(1)};
  EXPECT_THAT(CommandsFor(found, answers), ElementsAre("g minimise d 1", "g blame d 1"));
}

TEST(NextCommands, OfAnArchiveShowItsSmallestFailureAndConfirmItsElites) {
  CampaignSummary archive = SweptCampaign({SearchOfCases("", 2, 2, "archive")});
  SearchSummary& search = archive.searches.front();
  search.population[0].genome.resize(2);
  search.population[1].genome.resize(1);
  search.population[1].runs = {4, 9};
  search.archive.failures = {{.individual = 1}, {.individual = 2}};
  EXPECT_THAT(CommandsFor(archive),
              ElementsAre("g replay d 4 --svg case-2.svg", "g confirm d --elites --replicates 20"))
      << "named by the run in which it failed first, as the archive's rows and confirm name it";
}

TEST(NextCommands, AStreamGoesOnByTheCommandThatBeganIt) {
  const CampaignSummary stream = SweptCampaign({SearchOfCases("", 1, 2, "stream")});
  EXPECT_EQ(GoOnCommand(stream, "g", "d"), "g evaluate ... --stdin --dir d");
  EXPECT_EQ(GoOnCommand(SweptCampaign({SearchOfCases("", 1, 2)}), "g", "d"), "g resume d");
  EXPECT_THAT(CommandsFor(stream),
              ElementsAre("g replay d 1 --svg case-1.svg", "g confirm d --all-failing --replicates 20"));
}

TEST(NextCommands, OfWhatNeverFailedOnlyShowIt) {
  EXPECT_THAT(CommandsFor(SweptCampaign({SearchOfCases("", 0, 1)})),
              ElementsAre("g replay d 1 --svg case-1.svg"));
}

}  // namespace
}  // namespace gauntlet
