// Which cases a call asks about, and what is known of them already.
// Covers: study/questions/questioned_cases.cc
#include "study/questions/question.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "search/experiment/experiment_file.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"
#include "study/questions/question_table.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

Experiment Flocking(const std::vector<std::string>& sets = {}) {
  return *LoadExperiment("flocking", sets, BuiltInCatalogue());
}

// One wall at x.
sim::TestCase Wall(double x) {
  sim::TestCase one;
  one.obstacles.push_back({x, 0.0, 1.0, 0.2, 0.0});
  return one;
}

// Three runs of two cases: the first and the last are of one. As many as `--most` says are asked about.
Result<QuestionedCampaign> Questioned(const Asking& asking) {
  QuestionedCampaign questioned{{{"", Flocking()}}, {}};
  questioned.cases = {{"run 1", 0, Wall(0.5)}, {"run 2", 0, Wall(1.0)}, {"run 3", 0, Wall(0.5)}};
  questioned.cases.resize(static_cast<std::size_t>(WholeNumber(asking, "--most", 0, 3, 3).value()));
  return questioned;
}

std::vector<std::string> NamesOf(const Call& call) {
  std::vector<std::string> names;
  for (const SearchPlan& search : call.searches)
    for (const sim::TestCase& one : search.cases) names.push_back(one.name);
  return names;
}

Experiment Confirming(const Experiment& experiment) {
  return ConfirmationOf(experiment, 0);
}

Call Planned(const std::string& most = "3") {
  Question question = ConfirmQuestion();
  question.cases = Questioned;
  return PlanCall(question, {.place = "d", .options = {{"--most", {most}}}}).value();
}

TEST(RunOfName, IsTheNumberOfARunAndOfNothingElse) {
  EXPECT_EQ(RunOfName("run 17"), 17U);
  EXPECT_EQ(RunOfName("run 2:17"), (1ULL << 40U) + 17U);
  EXPECT_EQ(CurrentName("run 1099511627793"), "run 2:17") << "a stored answer of an older version";
  EXPECT_EQ(CurrentName("one-wall.json"), "one-wall.json");
  for (const char* none : {"", "run", "run ", "run x", "run 17 ", "run 1.json", "walls.json", "Run 17"})
    EXPECT_EQ(RunOfName(none), 0U) << none;
}

TEST(KeyOfCase, IsThatOfTheLayoutAndTheExperimentNotOfTheName) {
  sim::TestCase named = Wall(0.5);
  named.name = "a wall";
  EXPECT_EQ(KeyOfCase(Confirming(Flocking()), named), KeyOfCase(Confirming(Flocking()), Wall(0.5)));
  EXPECT_NE(KeyOfCase(Confirming(Flocking()), Wall(0.5)), KeyOfCase(Confirming(Flocking()), Wall(0.6)));
  EXPECT_NE(KeyOfCase(Confirming(Flocking()), Wall(0.5)),
            KeyOfCase(Confirming(Flocking({"seed=2"})), Wall(0.5)));
}

TEST(PlanCall, AsksAboutEqualCasesOnceAndFindsTheSameFolderAgain) {
  const Call call = Planned();
  EXPECT_THAT(NamesOf(call), ElementsAre("run 1", "run 2"));
  EXPECT_THAT(call.cases, SizeIs(3));
  EXPECT_EQ(call.cases[0].key, call.cases[2].key);
  EXPECT_THAT(call.directory, testing::StartsWith("d/confirm/"));
  EXPECT_EQ(Planned().directory, call.directory);
  EXPECT_NE(Planned("1").directory, call.directory);
  EXPECT_FALSE(Planned("0").Simulates());
}

TEST(Questions, AreDistinctAndSayWhatTheyAsk) {
  std::set<std::string> names;
  for (const auto question : kQuestions) {
    const Question row = question();
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_NE(row.tell, nullptr) << row.name;
    EXPECT_EQ(row.plan == nullptr, row.place == Question::Place::kCampaign) << row.name;
    EXPECT_EQ(row.about != nullptr, row.place == Question::Place::kCampaign) << row.name;
  }
}

TEST(WholeNumber, IsOfItsRangeOrNamesIt) {
  const Asking asking{.options = {{"--replicates", {"0"}}}};
  EXPECT_EQ(*WholeNumber({}, "--replicates", 1, 9, 7), 7);
  EXPECT_EQ(*WholeNumber(asking, "--replicates", 0, 9, 7), 0);
  EXPECT_EQ(WholeNumber(asking, "--replicates", 1, 9, 7).error().message,
            "--replicates 0: a whole number from 1 to 9 is needed");
}

}  // namespace
}  // namespace gauntlet
