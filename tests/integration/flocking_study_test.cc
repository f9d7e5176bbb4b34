// The thesis' chapter 4 in small: ten evolutions against random testing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/integration/study.h"

namespace gauntlet {
namespace {

using testing_support::CompareSamples;
using testing_support::Comparison;
using testing_support::MeanFitness;
using testing_support::PrintSample;
using testing_support::Study;

TEST(FlockingStudy, EvolvedCasesAreTougherAndTheImprovedControllerStandsThemBetter) {
  const Study study("flocking");
  const auto random = study.Random({"flocking", "flocking-improved"});
  const auto original = study.Evolved({"flocking", "flocking-improved"});
  const auto improved = study.Evolved({"flocking-improved", "flocking"});

  fmt::print("\n");
  PrintSample("random, original", random[0]);
  PrintSample("random, improved", random[1]);
  PrintSample("F/F evolved for original", original[0]);
  PrintSample("I/F improved on those", original[1]);
  PrintSample("I/I evolved for improved", improved[0]);
  PrintSample("F/I original on those", improved[1]);
  const Comparison tougher = CompareSamples("random > evolved", random[0], original[0]);
  const Comparison better = CompareSamples("I/F > F/F", original[1], original[0]);
  CompareSamples("I/I > F/I", improved[0], improved[1]);

  EXPECT_GE(MeanFitness(random[0]), 0.55);
  EXPECT_LE(MeanFitness(random[0]), 0.75);
  EXPECT_LT(tougher.test.p_greater, 0.01);
  EXPECT_GT(tougher.lower_bound, 0.56);
  EXPECT_LT(better.test.p_greater, 0.01);
}

}  // namespace
}  // namespace gauntlet
