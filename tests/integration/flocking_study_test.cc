// The thesis' chapter 4 in small: ten evolutions against random testing.
#include <gtest/gtest.h>

#include "tests/integration/study.h"

namespace gauntlet::testing_support {
namespace {

TEST(FlockingStudy, EvolvedCasesAreTougherAndTheImprovedControllerStandsThemBetter) {
  const Study study("flocking");
  const auto random = study.Random({"flocking", "flocking-improved"});
  const auto original = study.Evolved({"flocking", "flocking-improved"});
  const auto improved = study.Evolved({"flocking-improved", "flocking"});

  PrintSamples({{"random, original", random[0]},
                {"random, improved", random[1]},
                {"F/F evolved for original", original[0]},
                {"I/F improved on those", original[1]},
                {"I/I evolved for improved", improved[0]},
                {"F/I original on those", improved[1]}});
  CompareSamples("I/I > F/I", improved[0], improved[1]);
  ExpectTougherAndBetter(random[0], original);
  EXPECT_GE(MeanFitness(random[0]), 0.55);
  EXPECT_LE(MeanFitness(random[0]), 0.75);
}

}  // namespace
}  // namespace gauntlet::testing_support
