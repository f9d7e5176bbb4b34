// What is stored of cases, read back and told to their questions.
#include "study/questions/case_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/given/case_minimiser.h"
#include "search/given/repeated_case.h"
#include "study/questions/questioned_cases.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

sim::RunResult AlwaysFails(const EvaluationRequest&) {
  return Ended(true);
}

TEST(AnswersIn, GivesEachCaseItsRunsAndThoseOfItsLayouts) {
  const auto answers = Answers(
      MinimisationOf(Flocking(), false), {Walls(4), Walls(2, "walls.json")},
      [](const auto& request) { return Ended(Has(request.test_case, 1)); }, KeyOfCase);
  ASSERT_THAT(answers, SizeIs(2));
  EXPECT_EQ(answers[0].run, 17U);
  EXPECT_EQ(answers[1].run, 0U);
  EXPECT_EQ(answers[1].name, "walls.json");
  for (const CaseAnswer& one : answers) {
    EXPECT_TRUE(one.decided && one.ended) << one.name;
    EXPECT_TRUE(one.runs.front().as_it_is);
    EXPECT_FALSE(one.runs.back().as_it_is);
    EXPECT_EQ(one.runs.front().became.tally.failures, 1);
    EXPECT_THAT(one.runs.front().became.places, ElementsAre(sim::Vec2(-1.0, 0.5)));
    EXPECT_EQ(one.runs.front().result.metrics.size(), 3U);
    EXPECT_EQ(one.campaign, "d/asked/1");
  }
}

TEST(AnswersIn, WhatIsBeingFoundOutIsDecidedCaseByCaseAndHasNotEnded) {
  MemoryStore store;
  const std::vector<SearchPlan> plans = {{"", ConfirmationOf(Flocking(), 0), {Walls(1), Walls(2)}}};
  Answer(plans, AlwaysFails, store, /*most=*/7);
  const auto answers = AnswersIn(plans, store, "d", KeyOfCase).value();
  EXPECT_TRUE(answers[0].decided);
  EXPECT_FALSE(answers[1].decided);
  EXPECT_FALSE(answers[0].ended);
  EXPECT_THAT(BestOf(answers), SizeIs(1));
}

TEST(AnswersIn, RunsThatWereNotAskedForAreDamage) {
  MemoryStore store;
  const std::vector<SearchPlan> plans = {{"", ConfirmationOf(Flocking(), 0), {Walls(1)}}};
  Answer(plans, AlwaysFails, store);
  store.runs[99] = store.runs[1];
  store.runs[99].id = 99;
  const auto answers = AnswersIn(plans, store, "d", KeyOfCase);
  ASSERT_FALSE(answers.ok());
  EXPECT_EQ(answers.error().message, "run 17 has more runs than were asked for");
}

TEST(BestOf, OfOneKeyWhatStandsOnMostRunsElseTheFirst) {
  const auto few = Answers(ConfirmationOf(Flocking(), 0), {Walls(1)}, AlwaysFails, KeyOfCase).front();
  CaseAnswer many = few;
  many.runs.push_back(few.runs.front());
  many.name = "many";
  CaseAnswer other = few;
  other.name = "other";
  EXPECT_EQ(BestOf({few, many, other}).front().name, "many");
  EXPECT_EQ(BestOf({few, other}).front().name, "run 17");
  many.decided = false;
  EXPECT_EQ(BestOf({many, few}).front().name, "run 17");
}

TEST(CaseAnswer, TellsHowOftenItFailsAsItIsAndWhyARunHasNoResult) {
  const auto answer = Answers(
                          ConfirmationOf(Flocking(), 12), {Walls(1)},
                          [](const EvaluationRequest& request) {
                            sim::RunResult result = Ended(request.evaluation % 2 == 0);
                            if (request.evaluation != 3) return result;
                            result.verdict = sim::Verdict::kCrashed;
                            result.message = "crashed with signal 11";
                            return result;
                          },
                          KeyOfCase)
                          .front();
  EXPECT_EQ(answer.tally().failures, 6);
  EXPECT_EQ(answer.tally().passes, 5);
  EXPECT_EQ(answer.tally().errors, 1);
  EXPECT_EQ(answer.Message(), "crashed with signal 11");
  EXPECT_EQ(Renamed(answer, "run 23").run, 23U);
}

TEST(AnswersOfCalls, AreNoneWhereNobodyHasAsked) {
  EXPECT_THAT(*AnswersOfCalls("no-such-folder", KeyOfCase), IsEmpty());
}

}  // namespace
}  // namespace gauntlet
