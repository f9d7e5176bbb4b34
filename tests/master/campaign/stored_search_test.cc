#include "master/campaign/stored_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "master/store/run_numbers.h"
#include "master/store/sqlite_schema.h"
#include "master/store/sqlite_store.h"
#include "proto/run_codec.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

// Remembers what its history was when it was restored.
class Rememberer : public SearchAlgorithm {
 public:
  explicit Rememberer(bool wants_metrics) : wants_metrics_(wants_metrics) {}
  std::vector<EvaluationRequest> Ask() override { return {}; }
  void Tell(const EvaluationOutcome&) override {}
  bool WantsMetrics() const override { return wants_metrics_; }
  SearchProgress Progress() const override { return {}; }
  const std::vector<Individual>& Population() const override { return population_; }
  std::vector<Individual> TakePopulation() override { return population_; }
  std::vector<Individual> TakeNewborns() override { return {}; }
  std::vector<std::pair<std::string, double>> Statistics() const override { return {}; }
  bool AtBoundary() const override { return true; }
  void Save(CanonicalEncoder&) const override {}
  Status Restore(CanonicalDecoder&, const History& history) override {
    return history([this](const EvaluationOutcome& outcome) { told.push_back(outcome); });
  }

  std::vector<EvaluationOutcome> told;

 private:
  bool wants_metrics_;
  std::vector<Individual> population_;
};

// Run `number` of search 1, the replicate of an evaluation of two.
StoredRun RunNumber(std::uint64_t number) {
  sim::RunResult result;
  result.fitness = 0.5 * static_cast<double>(number);
  result.metrics = {{"first_path_time", 10.0 * static_cast<double>(number)}, {"trapped", 2.0}};
  result.failure = {.total = number == 2, .type = number == 2 ? 7 : -1, .label = number == 2 ? "jam" : ""};
  if (number == 4) result.verdict = sim::Verdict::kCrashed;
  SetHashes(result);
  StoredRun run;
  run.id = RunIdOf(1, number);
  run.search = 1;
  run.individual = (number + 1) / 2;
  run.replicate = (number + 1) % 2;
  run.hash = result.hash;
  run.verdict = result.verdict;
  run.fitness = result.fitness;
  run.total_failure = result.failure.total;
  run.failure_type = result.failure.type;
  run.result = proto::EncodeRunResult(result);
  return run;
}

class StoredSearchTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = scratch_ / "campaign.db";
    ASSERT_TRUE(CreateDatabase(path, {}).ok());
    auto store = SqliteStore::Open(path, {});
    ASSERT_TRUE(store.ok());
    store_ = *std::move(store);
    store_->AddSearch({1, "toy", "toy", 7, false});
  }
  // Six runs, of which a state has seen four.
  void Fill() {
    for (std::uint64_t number = 1; number <= 6; ++number) store_->AddRun(RunNumber(number));
    store_->SaveState({1, 1, RunIdOf(1, 4), "state", std::string(32, 'd')});
    ASSERT_TRUE(store_->Flush().ok());
  }

  testing_support::TemporaryDirectory scratch_;
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(StoredSearchTest, ARestoredSearchHearsOfTheRunsThatItsStateHasSeen) {
  Fill();
  Rememberer search(/*wants_metrics=*/true);
  const Result<SavedProgress> saved = RestoreSearch(1, *store_, search);
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  EXPECT_EQ(saved->state, "state");
  EXPECT_EQ(saved->last_run, RunIdOf(1, 4));
  EXPECT_EQ(saved->results.bytes(), std::string(32, 'd'));
  ASSERT_EQ(search.told.size(), 2U);

  const EvaluationOutcome& first = search.told[0];
  EXPECT_EQ(first.individual, 1U);
  EXPECT_TRUE(first.completed);
  EXPECT_EQ(first.fitness, 0.75);
  ASSERT_EQ(first.runs.size(), 2U);
  EXPECT_THAT(first.runs[0].metrics, ElementsAre(Pair("first_path_time", 10.0), Pair("trapped", 2.0)));
  EXPECT_EQ(first.runs[0].failure_type, -1);
  EXPECT_TRUE(first.runs[1].total_failure);
  EXPECT_EQ(first.runs[1].failure_type, 7);

  const EvaluationOutcome& second = search.told[1];
  EXPECT_EQ(second.individual, 2U);
  EXPECT_EQ(second.fitness, 1.5) << "of the run that completed";
  EXPECT_EQ(second.runs[1].verdict, sim::Verdict::kCrashed);
}

TEST_F(StoredSearchTest, MetricsAreDecodedOnlyForThoseThatWantThem) {
  Fill();
  StoredRun damaged = RunNumber(1);
  damaged.result = "no result";
  EXPECT_TRUE(OutcomeOf(damaged, /*with_metrics=*/false).ok());
  EXPECT_FALSE(OutcomeOf(damaged, /*with_metrics=*/true).ok());
  Rememberer search(/*wants_metrics=*/false);
  ASSERT_TRUE(RestoreSearch(1, *store_, search).ok());
  ASSERT_EQ(search.told.size(), 2U);
  EXPECT_TRUE(search.told[0].runs[0].metrics.empty());
  EXPECT_EQ(search.told[0].runs[1].failure_type, 7);
}

TEST_F(StoredSearchTest, WithoutAStateTheSearchIsLeftAsItWasMade) {
  Rememberer search(/*wants_metrics=*/false);
  const Result<SavedProgress> saved = RestoreSearch(2, *store_, search);
  ASSERT_TRUE(saved.ok());
  EXPECT_EQ(saved->state, "");
  EXPECT_EQ(saved->last_run, RunIdOf(2, 1) - 1);
  EXPECT_TRUE(search.told.empty());
}

}  // namespace
}  // namespace gauntlet
