#include "tests/golden/swarm/swarm_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/argos/light_flocking_form.h"

namespace gauntlet::golden {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// The layouts are the thesis author's and not part of the repository.
void ExpectEquivalentToArgos(const controllers::ControllerFactory& flockers) {
  if (!fs::is_directory(LayoutDirectory())) {
    GTEST_SKIP() << "no " << LayoutDirectory()
                 << "; set GAUNTLET_ARGOS_CASES to the directory of the author's files";
  }
  const auto cases = LoadSwarmCases(RecordedDirectory(), LayoutDirectory());
  if (!cases.ok() && cases.error().kind == ErrorKind::kNotFound) GTEST_SKIP() << cases.error().message;
  ASSERT_TRUE(cases.ok()) << cases.error().message;
  EXPECT_EQ(cases->size(), 14U);
  std::vector<CaseComparison> comparisons;
  for (const SwarmCase& swarm_case : *cases) comparisons.push_back(Compare(swarm_case, flockers));
  const Verdict verdict = Judge(comparisons);
  EXPECT_TRUE(verdict.holds) << verdict.table;
}

TEST(WholeSwarm, IsEquivalentToArgosWithinTheMarginsWrittenDownBefore) {
  ExpectEquivalentToArgos(BuiltInFlockers());
}

TEST(WholeSwarm, OfASourceForArgosIsSoToo) {
  ExpectEquivalentToArgos(argos_form::ExampleFlockers());
}

std::vector<CaseComparison> FourEqualCases() {
  std::vector<CaseComparison> comparisons(4);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const Ending ending{.light_distance = 1.0 + 0.1 * static_cast<double>(i), .stopped = 0.2, .clusters = 2};
    comparisons[i] = {.name = "case", .deviation = {}, .argos = ending, .ours = ending};
  }
  return comparisons;
}

TEST(WholeSwarm, JudgementBreaksWithAnyOfItsMargins) {
  EXPECT_TRUE(Judge(FourEqualCases()).holds);
  for (const EndMetric& metric : EndMetrics()) {
    auto comparisons = FourEqualCases();
    for (CaseComparison& comparison : comparisons) comparison.ours.*metric.value += 1.1 * metric.margin;
    EXPECT_FALSE(Judge(comparisons).holds) << metric.name;
  }
  auto comparisons = FourEqualCases();
  for (CaseComparison& comparison : comparisons) comparison.deviation[0] = 0.011;
  EXPECT_FALSE(Judge(comparisons).holds);
}

TEST(WholeSwarm, MissingLayoutsAndTicksAreNamed) {
  const fs::path empty = fs::path(testing::TempDir()) / "gauntlet-no-layouts";
  fs::create_directories(empty);
  const auto no_layout = LoadSwarmCases(RecordedDirectory(), empty);
  ASSERT_FALSE(no_layout.ok());
  EXPECT_THAT(no_layout.error().message, HasSubstr("no layout of env1"));

  const fs::path cut = fs::path(testing::TempDir()) / "gauntlet-cut-case";
  fs::create_directories(cut);
  std::ofstream(cut / "env1.csv") << "tick,robot,x,y,heading\n0,fb0,1,1,0\n";
  std::ofstream(cut / "env1.argos") << "<argos-configuration><arena size=\"6,6,1\"/></argos-configuration>";
  const auto no_tick = LoadSwarmCases(cut, cut);
  ASSERT_FALSE(no_tick.ok());
  EXPECT_THAT(no_tick.error().message, HasSubstr("tick 10 is missing"));
}

}  // namespace
}  // namespace gauntlet::golden
