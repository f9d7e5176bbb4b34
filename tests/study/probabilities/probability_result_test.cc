#include "study/probabilities/probability_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/search/probability/toy_probability.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

FailureProbability Found(const ToySwarm& swarm, const std::vector<std::string>& more = {}) {
  const SearchSetup setup = SetupOfToyProbability(1, 20'000, more);
  std::shared_ptr<ProbabilitySearch> search = ProbabilitySearch::Create(setup).value();
  while (!search->Progress().finished) {
    for (const EvaluationRequest& request : search->Ask()) {
      const std::uint64_t number = request.individual - 1;
      search->Tell(OutcomeOfRuns(request.individual, request.evaluation,
                                 {swarm.Run(search->Probability()->SampleOf(number), number)}));
    }
  }
  FailureProbability found{.experiment = setup.experiment, .search = search, .finished = true, .given = 1};
  found.estimate = found.course().Estimate(0.95);
  return found;
}

TEST(ProbabilityOutcomeTest, SaysHowProbableAndHowThatIsKnown) {
  EXPECT_THAT(
      OutcomeOf(Found({0.524401})),
      testing::MatchesRegex("The failure probability is 0\\.[0-9]+ \\(0\\.[0-9]+ to 0\\.[0-9]+, 95 %\\): "
                            "[0-9]+ of 1,?000 plain samples failed\\."));
  EXPECT_THAT(OutcomeOf(Found({3.719016})), HasSubstr("the mean of 10 repeats of splitting."));
  EXPECT_THAT(OutcomeOf(Found({20.0}, {"probability.below=0.01"})),
              HasSubstr("The failure probability is at most 0.00649 (0 to 0.00649, 95 %): 0 of"));
}

TEST(TellProbabilityTest, SaysHowItEndedAndWhatMoreRunsWouldGive) {
  const FailureProbability found = Found({2.326348}, {"probability.below=0.05"});
  const std::vector<Section> told = TellProbability(found, "campaigns/mine", "gauntlet");
  const std::string text = ToText(told.front());
  EXPECT_THAT(text, HasSubstr("noise.proximity.gaussian"));
  EXPECT_THAT(text, HasSubstr("It is surely below 0.05."));
  EXPECT_THAT(text, HasSubstr("would halve it"));
  const auto json = nlohmann::json::parse(ProbabilityJson(found, "campaigns/mine"));
  EXPECT_EQ(json["end"], "below");
  EXPECT_EQ(json["below"], 0.05);
  EXPECT_EQ(json["plain"]["n"], json["runs"]);
  EXPECT_LT(json["interval"][1], 0.05);
}

}  // namespace
}  // namespace gauntlet
