#include "report/tables/run_table.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controllers/registry.h"
#include "search/experiment/experiment_file.h"
#include "tests/master/session/toy_campaign.h"

namespace gauntlet {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_support::MemoryStore;

// Of a scenario that there is; its runs are the toy's, and so are two of its metrics.
SearchPlan Plan(const std::string& settings, const std::vector<std::string>& sets) {
  std::vector<std::string> all = {"search.population=6", "search.generations=4"};
  all.insert(all.end(), sets.begin(), sets.end());
  return {settings, *LoadExperiment("flocking", all, BuiltInCatalogue())};
}

sim::RunResult TableRun(const sim::RunSpec& spec) {
  sim::RunResult result = ToyRun(spec);
  result.failure.label = result.failure.total ? "apart" : "";
  if (result.failure.type == 0) result.failure = {true, -1, ""};
  result.metrics = {{"birds_left", 4.0}, {"split_time", result.fitness < 0.3 ? 1.5 : -1.0}};
  if (result.fitness > 0.9) {
    result.verdict = sim::Verdict::kCrashed;
    result.message = "it fell over";
    result.metrics.clear();
  }
  SetHashes(result);
  return result;
}

MemoryStore Campaign(const std::vector<SearchPlan>& plans) {
  std::vector<Experiment> experiments;
  for (const SearchPlan& plan : plans) experiments.push_back(plan.experiment);
  MemoryStore store;
  ToySession session(experiments, store, TableRun,
                     [](const Experiment& experiment) { return *MakeSearch(experiment); });
  EXPECT_TRUE(session.Run().ok());
  return store;
}

// The runs of a campaign as rows.
struct Rows {
  explicit Rows(const std::vector<SearchPlan>& plans, MemoryStore store = {}) {
    if (store.runs.empty()) store = Campaign(plans);
    const Result<RunTable> table = RunTable::Make(Numbered(plans), store);
    EXPECT_TRUE(table.ok());
    for (const DataColumn& column : table->columns()) names.push_back(column.name);
    for (const auto& [id, run] : store.runs) {
      rows.push_back(table->Row(run).value());
      EXPECT_EQ(rows.back().size(), names.size());
      stored.push_back(run);
    }
  }
  Value At(std::size_t row, const std::string& name) const {
    const auto place = std::ranges::find(names, name);
    EXPECT_NE(place, names.end()) << name;
    return rows.at(row).at(static_cast<std::size_t>(place - names.begin()));
  }

  std::vector<std::string> names;
  std::vector<std::vector<Value>> rows;
  std::vector<StoredRun> stored;
};

TEST(RunTable, HasTheColumnsThatScriptsRelyOn) {
  EXPECT_THAT(Rows({Plan("", {})}).names,
              ElementsAre("id", "run", "search", "search_name", "search_seed", "individual", "generation",
                          "evaluation", "replicate", "seed", "verdict", "fitness", "total_failure",
                          "failure_type", "failure", "birds_left", "split_time", "simulated_time",
                          "cpu_seconds", "hash", "worker", "attempt", "message"));
}

TEST(RunTable, SaysOfEveryRunWhatIsStored) {
  const Rows runs({Plan("", {"seed=18446744073709551615"})});
  ASSERT_GT(runs.rows.size(), 20U);
  int crashed = 0;
  int untyped = 0;
  for (std::size_t i = 0; i < runs.rows.size(); ++i) {
    const StoredRun& run = runs.stored[i];
    EXPECT_EQ(runs.At(i, "id"), Value(run.id));
    EXPECT_EQ(runs.At(i, "run"), Value("1:" + std::to_string(run.id)));
    EXPECT_EQ(runs.At(i, "search_name"), Value("flocking"));
    EXPECT_EQ(runs.At(i, "search_seed"), Value("18446744073709551615"));
    EXPECT_EQ(runs.At(i, "seed"), Value(std::to_string(run.seed)));
    EXPECT_EQ(runs.At(i, "individual"), Value(run.individual));
    const bool failed = !run.completed();
    EXPECT_EQ(runs.At(i, "verdict"), Value(failed ? "crashed" : "completed"));
    EXPECT_EQ(runs.At(i, "fitness"), failed ? Value() : Value(run.fitness));
    EXPECT_EQ(runs.At(i, "birds_left"), failed ? Value() : Value(4.0));
    // Nothing to measure is no -1.
    EXPECT_EQ(runs.At(i, "split_time"), run.fitness < 0.3 ? Value(1.5) : Value());
    EXPECT_EQ(runs.At(i, "message"), failed ? Value("it fell over") : Value());
    const bool total = run.total_failure;
    EXPECT_EQ(runs.At(i, "total_failure"), Value(total));
    EXPECT_EQ(runs.At(i, "failure_type"),
              run.failure_type < 0 ? Value() : Value(std::int64_t{run.failure_type}));
    EXPECT_EQ(runs.At(i, "failure"), !total                  ? Value()
                                     : run.failure_type >= 0 ? Value("apart")
                                                             : Value("without a split"));
    crashed += failed ? 1 : 0;
    untyped += total && run.failure_type < 0 ? 1 : 0;
  }
  EXPECT_GT(crashed, 0);
  EXPECT_GT(untyped, 0);
}

TEST(RunTable, EachKeyInWhichSearchesDifferHasAColumn) {
  const Rows runs({Plan("search.mutation_probability=0.02, seed 1",
                        {"seed=1", "search.mutation_probability=0.02", "scenario_parameters.birds=7"}),
                   Plan("search.mutation_probability=0.1, seed 2",
                        {"seed=2", "search.mutation_probability=0.1", "scenario_parameters.birds=9"})});
  EXPECT_THAT(runs.names, Contains("search.mutation_probability"));
  EXPECT_THAT(runs.names, Contains("scenario_parameters.birds"));
  EXPECT_THAT(runs.names, Each(Not(HasSubstr("crossover"))));
  const std::size_t last = runs.rows.size() - 1;
  EXPECT_EQ(runs.At(0, "search.mutation_probability"), Value(0.02));
  EXPECT_EQ(runs.At(last, "search.mutation_probability"), Value(0.1));
  EXPECT_EQ(runs.At(last, "search"), Value(std::uint64_t{2}));
  EXPECT_EQ(runs.At(last, "search_seed"), Value("2"));
  EXPECT_EQ(runs.At(last, "search_name"), Value("search.mutation_probability=0.1, seed 2"));
}

TEST(RunTable, ACampaignWithoutACompletedRunHasNoMetrics) {
  MemoryStore store = Campaign({Plan("", {})});
  std::erase_if(store.runs, [](const auto& run) { return run.second.completed(); });
  ASSERT_FALSE(store.runs.empty());
  EXPECT_THAT(Rows({Plan("", {})}, std::move(store)).names, Each(Not(HasSubstr("birds"))));
}

TEST(RunTable, AResultThatDoesNotReadBackIsNamed) {
  const std::vector<SearchPlan> plans = {Plan("", {})};
  MemoryStore store = Campaign(plans);
  const Result<RunTable> table = RunTable::Make(Numbered(plans), store);
  StoredRun damaged = store.runs.at(5);
  damaged.result = "nonsense";
  const Result<std::vector<Value>> row = table->Row(damaged);
  ASSERT_FALSE(row.ok());
  EXPECT_EQ(row.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(row.error().message, "run 5: the 8 bytes of the run result do not parse");
}

// Names in one table for all scenarios: a metric must not be called like another column.
TEST(RunTable, NoMetricHasTheNameOfAnotherColumn) {
  const RunColumns columns = CommonRunColumns();
  for (const controllers::ScenarioInfo& scenario : controllers::Scenarios()) {
    for (const controllers::MetricInfo& metric : scenario.metrics) {
      for (const auto* some : {&columns.before_metrics, &columns.after_metrics})
        EXPECT_EQ(std::ranges::count(*some, metric.name, &DataColumn::name), 0) << metric.name;
    }
  }
}

}  // namespace
}  // namespace gauntlet
