#include "search/probability/splitting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "tests/search/probability/toy_probability.h"

namespace gauntlet {
namespace {

// The mean estimate over repeats whose scores are a function of the toy's.
double MeanEstimate(std::size_t particles, int repeats, double threshold,
                    const std::function<double(double)>& score_of) {
  const SearchSetup setup = SetupOfToyProbability(1, 1000);
  const Conditions conditions = Conditions::Make(setup, AllKeysOf(setup.experiment)).value();
  const ToySwarm swarm{threshold};
  double sum = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto seed = static_cast<std::uint64_t>(repeat);
    Splitting splitting(particles, {seed, sim::StreamPurpose::kProposals});
    std::vector<Sample> samples;
    while (!splitting.AtEnd()) {
      for (const SplittingRun& run : splitting.Next()) {
        const sim::RandomStream random(seed, sim::StreamPurpose::kTest,
                                       static_cast<std::uint32_t>(samples.size()));
        samples.push_back(run.near == kFreshSample ? conditions.Draw(random)
                                                   : conditions.Near(samples[run.near - 1], random));
        const RunOutcome outcome = swarm.Run(samples.back(), 1);
        splitting.Tell(run, samples.size(), score_of(outcome.metrics.front().second), outcome.total_failure);
      }
    }
    for (const std::uint64_t failing : splitting.Failing())
      EXPECT_TRUE(swarm.Run(samples[failing - 1], 1).total_failure);
    sum += *splitting.estimate();
  }
  return sum / repeats;
}

double Same(double score) {
  return score;
}

TEST(SplittingTest, IsRightOnAverage) {
  EXPECT_NEAR(MeanEstimate(100, 200, 1.2816, Same) / 0.1, 1.0, 0.05);
  EXPECT_NEAR(MeanEstimate(100, 300, 3.0902, Same) / 1e-3, 1.0, 0.12);
}

TEST(SplittingTest, TiesDoNoHarm) {
  const auto halves = [](double score) { return std::ceil(2.0 * score) / 2.0; };
  EXPECT_NEAR(MeanEstimate(100, 300, 3.0902, halves) / 1e-3, 1.0, 0.15);
}

TEST(SplittingTest, EndsAtOnceWhereMostRunsFailAndWhereNothingTellsThemApart) {
  EXPECT_EQ(MeanEstimate(10, 1, -20.0, Same), 1.0);
  EXPECT_EQ(MeanEstimate(10, 1, 20.0, [](double) { return 1.0; }), 0.0);
}

}  // namespace
}  // namespace gauntlet
