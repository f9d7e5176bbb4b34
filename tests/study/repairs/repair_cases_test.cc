#include "study/repairs/repair_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "search/cases/corpus_file.h"
#include "search/search_setup.h"
#include "study/questions/chosen_cases.h"
#include "study/questions/corpus_experiment.h"
#include "tests/study/questions/answering.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

class RepairCasesTest : public testing::Test {
 protected:
  // Random cases, the first `passing` of which are expected to pass.
  void WriteCorpus(std::size_t cases, std::size_t passing = 0) const {
    const auto drawn = DrawRandomCases(testing_support::Flocking(), static_cast<int>(cases)).value();
    for (std::size_t i = 0; i < cases; ++i) {
      CorpusCase one{.name = "case-" + std::to_string(i),
                     .expected = i < passing ? "pass" : "fail",
                     .settings = SettingsOf(testing_support::Flocking())};
      one.document.test_case = drawn[i];
      std::ofstream(scratch_ / (one.name + ".json")) << WriteCorpusCase(one);
    }
  }
  testing_support::TemporaryDirectory scratch_;
  Experiment experiment_ = testing_support::Flocking();
};

TEST_F(RepairCasesTest, HalfOfTheFailingCasesTrainAndTheOthersJudge) {
  WriteCorpus(26, 2);
  const auto chosen = ChooseRepairCases({.corpus = scratch_.path(), .random = 7}, experiment_).value();
  EXPECT_EQ(experiment_.repair.training, 12);
  EXPECT_EQ(experiment_.repair.guards, 12);
  EXPECT_EQ(experiment_.repair.units, "1 1 1 1 1 1 1 1 1 1 1 1");
  ASSERT_EQ(chosen.cases.size(), 12U + 12U + 12U + 7U);
  EXPECT_TRUE(chosen.notes.empty());
  std::set<std::uint64_t> different;
  for (const sim::TestCase& one : chosen.cases) {
    different.insert(CaseHash(one));
    EXPECT_NE(one.name, "case-0") << "it is expected to pass";
  }
  EXPECT_EQ(different.size(), chosen.cases.size());
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_THAT(chosen.cases[i].name, testing::StartsWith("case-"));
    EXPECT_THAT(chosen.cases[12 + i].name, testing::StartsWith("random "));
    EXPECT_THAT(chosen.cases[24 + i].name, testing::StartsWith("case-"));
  }
}

TEST_F(RepairCasesTest, TakesAtMostEightyAndTheSameForTheSameSeed) {
  WriteCorpus(100);
  const RepairCaseChoice choice{.corpus = scratch_.path()};
  const auto once = ChooseRepairCases(choice, experiment_).value();
  EXPECT_EQ(experiment_.repair.training, 40);
  const auto again = ChooseRepairCases(choice, experiment_).value();
  for (std::size_t i = 0; i < once.cases.size(); ++i) EXPECT_EQ(once.cases[i].name, again.cases[i].name);
}

TEST_F(RepairCasesTest, SaysWhereTheHeldOutCasesAreTooFew) {
  WriteCorpus(8);
  EXPECT_THAT(ChooseRepairCases({.corpus = scratch_.path()}, experiment_)->notes,
              ElementsAre("4 failing cases held out: fewer than 10 judge nothing"));
}

TEST_F(RepairCasesTest, SaysWhatIsWrong) {
  EXPECT_FALSE(ChooseRepairCases({.corpus = "/nowhere"}, experiment_).ok());
  EXPECT_FALSE(ChooseRepairCases({.corpus = "", .from = {"/nowhere"}}, experiment_).ok());
  WriteCorpus(3, 3);
  EXPECT_EQ(ChooseRepairCases({.corpus = scratch_.path()}, experiment_).error().message,
            scratch_.path() + " holds no case that fails: there is nothing to repair");
  Experiment foraging = LoadExperiment("foraging", {}, BuiltInCatalogue()).value();
  EXPECT_THAT(
      ChooseRepairCases({.corpus = scratch_.path()}, foraging).error().message,
      testing::HasSubstr("its cases are of the scenario 'flocking', and the controller is for 'foraging'"));
}

}  // namespace
}  // namespace gauntlet
