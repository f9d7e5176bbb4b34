// Covers: search/probability/probability_course.cc
#include "search/probability/probability_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/search/probability/toy_probability.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

std::unique_ptr<ProbabilityCourse> Driven(const ToySwarm& swarm, std::uint64_t seed, int runs,
                                          const std::vector<std::string>& more = {}) {
  auto course = ToyCourse(SetupOfToyProbability(seed, runs, more));
  DriveToy(*course, swarm, seed);
  return course;
}

// Thresholds of a standard normal value.
constexpr ToySwarm kThirty{0.524401}, kOne{2.326348}, kThousandth{3.090232}, kTenThousandth{3.719016};

TEST(ProbabilityCourseTest, CountsFrequentFailuresUntilTheyAreKnownWellEnough) {
  const auto course = Driven(kThirty, 1, 20'000);
  EXPECT_EQ(course->end(), ProbabilityEnd::kNarrow);
  EXPECT_EQ(course->runs(), 1000U);
  const ProbabilityEstimate known = course->Estimate(0.95);
  EXPECT_TRUE(known.valid_at_any_time);
  EXPECT_LT(known.interval.low, 0.3);
  EXPECT_GT(known.interval.high, 0.3);
  EXPECT_EQ(course->Failed().size(), course->plain_failures());
}

TEST(ProbabilityCourseTest, SplitsWhereFailuresAreRareAndTheConditionsDecide) {
  const auto course = Driven(kTenThousandth, 1, 20'000, {"probability.within=0"});
  EXPECT_EQ(course->reason(), SamplingReason::kSplitting);
  EXPECT_GT(course->pull(), 0.9);
  const ProbabilityEstimate known = course->Estimate(0.95);
  EXPECT_EQ(known.repeats.size() % ProbabilityCourse::kRepeats, 0U);
  EXPECT_LT(known.interval.low, 1e-4);
  EXPECT_GT(known.interval.high, 1e-4);
  double sum = 0.0;
  for (const FailedSample& failed : course->Failed()) sum += failed.share;
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST(ProbabilityCourseTest, ItsIntervalsCoverWhatIsRare) {
  // About .95 do; of 60, fewer than 51 have a probability of .0007.
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto [low, high] =
        Driven(kThousandth, seed, 20'000, {"probability.within=0"})->Estimate(0.95).interval;
    covered += low <= 1e-3 && 1e-3 <= high;
  }
  EXPECT_GE(covered, 51);
}

TEST(ProbabilityCourseTest, SamplesPlainlyWhereSplittingDoesNotPayAndSaysWhy) {
  EXPECT_EQ(Driven({3.090232, 1.0}, 1, 5000)->reason(), SamplingReason::kSeedDecides);
  EXPECT_EQ(Driven(kThousandth, 1, 3000)->reason(), SamplingReason::kFewRuns);
  EXPECT_EQ(Driven(kThousandth, 1, 5000, {"probability.plain=true"})->reason(), SamplingReason::kAsked);
  EXPECT_EQ(Driven(kThousandth, 1, 5000, {"requirements.near="})->reason(), SamplingReason::kNoScore);
  const auto asked = Driven(kThousandth, 1, 5000, {"probability.plain=true"});
  EXPECT_EQ(asked->end(), ProbabilityEnd::kBudget);
  EXPECT_EQ(asked->runs(), 5000U);
}

TEST(ProbabilityCourseTest, EndsAsSoonAsItIsSurelyOnOneSide) {
  EXPECT_EQ(Driven(kOne, 1, 20'000, {"probability.below=0.05"})->end(), ProbabilityEnd::kBelow);
  EXPECT_EQ(Driven(kThirty, 1, 20'000, {"probability.below=0.05"})->end(), ProbabilityEnd::kAbove);
  EXPECT_EQ(Driven(kOne, 1, 2000, {"probability.below=0.01"})->end(), ProbabilityEnd::kBudget);
}

TEST(ProbabilityCourseTest, CountsRunsWithoutAResultAsFailedAndRefusedOnesAsNot) {
  const auto course = ToyCourse(SetupOfToyProbability(1, 200));
  while (!course->AtEnd()) {
    for (const SettingsRun& run : course->Next()) {
      RunOutcome outcome;
      outcome.verdict = run.setting % 2 == 0 ? sim::Verdict::kCrashed : sim::Verdict::kRefused;
      course->Tell(run, outcome);
    }
  }
  EXPECT_EQ(course->without_result(), course->plain_failures());
  EXPECT_EQ(course->without_result() + course->refused(), course->plain_runs());
  EXPECT_EQ(course->Estimate(0.95).estimate, 0.5);
}

EvaluationOutcome OutcomeOf(const ProbabilitySearch& search, const EvaluationRequest& request) {
  const std::uint64_t number = request.individual - 1;  // behind the one case that was handed in
  return OutcomeOfRuns(request.individual, request.evaluation,
                       {kThousandth.Run(search.Probability()->SampleOf(number), number)});
}

std::vector<EvaluationRequest> Drive(ProbabilitySearch& search, std::size_t at_once,
                                     std::size_t stages = 1000) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished && !(search.AtBoundary() && search.Probability()->stages() == stages)) {
    for (EvaluationRequest& request : search.Ask()) all.push_back(std::move(request));
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told)
      search.Tell(OutcomeOf(search, all[told]));
  }
  return all;
}

TEST(ProbabilitySearchTest, AsksForTheSameHoweverOutcomesComeAndWhereverItWasStopped) {
  const SearchSetup setup = SetupOfToyProbability(3, 20'000, {"probability.within=0"});
  const auto whole = ProbabilitySearch::Create(setup).value();
  const auto requests = Drive(*whole, 1);
  ASSERT_EQ(whole->Probability()->reason(), SamplingReason::kSplitting);
  const auto stopped = ProbabilitySearch::Create(setup).value();
  auto before = Drive(*stopped, 60, 40);
  CanonicalEncoder encoder;
  stopped->Save(encoder);
  const std::string state = encoder.Take();
  const auto resumed = ProbabilitySearch::Create(setup).value();
  CanonicalDecoder decoder(state);
  ASSERT_TRUE(resumed
                  ->Restore(decoder,
                            [&](const auto& visit) -> Status {
                              for (const EvaluationRequest& request : before)
                                visit(OutcomeOf(*stopped, request));
                              return Ok{};
                            })
                  .ok());
  for (EvaluationRequest& request : Drive(*resumed, 13)) before.push_back(std::move(request));
  ASSERT_EQ(before.size(), requests.size());
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(before[i].individual, requests[i].individual);
    EXPECT_EQ(before[i].settings->disturbances.noise, requests[i].settings->disturbances.noise);
    seeds.insert(RunSeed(setup.experiment, requests[i], 0));
  }
  EXPECT_EQ(seeds.size(), requests.size());
  EXPECT_EQ(resumed->Probability()->Estimate(0.95).estimate, whole->Probability()->Estimate(0.95).estimate);
}

TEST(ProbabilitySearchTest, RefusesValuesThatBreakARuleOrBeginNoRun) {
  const auto refusal = [](const std::vector<std::string>& more) {
    return ProbabilitySearch::Create(SetupOfToyProbability(1, 1000, more)).error().message;
  };
  EXPECT_THAT(refusal({"conditions.random_faults.count=5..500"}), HasSubstr("random_faults.count = "));
  SearchSetup setup = SetupOfToyProbability(1, 1000);
  setup.cases.clear();
  EXPECT_THAT(ProbabilitySearch::Create(setup).error().message, HasSubstr("no case is given"));
}

}  // namespace
}  // namespace gauntlet
