// What a search is told of its runs, live and by a session that takes over what a former one has stored.
#include "master/session/search_driver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run_codec.h"
#include "tests/master/session/toy_campaign.h"

namespace gauntlet {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using testing_support::MemoryStore;

using Heard = std::vector<std::string>;

std::string TextOf(const EvaluationOutcome& outcome) {
  std::string text = fmt::format("individual {} evaluation {} completed {} fitness {}", outcome.individual,
                                 outcome.evaluation, outcome.completed, outcome.fitness);
  for (const RunOutcome& run : outcome.runs) {
    text += fmt::format("; verdict {} fitness {} total failure {} of type {}", static_cast<int>(run.verdict),
                        run.fitness, run.total_failure, run.failure_type);
    for (const auto& [name, value] : run.metrics) text += fmt::format(" {} = {}", name, value);
  }
  return text;
}

// A search that another one is told through: writes down every outcome, also those of a history.
class ListeningSearch final : public SearchAlgorithm {
 public:
  ListeningSearch(std::unique_ptr<SearchAlgorithm> search, bool wants_metrics, Heard& heard)
      : search_(std::move(search)), wants_metrics_(wants_metrics), heard_(heard) {}

  std::vector<EvaluationRequest> Ask() override { return search_->Ask(); }
  void Tell(const EvaluationOutcome& outcome) override {
    heard_.push_back(TextOf(outcome));
    search_->Tell(outcome);
  }
  bool WantsMetrics() const override { return wants_metrics_; }
  SearchProgress Progress() const override { return search_->Progress(); }
  const std::vector<Individual>& Population() const override { return search_->Population(); }
  std::vector<Individual> TakePopulation() override { return search_->TakePopulation(); }
  std::vector<Individual> TakeNewborns() override { return search_->TakeNewborns(); }
  std::vector<std::pair<std::string, double>> Statistics() const override { return search_->Statistics(); }
  bool AtBoundary() const override { return search_->AtBoundary(); }
  void Save(CanonicalEncoder& encoder) const override { search_->Save(encoder); }
  Status Restore(CanonicalDecoder& decoder, const History& history) override {
    Status told = history([this](const EvaluationOutcome& outcome) { heard_.push_back(TextOf(outcome)); });
    return told ? search_->Restore(decoder, history) : told;
  }

 private:
  std::unique_ptr<SearchAlgorithm> search_;
  bool wants_metrics_;
  Heard& heard_;
};

// The toy's runs, some of which crash.
sim::RunResult SometimesCrashes(const sim::RunSpec& spec) {
  sim::RunResult result = ToyRun(spec);
  if (spec.seed % 5 == 0) result.verdict = sim::Verdict::kCrashed;
  sim::SetHashes(result);
  return result;
}

struct Life {
  Heard heard;
  bool finished = false;
};

// A session with what `store` holds; it dies once so many results are stored.
Life Live(const Experiment& experiment, bool wants_metrics, MemoryStore& store, std::size_t results) {
  Life life;
  ToySession session({experiment}, store, SometimesCrashes, [&](const Experiment& one) {
    return std::make_unique<ListeningSearch>(MakeToySearch(one), wants_metrics, life.heard);
  });
  session.backend.next = [](std::size_t running) { return running - 1; };  // the newest first
  const Result<CampaignEnd> end = session.Run([&] {
    if (store.runs.size() >= results) store.failure = Error{ErrorKind::kIo, "the disk is gone"};
    return StopWish::kNone;
  });
  life.finished = end.ok() && *end == CampaignEnd::kFinished;
  return life;
}

class SearchDriverTest : public testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(SearchDriverTest, TellsTheSameLiveAndAfterACrash) {
  const auto [algorithm, wants_metrics] = GetParam();
  Experiment experiment = ToyExperiment();
  experiment.search.algorithm = algorithm;
  experiment.search.parameters = {{"cases", 12.0}};
  MemoryStore undisturbed;
  const Life whole = Live(experiment, wants_metrics, undisturbed, SIZE_MAX);
  ASSERT_TRUE(whole.finished);
  const std::string all = fmt::format("{}", fmt::join(whole.heard, "\n"));
  for (const char* part : {"verdict 3", "of type -1", "of type 0", "of type 2"}) {
    EXPECT_THAT(all, HasSubstr(part)) << "the toy's runs should differ";
  }
  EXPECT_EQ(all.find("fitness = ") != std::string::npos, wants_metrics);

  for (std::size_t results = 1; results < undisturbed.runs.size(); results += 3) {
    MemoryStore store;
    ASSERT_FALSE(Live(experiment, wants_metrics, store, results).finished);
    store.Crash();
    store.failure = {};
    const Life resumed = Live(experiment, wants_metrics, store, SIZE_MAX);
    EXPECT_TRUE(resumed.finished);
    EXPECT_THAT(resumed.heard, ElementsAreArray(whole.heard)) << "after a crash at " << results << " results";
  }
}

TEST(SearchDriverStoreTest, StoresTheWaysOfRobotsWhenAskedToAndThoseThatAProgramSaid) {
  for (const auto& [asked, program] :
       {std::pair(false, false), std::pair(true, false), std::pair(false, true)}) {
    Experiment experiment = ToyExperiment();
    experiment.store.trajectories = asked;
    if (program) experiment.scenario = "command";
    const bool trajectories = asked || program;
    MemoryStore store;
    ToySession session({experiment}, store, [](const sim::RunSpec& spec) {
      sim::RunResult result = ToyRun(spec);
      sim::RobotSummary& robot = result.robots.emplace_back();
      robot.path_length = 2.0;
      robot.waypoints = {{1.0, 2.0}, {3.0, 4.0}};
      result.annotations = {{.kind = "disc", .label = "goal", .points = {{0.0, 1.0}}, .robots = {}}};
      return result;
    });
    ASSERT_TRUE(session.Run().ok());
    const StoredRun& run = store.runs.at(1);
    const Result<sim::RunResult> stored = proto::DecodeStoredResult(run.result);
    ASSERT_TRUE(stored.ok()) << stored.error().message;
    EXPECT_EQ(stored->hash, run.hash);
    EXPECT_EQ(stored->robots.at(0).path_length, 2.0);
    EXPECT_EQ(stored->robots.at(0).waypoints.size(), trajectories ? 2U : 0U);
    EXPECT_EQ(stored->annotations.size(), trajectories ? 1U : 0U);
    EXPECT_NE(stored->without_ways, trajectories);
  }
}

INSTANTIATE_TEST_SUITE_P(Searches, SearchDriverTest,
                         testing::Combine(testing::Values("genetic", "steady-state", "random"),
                                          testing::Bool()));

}  // namespace
}  // namespace gauntlet
