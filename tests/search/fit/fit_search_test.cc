#include "search/fit/fit_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/search/fit/toy_fit.h"

namespace gauntlet {
namespace {

const std::string kTargets =
    "metric=fitness value=1.5 n=100; cases=given:1-2 metric=fitness value=1.5 n=20; "
    "statistic=every cases=empty runs=30 formula=birds_left >= 0";

SearchSetup SetupOfFit(const std::string& vary = kToyVary, const std::string& targets = kTargets) {
  static const SearchRow row = FitRow();
  Experiment experiment = FittedToy();
  experiment.fit = {.vary = vary, .targets = targets, .runs = 3000, .judged = 100};
  const sim::TestCase empty = EmptyArena(experiment.arena);
  SearchSetup setup = SetupOf(experiment, {}, {empty, empty});
  setup.cases[1].obstacles = {{.x = 1, .length = 1, .width = 0.2}};
  setup.row = &row;
  return setup;
}

std::unique_ptr<FitSearch> MakeFit(const SearchSetup& setup = SetupOfFit()) {
  return FitSearch::Create(setup).value();
}

// Where the settings of a request stand in their ranges.
SettingsPoint PlaceOf(const FitSearch& search, const EvaluationRequest& request) {
  Experiment experiment;
  static_cast<sim::RunSettings&>(experiment) = *request.settings;
  SettingsPoint place;
  for (const VariedKey& key : search.Fit()->plan().varied)
    place.push_back(key.PlaceOf(key.key.get(experiment)));
  return place;
}

EvaluationOutcome OutcomeOf(const FitSearch& search, const EvaluationRequest& request) {
  sim::RandomStream random(request.individual, sim::StreamPurpose::kTest, request.evaluation);
  return OutcomeOfRuns(request.individual, request.evaluation, {ToyRun(PlaceOf(search, request), random)});
}

// Tells `at_once` outcomes between two calls of Ask, until it has ended or its round is `until`.
std::vector<EvaluationRequest> Drive(FitSearch& search, std::size_t at_once, std::size_t until = 100) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished && !(search.AtBoundary() && search.Fit()->round() == until)) {
    for (EvaluationRequest& request : search.Ask()) all.push_back(std::move(request));
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told)
      search.Tell(OutcomeOf(search, all[told]));
  }
  return all;
}

TEST(FitSearchTest, EverySettingHasItsOwnRunsOnEveryKindOfCases) {
  const auto search = MakeFit();
  const auto requests = Drive(*search, 400);
  const FitPlan& plan = search->Fit()->plan();
  std::map<const sim::RunSettings*, std::size_t> runs;
  for (const EvaluationRequest& request : requests) ++runs[request.settings.get()];
  EXPECT_EQ(runs.size(), search->Fit()->settings().size());
  EXPECT_EQ(runs[requests.front().settings.get()], static_cast<std::size_t>(plan.RunsEach()));
  EXPECT_EQ(runs[requests.back().settings.get()], static_cast<std::size_t>(plan.RunsJudged()));
  EXPECT_EQ(search->Progress().evaluations_planned, requests.size());
  EXPECT_NE(search->Fit()->Chosen(), nullptr);
}

TEST(FitSearchTest, RandomCasesAreFreshForEachSetting) {
  const auto search = MakeFit(SetupOfFit(kToyVary, "metric=fitness value=1.5 n=100"));
  std::set<std::uint64_t> cases;
  const auto requests = Drive(*search, 400, 1);
  for (const EvaluationRequest& request : requests) cases.insert(CaseHash(request.test_case));
  EXPECT_EQ(cases.size(), requests.size());
}

TEST(FitSearchTest, ARangeOfGenesGoesIntoTheCases) {
  const auto search = MakeFit(SetupOfFit(kToyVary + " genome.genes=2..4", "metric=fitness value=1.5 n=100"));
  std::map<const sim::RunSettings*, std::set<std::size_t>> genes;
  for (const EvaluationRequest& request : search->Ask())
    genes[request.settings.get()].insert(request.test_case.obstacles.size());
  std::set<std::size_t> all;
  for (const auto& [settings, counts] : genes) {
    EXPECT_EQ(counts.size(), 1u);
    all.insert(counts.begin(), counts.end());
  }
  EXPECT_EQ(all, (std::set<std::size_t>{2, 3, 4}));
}

TEST(FitSearchTest, AsksTheSameHoweverManyOutcomesComeBetweenTwoAsks) {
  const auto one = MakeFit();
  const auto many = MakeFit();
  const auto first = Drive(*one, 7);
  const auto second = Drive(*many, 900);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].individual, second[i].individual);
    ASSERT_EQ(first[i].evaluation, second[i].evaluation);
    ASSERT_EQ(CaseHash(first[i].test_case), CaseHash(second[i].test_case));
    ASSERT_EQ(first[i].settings->controller_parameters, second[i].settings->controller_parameters);
  }
}

TEST(FitSearchTest, GoesOnFromASavedRoundAsIfItHadNotStopped) {
  const auto whole = MakeFit();
  const auto all = Drive(*whole, 400);
  const auto stopped = MakeFit();
  const auto before = Drive(*stopped, 400, 2);
  CanonicalEncoder encoder;
  stopped->Save(encoder);
  const std::string state = encoder.Take();

  const auto resumed = MakeFit();
  CanonicalDecoder decoder(state);
  const Status restored = resumed->Restore(decoder, [&](const auto& visit) -> Status {
    for (const EvaluationRequest& request : before) visit(OutcomeOf(*resumed, request));
    return Ok{};
  });
  ASSERT_TRUE(restored.ok()) << restored.error().message;
  const auto after = Drive(*resumed, 400);
  ASSERT_EQ(before.size() + after.size(), all.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i].individual, all[before.size() + i].individual);
    ASSERT_EQ(after[i].settings->controller_parameters,
              all[before.size() + i].settings->controller_parameters);
  }
}

TEST(FitSearchTest, JudgesAFewSettingsWhereEachBreaksACondition) {
  const SearchSetup setup = SetupOfFit(
      kToyVary, "metric=fitness value=1.5 n=100; statistic=every cases=empty runs=30 formula=birds_left < 0");
  const auto search = MakeFit(setup);
  const auto all = Drive(*search, 400);
  EXPECT_EQ(search->Fit()->Chosen(), nullptr);
  EXPECT_EQ(std::ranges::count_if(search->Fit()->settings(), &FitSetting::judged),
            static_cast<std::ptrdiff_t>(FitRounds::kCandidates));
  CanonicalEncoder encoder;
  search->Save(encoder);
  const std::string state = encoder.Take();
  CanonicalDecoder decoder(state);
  const auto again = MakeFit(setup);
  const Status restored = again->Restore(decoder, [&](const auto& visit) -> Status {
    for (const EvaluationRequest& request : all) visit(OutcomeOf(*again, request));
    return Ok{};
  });
  ASSERT_TRUE(restored.ok()) << restored.error().message;
  EXPECT_THAT(again->Ask(), testing::IsEmpty());
  EXPECT_TRUE(again->Progress().finished);
}

TEST(FitSearchTest, AStateOfOtherRunsIsDamaged) {
  const auto stopped = MakeFit();
  Drive(*stopped, 400, 1);
  CanonicalEncoder encoder;
  stopped->Save(encoder);
  const std::string state = encoder.Take();
  CanonicalDecoder decoder(state);
  const Status restored = MakeFit()->Restore(decoder, [](const auto&) -> Status { return Ok{}; });
  ASSERT_FALSE(restored.ok());
  EXPECT_THAT(restored.error().message, testing::EndsWith("but the runs of 0 are stored"));
}

TEST(FitSearchTest, NeedsTheCasesThatItsTargetsAreAbout) {
  SearchSetup setup = SetupOfFit();
  setup.cases.resize(1);
  EXPECT_EQ(FitSearch::Create(setup).error().message, "a target is about 2 cases, and 1 are given");
}

TEST(FitSearchTest, SettingsThatCannotBeSimulatedAreNeverDrawn) {
  // A flock of fewer birds than min_swarm, 5, fails before it begins.
  const auto search =
      MakeFit(SetupOfFit(kToyVary + " scenario_parameters.birds=3..8", "metric=fitness value=1.5 n=100"));
  Drive(*search, 400, FitPlan::kRounds);
  const auto draws = search->Fit()->Accepted(*search->Fit()->Posterior());
  ASSERT_FALSE(draws.empty());
  const VariedKey& birds = search->Fit()->plan().varied.back();
  for (const SettingsPoint& draw : draws) EXPECT_GE(std::get<std::int64_t>(birds.ValueAt(draw.back())), 5);
}

TEST(FitSearchTest, RangesInWhichNothingBeginsAreAnError) {
  const std::string targets = "metric=fitness value=1.5 n=100";
  EXPECT_THAT(FitSearch::Create(SetupOfFit("scenario_parameters.birds=1..4", targets)).error().message,
              testing::StartsWith("no setting of the ranges can be simulated: swarm-size: "));
  EXPECT_THAT(FitSearch::Create(SetupOfFit("genome.length_min=1.5..2 genome.length_max=0.5..1.4", targets))
                  .error()
                  .message,
              testing::StartsWith("no setting of the ranges can be simulated: genome.length_min = "));
}

TEST(FitSearchTest, ARunHasTheSettingsOfItsEvaluation) {
  const auto search = MakeFit();
  const EvaluationRequest request = search->Ask().front();
  Experiment experiment = FittedToy();
  const sim::RunSpec spec = SpecOfRun(experiment, request, 0);
  EXPECT_EQ(spec.controller_parameters, request.settings->controller_parameters);
  EXPECT_NE(spec.controller_parameters, experiment.controller_parameters);
}

}  // namespace
}  // namespace gauntlet
