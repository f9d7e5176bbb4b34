#include "master/campaign/campaign_status.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

TEST(CampaignStatusTest, SaysWhoWasTurnedAwayWhileNobodyWorks) {
  BackendView backend;
  backend.queued = 20;
  EXPECT_EQ(WhyNothingRuns({}, {}, backend),
            "no worker is connected: start some with `gauntlet-worker --dir DIR`");
  backend.refused_workers = 2;
  backend.last_refusal = "this worker has software version 1, this master has 2";
  backend.unknown_keys = 1;
  backend.failed_handshakes = 80;
  const std::string why = WhyNothingRuns({}, {}, backend);
  EXPECT_EQ(why,
            "no worker is connected: start some with `gauntlet-worker --dir DIR`; 2 workers were refused, "
            "the last because this worker has software version 1, this master has 2; 1 connection was turned "
            "away for keys that are not this campaign's; 80 connections were dropped in the greeting (no "
            "keys, wrong ones, or no worker)");
}

TEST(CampaignStatusTest, AMasterWithWorkersOfItsOwnNeedsNobodyToStartThem) {
  BackendView backend;
  backend.own_workers = 1;
  EXPECT_EQ(WhyNothingRuns({}, {}, backend), "no worker is connected: 1 of the master's own is starting");
}

SearchProgress InGeneration(std::uint32_t generation, std::uint32_t generations, bool finished = false) {
  return {.generation = generation, .generations = generations, .finished = finished};
}

std::string InWords(const std::vector<SearchProgress>& searches) {
  SearchesProgress progress;
  for (const SearchProgress& one : searches) progress.Add(one);
  return progress.InWords();
}

TEST(SearchesProgressTest, TellsHowFarEachSearchIs) {
  EXPECT_EQ(InWords({InGeneration(12, 50)}), "generation 12/50");
  EXPECT_EQ(InWords({InGeneration(50, 50, true)}), "generation 50/50");
  EXPECT_EQ(InWords({InGeneration(1, 1)}), "") << "no generations";
  EXPECT_EQ(InWords({InGeneration(12, 50), InGeneration(14, 50), InGeneration(13, 50)}),
            "0 of 3 searches finished, all in generation 12 to 14 of 50");
  EXPECT_EQ(InWords({InGeneration(50, 50, true), InGeneration(14, 50)}),
            "1 of 2 searches finished, the others in generation 14 of 50");
  EXPECT_EQ(InWords({InGeneration(1, 1, true), InGeneration(1, 1)}), "1 of 2 searches finished");
  EXPECT_EQ(InWords({InGeneration(50, 50, true), InGeneration(50, 50, true)}), "2 searches finished");
}

TEST(CampaignStatusTest, ALeaseBeyondTheSlotsWaits) {
  BackendView backend;
  WorkerView& worker = backend.workers.emplace_back();
  worker.leases = {{39, 0x100000027, 1, 4.2, false}, {40, 0x100000028, 3, 4.1, true}};
  const auto json = nlohmann::json::parse(StatusJson({}, {}, backend));
  EXPECT_EQ(json.at("runs_running"), 1);
  EXPECT_EQ(json.at("runs_ahead"), 1);
  const auto& runs = json.at("worker_list").at(0).at("runs");
  EXPECT_EQ(runs.at(0).at("state"), "running");
  EXPECT_EQ(runs.at(0).at("lease"), "100000027");
  EXPECT_EQ(runs.at(1).at("state"), "waiting");
  EXPECT_EQ(runs.at(1).at("attempt"), 3);
}

// Of thousands the file would take the master longer than its runs.
TEST(CampaignStatusTest, ListsTwoHundredWorkersAndCountsTheOthers) {
  BackendView backend;
  for (int i = 0; i < 4096; ++i) backend.workers.emplace_back().label = std::to_string(i);
  backend.workers[4000].lost = true;
  const auto json = nlohmann::json::parse(StatusJson({}, {}, backend));
  EXPECT_EQ(json.at("worker_list").size(), 200U);
  EXPECT_EQ(json.at("worker_list").at(0).at("worker"), "4000") << "about whom there is something to say";
  EXPECT_EQ(json.at("workers_not_listed").at("idle"), 4096 - 200);
  EXPECT_EQ(json.at("workers_not_listed").at("lost"), 0);
}

TEST(CampaignStatusTest, WordsOfOthersThatAreNotUtf8AreShownAllTheSame) {
  BackendView backend;
  backend.pool_trouble = "sbatch: erreur \xe9";
  backend.allocations.push_back({"12", "PENDING", "\xff", "\xff", 0, false});
  backend.workers.emplace_back().label = "\xff";
  const auto json = nlohmann::json::parse(StatusJson({}, {}, backend));
  EXPECT_EQ(json.at("pool_trouble"), "sbatch: erreur \ufffd");
}

// A master's own count begins at 0 when it starts; what its predecessors found still voids the claims.
TEST(CampaignStatusTest, DifferencesUnderFormerMastersCount) {
  MasterView master;
  master.nondeterministic_before = 2;
  CampaignProgress progress;
  progress.workers.nondeterministic = 1;
  EXPECT_EQ(nlohmann::json::parse(StatusJson(master, progress, {})).at("nondeterministic"), 3);
}

}  // namespace
}  // namespace gauntlet
