// The thesis' chapter 5 in small: ten evolutions per controller against random testing. Letters as in Table
// 5.5: I/VP is the improved controller on cases that were evolved against VP.
#include <gtest/gtest.h>

#include "tests/integration/study.h"

namespace gauntlet::testing_support {
namespace {

TEST(ForagingStudy, EvolvedCasesAreTougherAndTheImprovedControllerStandsThemBetter) {
  const Study study("foraging");
  const auto random = study.Random({"foraging", "foraging-improved"});
  const auto evolved = study.Evolved({"foraging", "foraging-improved"});

  PrintSamples({{"random, VP", random[0]},
                {"random, IVP", random[1]},
                {"VP/VP evolved for VP", evolved[0]},
                {"I/VP improved on those", evolved[1]}});
  ExpectTougherAndBetter(random[0], evolved);
  EXPECT_GE(MeanFitness(random[0]), 3.0);
  EXPECT_LE(MeanFitness(random[0]), 7.0);
  EXPECT_LE(ShareOf(random[0], &SimulatedCase::condition_2), 0.20);
  EXPECT_GT(ShareOf(evolved[0], &SimulatedCase::condition_1),
            ShareOf(random[0], &SimulatedCase::condition_1));
  EXPECT_GT(ShareOf(evolved[0], &SimulatedCase::condition_2),
            ShareOf(random[0], &SimulatedCase::condition_2));
}

// Without a pass mark: the figures are for controllers/foraging/README.md.
TEST(ForagingStudy, CasesEvolvedForTheImprovedController) {
  const Study study("foraging");
  const auto evolved = study.Evolved({"foraging-improved", "foraging"});
  PrintSamples({{"I/I evolved for IVP", evolved[0]}, {"VP/I VP on those", evolved[1]}});
  CompareSamples("I/I > VP/I", evolved[0], evolved[1]);
}

TEST(ForagingStudy, ARandomSideAlone) {
  const Study study("foraging");
  const auto random = study.Random({"foraging-random-side", "foraging"});
  const auto evolved = study.Evolved({"foraging-random-side", "foraging"});
  PrintSamples({{"random, random side", random[0]},
                {"random, VP", random[1]},
                {"R/R evolved for random side", evolved[0]},
                {"VP/R VP on those", evolved[1]}});
  CompareSamples("random side > VP on random", random[0], random[1]);
  CompareSamples("R/R > VP/R", evolved[0], evolved[1]);
}

}  // namespace
}  // namespace gauntlet::testing_support
