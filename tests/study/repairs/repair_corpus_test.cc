#include "study/repairs/repair_corpus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/system/atomic_file.h"
#include "search/cases/corpus_file.h"
#include "study/questions/corpus_experiment.h"
#include "tests/study/repairs/repaired_swarm.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing_support::RepairedSwarm;

TEST(RepairCorpus, ExpectsWhatTheRepairedControllerDoes) {
  const testing_support::TemporaryDirectory scratch;
  const std::string folder = scratch / "corpus";
  const Repair repair = RepairedSwarm([](double factor, double rate, std::size_t of_case) {
    return of_case == 30 || testing_support::FactorIsAtFault(factor, rate, of_case);
  });
  ASSERT_TRUE(WriteRepairedCorpus(repair, "dir", folder).ok());
  const std::vector<CorpusEntry> corpus = ReadCorpus(folder).value();
  EXPECT_EQ(corpus.size(), testing_support::kTrainingCases + testing_support::kHeldOut);
  EXPECT_EQ(std::ranges::count(corpus, "fail", [](const CorpusEntry& one) { return one.content.expected; }),
            1);
  for (const CorpusEntry& one : corpus) {
    const bool breaks = one.content.name == "case-31";
    EXPECT_EQ(one.content.expected, breaks ? "fail" : "pass") << one.content.name;
    EXPECT_EQ(one.content.found.failures, breaks ? 3 : 0);
    EXPECT_EQ(one.content.found.runs, 3);
    const Experiment experiment = ExperimentOf(one, {}, {}).value();
    EXPECT_EQ(experiment.controller_parameters.at("turning_speed_factor"),
              NumberOf(KeysOf(repair)[0].repaired));
  }
}

TEST(RepairCorpus, KeepsAFileThatIsThere) {
  const testing_support::TemporaryDirectory scratch;
  std::ofstream(scratch / "case-1.json") << "mine";
  ASSERT_TRUE(
      WriteRepairedCorpus(RepairedSwarm(testing_support::FactorIsAtFault), "dir", scratch.path()).ok());
  EXPECT_EQ(ReadSmallFile(scratch / "case-1.json", 100).value(), "mine");
}

}  // namespace
}  // namespace gauntlet
