// The thesis' chapter 5 in small: ten evolutions per controller against random testing. Letters as in Table
// 5.5: I/VP is the improved controller on cases that were evolved against VP.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/integration/study.h"

namespace gauntlet {
namespace {

using testing_support::CompareSamples;
using testing_support::Comparison;
using testing_support::MeanFitness;
using testing_support::PrintSample;
using testing_support::ShareOf;
using testing_support::SimulatedCase;
using testing_support::Study;

TEST(ForagingStudy, EvolvedCasesAreTougherAndTheImprovedControllerStandsThemBetter) {
  const Study study("foraging");
  const auto random = study.Random({"foraging", "foraging-improved"});
  const auto evolved = study.Evolved({"foraging", "foraging-improved"});

  fmt::print("\n");
  PrintSample("random, VP", random[0]);
  PrintSample("random, IVP", random[1]);
  PrintSample("VP/VP evolved for VP", evolved[0]);
  PrintSample("I/VP improved on those", evolved[1]);
  const Comparison tougher = CompareSamples("random > VP/VP", random[0], evolved[0]);
  const Comparison better = CompareSamples("I/VP > VP/VP", evolved[1], evolved[0]);

  EXPECT_GE(MeanFitness(random[0]), 3.0);
  EXPECT_LE(MeanFitness(random[0]), 7.0);
  EXPECT_LE(ShareOf(random[0], &SimulatedCase::condition_2), 0.20);
  EXPECT_LT(tougher.test.p_greater, 0.01);
  EXPECT_GT(tougher.lower_bound, 0.56);
  EXPECT_GT(ShareOf(evolved[0], &SimulatedCase::condition_1),
            ShareOf(random[0], &SimulatedCase::condition_1));
  EXPECT_GT(ShareOf(evolved[0], &SimulatedCase::condition_2),
            ShareOf(random[0], &SimulatedCase::condition_2));
  EXPECT_LT(better.test.p_greater, 0.01);
}

// Without a pass mark (spec section 8): the figures are for controllers/foraging/README.md.
TEST(ForagingStudy, CasesEvolvedForTheImprovedController) {
  const Study study("foraging");
  const auto evolved = study.Evolved({"foraging-improved", "foraging"});
  fmt::print("\n");
  PrintSample("I/I evolved for IVP", evolved[0]);
  PrintSample("VP/I VP on those", evolved[1]);
  CompareSamples("I/I > VP/I", evolved[0], evolved[1]);
}

TEST(ForagingStudy, ARandomSideAlone) {
  const Study study("foraging");
  const auto random = study.Random({"foraging-random-side", "foraging"});
  const auto evolved = study.Evolved({"foraging-random-side", "foraging"});
  fmt::print("\n");
  PrintSample("random, random side", random[0]);
  PrintSample("random, VP", random[1]);
  PrintSample("R/R evolved for random side", evolved[0]);
  PrintSample("VP/R VP on those", evolved[1]);
  CompareSamples("random side > VP on random", random[0], random[1]);
  CompareSamples("R/R > VP/R", evolved[0], evolved[1]);
}

}  // namespace
}  // namespace gauntlet
