// The campaign loop and its searches: what is stored, told and acknowledged when, whatever happens meanwhile.
// Covers: master/campaign/campaign_summary.cc
#include "master/session/search_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "master/campaign/campaign_summary.h"
#include "master/store/event_kinds.h"
#include "proto/run_codec.h"
#include "search/search_table.h"
#include "tests/master/session/toy_campaign.h"

namespace gauntlet {
namespace {

using testing::IsEmpty;
using testing_support::MemoryStore;

// Equal for campaigns of the same outcome.
std::string EndOf(MemoryStore& store, const Experiment& experiment = ToyExperiment(),
                  SearchId search = kOnlySearch) {
  const Result<CampaignSummary> campaign = Summarise({{.experiment = experiment, .id = search}}, store);
  if (!campaign) return campaign.error().message;
  const SearchSummary& summary = campaign->searches.front();
  return fmt::format("{} in generation {} after {} runs", summary.state_hash, summary.progress.generation,
                     summary.runs_done);
}

std::vector<RunId> IdsIn(const MemoryStore& store) {
  std::vector<RunId> ids;
  for (const auto& [id, run] : store.runs) ids.push_back(id);
  return ids;
}

TEST(SearchLoopTest, EveryRunIsStoredWithWhatItWasMadeOf) {
  const Experiment experiment = ToyExperiment();
  const MemoryStore store = FinishedToyCampaign({experiment});
  ASSERT_FALSE(store.runs.empty());
  RunId expected = 1;
  for (const auto& [id, run] : store.runs) {
    EXPECT_EQ(id, expected++);
    EXPECT_EQ(run.seed, RunSeed(experiment, {.individual = run.individual, .evaluation = run.evaluation},
                                run.replicate));
    EXPECT_EQ(run.spec_hash, SpecHash(run.spec));
    const Result<sim::RunSpec> spec = proto::DecodeRunSpec(run.spec);
    const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
    ASSERT_TRUE(spec.ok() && result.ok());
    EXPECT_EQ(spec->seed, run.seed);
    EXPECT_EQ(run.fitness, result->fitness);
    EXPECT_EQ(run.hash, result->hash);
    EXPECT_EQ(run.total_failure, result->failure.total);
    EXPECT_EQ(run.worker, "fake");
  }
  EXPECT_EQ(store.searches.at(0).finished_with, store.runs.rbegin()->first);
  std::set<IndividualId> born;
  for (const Individual& individual : store.individuals.at(kOnlySearch)) born.insert(individual.id);
  for (const auto& [id, run] : store.runs) EXPECT_TRUE(born.contains(run.individual)) << run.individual;
}

TEST(SearchLoopTest, TheOrderOfResultsDoesNotMatter) {
  const std::vector<Experiment> experiments = {ToyExperiment()};
  MemoryStore in_order = FinishedToyCampaign(experiments);
  std::minstd_rand random(1);
  for (int i = 0; i < 6; ++i) {
    MemoryStore store;
    ToySession session(experiments, store);
    session.backend.slots = 1U + random() % 20;
    session.backend.per_poll = 1U + random() % 5;
    session.backend.next = [&](std::size_t running) { return i == 0 ? running - 1 : random() % running; };
    const Result<CampaignEnd> end = session.Run();
    ASSERT_TRUE(end.ok()) << end.error().message;
    EXPECT_EQ(*end, CampaignEnd::kFinished);
    EXPECT_EQ(EndOf(store), EndOf(in_order));
    EXPECT_EQ(IdsIn(store), IdsIn(in_order));
  }
}

TEST(SearchLoopTest, NothingIsAcknowledgedOrToldBeforeItIsDurable) {
  MemoryStore store;
  store.commits_by_itself = false;
  ToySession session({ToyExperiment()}, store);
  session.backend.per_poll = 3;
  int rounds = 0;
  const Result<CampaignEnd> end = session.Run([&] {
    EXPECT_LE(session.backend.acknowledged.size(), store.runs.size());
    EXPECT_EQ(session.drivers[0].totals().runs, session.backend.acknowledged.size());
    if (++rounds % 5 == 0) store.CommitAll();
    return StopWish::kNone;
  });
  ASSERT_TRUE(end.ok()) << end.error().message;
  EXPECT_EQ(session.backend.acknowledged.size(), session.backend.submitted.size());
  MemoryStore undisturbed = FinishedToyCampaign({ToyExperiment()});
  EXPECT_EQ(EndOf(store), EndOf(undisturbed));
  EXPECT_THAT(store.commits_wanted_within, testing::Contains(std::chrono::milliseconds(0)))
      << "a search that waits for its last results asks for a commit";
}

TEST(SearchLoopTest, ACommitWaitsForMoreResultsWhileWorkersHaveManyRunsAhead) {
  using std::chrono::milliseconds;
  Experiment experiment = ToyExperiment();
  experiment.search.algorithm = "random";
  experiment.search.parameters = {{"cases", 40.0}};
  for (const int workers : {1, 4}) {
    MemoryStore store;
    ToySession session({experiment}, store);
    session.backend.statistics.connected = workers;
    ASSERT_TRUE(session.Run().ok());
    const std::size_t runs = store.runs.size();
    ASSERT_GT(runs, 32U);
    // One result at a time: the last eight of each worker hurry, and the very last is waited for.
    EXPECT_EQ(store.commits_wanted_within.size(), 8U * static_cast<std::size_t>(workers)) << workers;
    EXPECT_EQ(std::ranges::count(store.commits_wanted_within, milliseconds(0)), 1) << workers;
  }
}

// The process dies after every number of results that there can be, with later results stored before earlier
// ones; what was not durable is lost.
TEST(SearchLoopTest, GoesOnFromWhereverItDied) {
  for (const char* algorithm : {"genetic", "steady-state", "random"}) {
    Experiment experiment = ToyExperiment();
    experiment.search.algorithm = algorithm;
    experiment.search.parameters = {{"cases", 12.0}};
    MemoryStore undisturbed = FinishedToyCampaign({experiment});
    for (std::size_t results = 1; results < undisturbed.runs.size(); results += 3) {
      MemoryStore store;
      {
        ToySession session({experiment}, store);
        session.backend.next = [](std::size_t running) { return running - 1; };
        const Result<CampaignEnd> end = session.Run([&] {
          if (store.runs.size() >= results) store.failure = Error{ErrorKind::kIo, "the disk is gone"};
          return StopWish::kNone;
        });
        ASSERT_FALSE(end.ok());
      }
      store.Crash();
      store.failure = {};
      const std::vector<RunId> survivors = IdsIn(store);
      ToySession session({experiment}, store);
      const Result<CampaignEnd> end = session.Run();
      ASSERT_TRUE(end.ok()) << algorithm << " " << results << ": " << end.error().message;
      EXPECT_EQ(EndOf(store, experiment), EndOf(undisturbed, experiment)) << algorithm << " " << results;
      EXPECT_EQ(IdsIn(store), IdsIn(undisturbed)) << algorithm << " " << results;
      for (const RunId id : session.backend.submitted)
        EXPECT_FALSE(std::ranges::binary_search(survivors, id)) << "run " << id << " was stored already";
    }
  }
}

TEST(SearchLoopTest, AStoredRunOfAnotherSpecIsRefused) {
  MemoryStore store = FinishedToyCampaign({ToyExperiment()});
  store.states.clear();
  store.searches[0].finished_with = 0;
  StoredRun& run = store.runs.at(3);
  Result<sim::RunSpec> spec = proto::DecodeRunSpec(run.spec);
  ASSERT_TRUE(spec.ok());
  spec->controller_parameters["gain"] = 2.0;
  run.spec = proto::EncodeRunSpec(*spec);
  const Result<CampaignEnd> end = ToySession({ToyExperiment()}, store).Run();
  ASSERT_FALSE(end.ok());
  EXPECT_EQ(end.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(end.error().message,
            "run 3 is stored with another spec than the search asks for: the campaign was made by another "
            "version, or its files were changed");
}

TEST(SearchLoopTest, AFullDiskStopsItAndAcknowledgesNothingMore) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  std::size_t durable = 0;
  const Result<CampaignEnd> end = session.Run([&] {
    if (store.runs.size() >= 5 && !store.failure) {
      store.failure = Error{ErrorKind::kNoSpace, "the disk is full"};
      durable = store.runs.size();
    }
    return StopWish::kNone;
  });
  ASSERT_FALSE(end.ok());
  EXPECT_EQ(end.error().kind, ErrorKind::kNoSpace);
  EXPECT_EQ(session.backend.acknowledged.size(), durable);
}

TEST(SearchLoopTest, WithoutWorkersItStopsWithAllResultsStored) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  const Result<CampaignEnd> end = session.Run([&] {
    if (session.backend.acknowledged.size() >= 4)
      session.backend.failure = Error{ErrorKind::kIo, "no worker can be started"};
    return StopWish::kNone;
  });
  ASSERT_FALSE(end.ok());
  EXPECT_EQ(end.error().message, "no worker can be started");
  EXPECT_GE(store.runs.size(), 4U);
}

TEST(SearchLoopTest, AWishToStopAtOnceStoresWhatHasComeBack) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  session.backend.per_poll = 2;
  const Result<CampaignEnd> end =
      session.Run([&] { return store.runs.size() >= 6 ? StopWish::kNow : StopWish::kNone; });
  ASSERT_TRUE(end.ok()) << end.error().message;
  EXPECT_EQ(*end, CampaignEnd::kStopped);
  EXPECT_EQ(session.backend.acknowledged.size(), store.runs.size());
  EXPECT_FALSE(session.backend.stopped_leasing);
  const Result<CampaignEnd> resumed = ToySession({ToyExperiment()}, store).Run();
  ASSERT_TRUE(resumed.ok());
  MemoryStore undisturbed = FinishedToyCampaign({ToyExperiment()});
  EXPECT_EQ(EndOf(store), EndOf(undisturbed));
}

TEST(SearchLoopTest, AWishToStopAfterTheRunsWaitsForThoseThatHaveBegun) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  session.backend.slots = 4;
  const Result<CampaignEnd> end =
      session.Run([&] { return store.runs.size() >= 3 ? StopWish::kAfterRuns : StopWish::kNone; });
  ASSERT_TRUE(end.ok()) << end.error().message;
  EXPECT_EQ(*end, CampaignEnd::kStopped);
  EXPECT_TRUE(session.backend.stopped_leasing);
  EXPECT_EQ(session.backend.Statistics().busy, 0);
  EXPECT_GE(store.runs.size(), 6U) << "three more had begun";
  EXPECT_LT(store.runs.size(), session.backend.submitted.size());
}

TEST(SearchLoopTest, AFinishedSearchWaitsForAudits) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  session.backend.statistics.audits_open = 1;
  int after_the_end = 0;
  const Result<CampaignEnd> end = session.Run([&] {
    if (store.searches.at(0).finished_with > 0 && ++after_the_end == 3)
      session.backend.statistics.audits_open = 0;
    return StopWish::kNone;
  });
  ASSERT_TRUE(end.ok());
  EXPECT_EQ(*end, CampaignEnd::kFinished);
  EXPECT_EQ(after_the_end, 3);
}

TEST(SearchLoopTest, WhatWasSeenOfAProgramIsKnownToTheNextMasterAndPartOfNoState) {
  Experiment experiment = ToyExperiment();
  experiment.scenario = "command";
  MemoryStore store;
  ToySession session({experiment}, store);
  session.backend.events = {{event::kNotReproducible, "run 1 ended differently"}};
  ASSERT_TRUE(session.Run().ok());
  EXPECT_EQ(ReadReproducibility(PlansOf({experiment}), store).value().Name(), "no");
  MemoryStore without = FinishedToyCampaign({experiment});
  EXPECT_EQ(EndOf(store, experiment), EndOf(without, experiment));
}

TEST(SearchLoopTest, SearchesOfASweepEndAsTheyWouldAlone) {
  const std::vector<Experiment> experiments = {ToyExperiment(1), ToyExperiment(2), ToyExperiment(3)};
  MemoryStore store;
  ToySession session(experiments, store);
  session.backend.next = [](std::size_t running) { return running / 2; };
  const Result<CampaignEnd> end = session.Run();
  ASSERT_TRUE(end.ok()) << end.error().message;
  std::size_t runs = 0;
  for (SearchId search = 1; search <= 3; ++search) {
    MemoryStore alone = FinishedToyCampaign({experiments[search - 1]});
    const Experiment& experiment = experiments[search - 1];
    EXPECT_EQ(EndOf(store, experiment, search), EndOf(alone, experiment)) << search;
    runs += alone.runs.size();
    EXPECT_GT(store.searches.at(search - 1).finished_with, 0U);
  }
  EXPECT_EQ(store.runs.size(), runs);
  ASSERT_FALSE(session.progress.empty());
  EXPECT_EQ(session.progress.back().runs_done, runs);
  EXPECT_EQ(session.progress.back().each.finished, 3U);
  EXPECT_EQ(session.loop->runs_done(), runs);
}

TEST(SearchLoopTest, NoMoreSearchesThanNeededHoldTheirRunsAtOnce) {
  std::vector<Experiment> experiments;
  for (std::uint64_t seed = 1; seed <= 70; ++seed) {
    experiments.push_back(ToyExperiment(seed));
    experiments.back().search.generations = 1;
    experiments.back().search.replicates = 1;
  }
  MemoryStore store;
  ToySession session(experiments, store);
  std::set<SearchId> first;
  const Result<CampaignEnd> end = session.Run([&] {
    if (first.empty()) {
      for (const RunId run : session.backend.submitted) first.insert(SearchOf(run));
    }
    return StopWish::kNone;
  });
  ASSERT_TRUE(end.ok());
  EXPECT_EQ(first.size(), 64U);
  EXPECT_EQ(std::ranges::count(store.searches, 0U, &StoredSearch::finished_with), 0);
}

TEST(SearchLoopTest, RunsWithoutAResultAreCountedAndDoNotStopIt) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store, [](const sim::RunSpec& spec) {
    sim::RunResult result = ToyRun(spec);
    if (spec.seed % 3 != 0) return result;
    result = {};
    result.verdict = spec.seed % 2 == 0 ? sim::Verdict::kRefused : sim::Verdict::kCrashed;
    result.message = "no-path: there is none";
    return result;
  });
  const Result<CampaignEnd> end = session.Run();
  ASSERT_TRUE(end.ok()) << end.error().message;
  EXPECT_EQ(*end, CampaignEnd::kFinished);
  const auto failed =
      std::ranges::count_if(store.runs, [](const auto& one) { return !one.second.completed(); });
  EXPECT_GT(failed, 0);
  EXPECT_EQ(session.drivers[0].totals().runs_failed, static_cast<std::uint64_t>(failed));
  EXPECT_EQ(session.progress.back().runs_failed, static_cast<std::uint64_t>(failed));
}

TEST(SearchLoopTest, WhatTheBackendReportsIsKept) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  session.backend.events = {{"worker-lost", "worker 1 is silent"}};
  ASSERT_TRUE(session.Run().ok());
  ASSERT_EQ(store.events.size(), 1U);
  EXPECT_EQ(store.events[0].kind, "worker-lost");
  EXPECT_EQ(store.events[0].text, "worker 1 is silent");
}

TEST(SearchLoopTest, ProgressEndsWhereTheCampaignDoes) {
  MemoryStore store;
  ToySession session({ToyExperiment()}, store);
  ASSERT_TRUE(session.Run().ok());
  const CampaignProgress& last = session.progress.back();
  EXPECT_EQ(last.runs_done, store.runs.size());
  EXPECT_EQ(last.runs_planned, store.runs.size());
  EXPECT_TRUE(last.search.finished);
  EXPECT_GT(last.runs_per_second, 0.0);
  EXPECT_EQ(last.remaining_seconds, 0.0);
  EXPECT_LE(last.best_fitness, last.mean_fitness);
}

}  // namespace
}  // namespace gauntlet
