#include "study/repairs/repair_proof.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/study/repairs/repaired_swarm.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::Contains;
using testing_support::FactorIsAtFault;
using testing_support::RepairedSwarm;

TEST(RepairProof, SearchesAnewAgainstEitherController) {
  const Repair repair = RepairedSwarm(FactorIsAtFault);
  const std::vector<SearchPlan> plans = ProofSearches(repair, 1000);
  ASSERT_EQ(plans.size(), 4U);
  std::vector<std::string> settings;
  for (const SearchPlan& one : plans) settings.push_back(one.settings);
  EXPECT_EQ(settings, (std::vector<std::string>{"original, genetic", "repaired, genetic", "original, archive",
                                                "repaired, archive"}));
  EXPECT_EQ(plans[1].experiment.search.generations, 50);
  EXPECT_EQ(plans[3].experiment.search.parameters.at("runs"), 1000);
  const auto factor = [](const SearchPlan& plan) {
    const auto found = plan.experiment.controller_parameters.find("turning_speed_factor");
    return found == plan.experiment.controller_parameters.end() ? 0.5 : found->second;
  };
  EXPECT_EQ(factor(plans[0]), 0.5);
  EXPECT_GE(factor(plans[1]), 0.7);
  EXPECT_EQ(factor(plans[3]), factor(plans[1]));
  EXPECT_EQ(ProofSearches(repair, 40).size(), 2U) << "an archive of 40 runs fills no cell";
}

TEST(RepairProof, TellsWhatTheyHaveFoundInTheSameTable) {
  Repair repair = RepairedSwarm(FactorIsAtFault);
  repair.fresh = {{"genetic search", {100, 90, 0, {0.0, 0.0}}, {100, 60, 0, {1.0, 0.0}}, false},
                  {"archive search", {100, 50, 9, {0.0}}, {100, 5, 4, {1.0}}, true}};
  const auto changes = nlohmann::json::parse(RepairJson(repair, "dir"))["changes"];
  EXPECT_EQ(changes[3]["cases"], "anew, genetic search");
  EXPECT_EQ(changes[3]["before"], 0.9);
  EXPECT_EQ(changes[3]["after"], 0.6);
  EXPECT_EQ(changes[3]["a"], 0.75);
  EXPECT_EQ(changes[3]["fewer_interval"], nullptr);
  EXPECT_EQ(changes[0]["a"], 1.0) << "every held-out run has a higher fitness than before";
  EXPECT_EQ(changes[1]["a"], 0.5) << "no random one has";
  EXPECT_THAT(TellRepair(repair, "dir", "gauntlet").front().sentences,
              Contains("The archive search fills 4 of its cells, 9 against the original."));
}

TEST(RepairProof, ThereIsNoneBeforeItWasSearched) {
  const testing_support::TemporaryDirectory scratch;
  EXPECT_TRUE(ReadFreshSearches(scratch.path())->empty());
}

}  // namespace
}  // namespace gauntlet
