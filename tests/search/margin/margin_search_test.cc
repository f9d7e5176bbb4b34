// Covers: search/settings/settings_search.cc
#include "search/margin/margin_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr const char* kDropRange = "noise.omnidirectional_camera.drop=0..0.5";

SearchSetup SetupOfMargin(const std::string& vary = kDropRange, std::size_t cases = 25) {
  Experiment experiment = ParseExperiment("", "toy.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
  experiment.search.algorithm = "margin";
  experiment.margin = {.vary = vary, .runs = 400};
  std::vector<sim::TestCase> given(cases, EmptyArena(experiment.arena));
  for (std::size_t i = 0; i < cases; ++i)
    given[i].obstacles = {{.x = 0.05 * static_cast<double>(i), .length = 0.4, .width = 0.1}};
  return SetupOf(experiment, {}, std::move(given));
}

double DropOf(const EvaluationRequest& request) {
  const auto& noise = request.settings->disturbances.noise;
  const auto found = noise.find(sim::Device::kOmnidirectionalCamera);
  return found == noise.end() ? 0.0 : found->second.drop;
}

// A swarm that fails from a drop of .3 on, and sometimes ends without a result.
EvaluationOutcome OutcomeOf(const EvaluationRequest& request) {
  RunOutcome run{.total_failure = DropOf(request) > 0.3};
  if (request.individual % 50 == 0) run.verdict = sim::Verdict::kHung;
  return OutcomeOfRuns(request.individual, request.evaluation, {run});
}

// Tells `at_once` outcomes between two calls of Ask, until `stages` have ended.
std::vector<EvaluationRequest> Drive(MarginSearch& search, std::size_t at_once, std::size_t stages = 100) {
  std::vector<EvaluationRequest> all;
  std::size_t told = 0;
  while (!search.Progress().finished && !(search.AtBoundary() && search.Margin()->stages() == stages)) {
    for (EvaluationRequest& request : search.Ask()) all.push_back(std::move(request));
    for (std::size_t i = 0; i < at_once && told < all.size(); ++i, ++told) search.Tell(OutcomeOf(all[told]));
  }
  return all;
}

std::unique_ptr<MarginSearch> MakeMargin(const SearchSetup& setup = SetupOfMargin()) {
  return MarginSearch::Create(setup).value();
}

TEST(MarginSearchTest, FindsWhereFailuresBeginWithCommonSeeds) {
  const SearchSetup setup = SetupOfMargin();
  const auto search = MakeMargin(setup);
  const auto requests = Drive(*search, 7);
  EXPECT_EQ(requests.size(), 400U);
  const MarginEstimate found = *search->Margin()->Estimate();
  EXPECT_LE(found.low, 0.3);
  EXPECT_GT(found.high, 0.3);
  EXPECT_LT(found.high - found.low, 0.01);
  // The first stage has twenty cases at six values; a case has the same seed at each of them.
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < 120; ++i) seeds.insert(RunSeed(setup.experiment, requests[i], 0));
  EXPECT_EQ(seeds.size(), 20U);
  // No run is made twice.
  std::set<std::pair<double, std::uint64_t>> runs;
  for (const EvaluationRequest& request : requests)
    runs.insert({DropOf(request), RunSeed(setup.experiment, request, 0)});
  EXPECT_EQ(runs.size(), requests.size());
}

TEST(MarginSearchTest, AsksForTheSameHoweverOutcomesComeAndWhereverItWasStopped) {
  const auto whole = MakeMargin();
  const auto requests = Drive(*whole, 1);
  const auto stopped = MakeMargin();
  auto before = Drive(*stopped, 60, 4);
  CanonicalEncoder encoder;
  stopped->Save(encoder);
  const std::string state = encoder.Take();
  const auto resumed = MakeMargin();
  CanonicalDecoder decoder(state);
  ASSERT_TRUE(resumed
                  ->Restore(decoder,
                            [&](const auto& visit) -> Status {
                              for (const EvaluationRequest& request : before) visit(OutcomeOf(request));
                              return Ok{};
                            })
                  .ok());
  for (EvaluationRequest& request : Drive(*resumed, 13)) before.push_back(std::move(request));
  ASSERT_EQ(before.size(), requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(before[i].individual, requests[i].individual);
    EXPECT_EQ(before[i].evaluation, requests[i].evaluation);
    EXPECT_EQ(DropOf(before[i]), DropOf(requests[i]));
  }
  EXPECT_EQ(resumed->Margin()->Estimate()->low, whole->Margin()->Estimate()->low);
}

TEST(MarginSearchTest, RefusesARunThatItWouldNotAskFor) {
  const auto stopped = MakeMargin();
  auto before = Drive(*stopped, 60, 2);
  CanonicalEncoder encoder;
  stopped->Save(encoder);
  const std::string state = encoder.Take();
  before.pop_back();
  const auto resumed = MakeMargin();
  CanonicalDecoder decoder(state);
  EXPECT_FALSE(resumed
                   ->Restore(decoder,
                             [&](const auto& visit) -> Status {
                               for (const EvaluationRequest& request : before) visit(OutcomeOf(request));
                               return Ok{};
                             })
                   .ok());
}

TEST(MarginSearchTest, RefusesAKeyThatDoesNothingOrBreaksARuleHalfWay) {
  const auto message = [](const std::string& vary) {
    const auto search = MarginSearch::Create(SetupOfMargin(vary));
    return search.ok() ? std::string("accepted") : search.error().message;
  };
  EXPECT_EQ(message(kDropRange), "accepted");
  EXPECT_THAT(message("noise.range_and_bearing.drop=0..1"),
              testing::StartsWith("noise.range_and_bearing.drop has no effect: robots of the controller "
                                  "'flocking' have no range_and_bearing; of noise they have "));
}

}  // namespace
}  // namespace gauntlet
