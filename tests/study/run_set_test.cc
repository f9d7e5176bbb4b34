// Covers: study/sets/case_set.cc, study/sets/subset.cc
#include "study/sets/run_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "master/campaign/stored_search.h"
#include "search/experiment/experiment_file.h"
#include "study/sets/case_set.h"
#include "tests/master/session/toy_campaign.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_support::MemoryStore;

constexpr int kPopulation = 6;

// Of a scenario that there is, so that its search can be made again; its runs are the toy's.
Experiment SmallExperiment(const std::vector<std::string>& sets) {
  std::vector<std::string> all = {"search.population=6", "search.generations=4"};
  all.insert(all.end(), sets.begin(), sets.end());
  return *LoadExperiment("flocking", all, BuiltInCatalogue());
}

sim::RunResult SmallRun(const sim::RunSpec& spec) {
  sim::RunResult result = ToyRun(spec);
  result.metrics = {{"birds_left", std::floor(10.0 * result.fitness)},
                    {"split_time", result.fitness < 0.3 ? 1.0 : -1.0}};
  if (result.fitness > 0.9) result.verdict = sim::Verdict::kCrashed;
  SetHashes(result);
  return result;
}

MemoryStore Campaign(const std::vector<Experiment>& experiments) {
  MemoryStore store;
  ToySession session(experiments, store, SmallRun,
                     [](const Experiment& experiment) { return *MakeSearch(experiment); });
  EXPECT_TRUE(session.Run().ok());
  return store;
}

RunSet SetOf(const std::vector<Experiment>& experiments, MemoryStore& store, const std::string& subset,
             const std::string& metric = "fitness") {
  const std::vector<SearchPlan> plans = PlansOf(experiments);
  RunSet set;
  const Status added = AddRuns(plans, store, {"c", {}, "1", {}}, *ParseSubset(subset, "c"), metric, set);
  EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().message);
  return set;
}

std::vector<double> Flat(const RunSet& set) {
  std::vector<double> values;
  for (const auto& cluster : set.values.clusters) values.insert(values.end(), cluster.begin(), cluster.end());
  return values;
}

TEST(ParseSubsetTest, KnowsEverySubsetAndRefusesOthers) {
  EXPECT_EQ(ParseSubset("", "c")->kind, Subset::Kind::kFinal);
  EXPECT_EQ(ParseSubset("final", "c")->kind, Subset::Kind::kFinal);
  EXPECT_EQ(ParseSubset("all", "c")->kind, Subset::Kind::kAll);
  EXPECT_EQ(ParseSubset("random:100", "c")->count, 100U);
  EXPECT_EQ(ParseSubset("search:3", "c")->search, 3U);
  EXPECT_EQ(ParseSubset("search:3:random:5", "c")->count, 5U);
  for (const char* wrong : {"some", "random", "random:0", "random:x", "random:-1", "worst", "worst:0",
                            "search", "search:0", "search:x:all", "all:final", "random:1:2", ":"}) {
    const auto subset = ParseSubset(wrong, "c");
    ASSERT_FALSE(subset.ok()) << wrong;
    EXPECT_EQ(subset.error().message,
              "c: no subset '" + std::string(wrong) +
                  "'; known: final, all, random:N, worst:N, and search:N in front of them");
  }
}

TEST(SplitSetTest, RefusesWhatIsNamedTwice) {
  const testing_support::TemporaryDirectory folder;
  const std::string file = folder / "runs.csv";
  std::ofstream(file) << "a,b\n1,2\n";
  const auto two = SplitSet(file + ":a," + file + ":b");
  ASSERT_TRUE(two.ok()) << two.error().message;
  EXPECT_EQ(two->size(), 2u);
  const auto twice = SplitSet(file + ":a," + (folder / "./runs.csv") + ":a");
  ASSERT_FALSE(twice.ok());
  EXPECT_EQ(twice.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(twice.error().message, HasSubstr("./runs.csv:a is in the set"));
}

TEST(AddRunsTest, AnEvolutionIsOneUnitAndItsFinalRunsAreTheNewestOfItsMembers) {
  const std::vector<Experiment> experiments = {SmallExperiment({"search.replicates=2"})};
  MemoryStore store = Campaign(experiments);
  const RunSet set = SetOf(experiments, store, "");
  EXPECT_EQ(set.unit, "evolution");
  ASSERT_EQ(set.values.clusters.size(), 1U);
  // The whole population is simulated in every generation: the newest runs are those of the last.
  std::vector<double> last;
  std::size_t completed = 0;
  for (const auto& [id, run] : store.runs) {
    if (!run.completed()) continue;
    ++completed;
    if (id > store.runs.size() - 2 * kPopulation) last.push_back(run.fitness);
  }
  EXPECT_EQ(Flat(set), last);
  EXPECT_LT(last.size(), 2U * kPopulation) << "no run crashed: nothing is tested";
  ASSERT_EQ(set.notes.size(), 1U);
  EXPECT_EQ(set.notes[0], "c: " + std::to_string(2U * kPopulation - last.size()) +
                              " of 12 runs are left out: without a result, or without a value of fitness");
  EXPECT_EQ(Flat(SetOf(experiments, store, "all")).size(), completed);
  EXPECT_LT(completed, store.runs.size());
}

TEST(AddRunsTest, RandomCasesAreUnitsOfTheirOwn) {
  const std::vector<Experiment> experiments = {
      SmallExperiment({"search.algorithm=random", "search.cases=30", "search.replicates=3"})};
  MemoryStore store = Campaign(experiments);
  const RunSet set = SetOf(experiments, store, "final");
  EXPECT_EQ(set.unit, "case");
  EXPECT_EQ(set.values.clusters.size(), 30U);
  EXPECT_EQ(Flat(set), Flat(SetOf(experiments, store, "all")));
}

TEST(AddRunsTest, RandomRunsAreDrawnOnceEachAndTheSameEveryTime) {
  const std::vector<Experiment> experiments = {
      SmallExperiment({"search.algorithm=random", "search.cases=40"})};
  MemoryStore store = Campaign(experiments);
  std::vector<double> all = Flat(SetOf(experiments, store, "all"));
  std::vector<double> drawn = Flat(SetOf(experiments, store, "random:20"));
  EXPECT_EQ(drawn, Flat(SetOf(experiments, store, "random:20")));
  EXPECT_EQ(drawn.size(), 20U);
  std::ranges::sort(all);
  std::ranges::sort(drawn);
  EXPECT_TRUE(std::ranges::includes(all, drawn));  // all fitnesses differ: none was drawn twice
  EXPECT_EQ(std::ranges::adjacent_find(drawn), drawn.end());

  RunSet set;
  const Status added = AddRuns(PlansOf(experiments), store, {"c", {}, "1", {}},
                               *ParseSubset("random:41", "c"), "fitness", set);
  EXPECT_THAT(added.error().message, HasSubstr("c: 41 runs cannot be taken from "));
}

TEST(AddRunsTest, TheWorstAreThoseOfLowestFitnessWhateverIsCompared) {
  const std::vector<Experiment> experiments = {
      SmallExperiment({"search.algorithm=random", "search.cases=40"})};
  MemoryStore store = Campaign(experiments);
  std::vector<double> all = Flat(SetOf(experiments, store, "all"));
  std::ranges::sort(all);
  all.resize(5);
  std::vector<double> worst = Flat(SetOf(experiments, store, "worst:5"));
  std::vector<double> birds;
  for (const double value : worst) birds.push_back(std::floor(10.0 * value));
  EXPECT_EQ(Flat(SetOf(experiments, store, "worst:5", "birds_left")), birds);
  std::ranges::sort(worst);
  EXPECT_EQ(worst, all);
}

TEST(AddRunsTest, FailuresAndTheirTypesAreMetricsOfEveryScenario) {
  const std::vector<Experiment> experiments = {
      SmallExperiment({"search.algorithm=random", "search.cases=40"})};
  MemoryStore store = Campaign(experiments);
  int number = 0;
  for (auto& [id, run] : store.runs) {
    run.total_failure = ++number % 2 == 0;
    run.failure_type = number % 4 == 0 ? 7 : -1;
  }
  double failures = 0.0;
  for (const double value : Flat(SetOf(experiments, store, "all", "total_failure"))) failures += value;
  EXPECT_EQ(failures, std::ranges::count_if(store.runs, [](const auto& one) {
              return one.second.total_failure && one.second.completed();
            }));
  EXPECT_GT(failures, 10.0);
  const std::vector<double> types = Flat(SetOf(experiments, store, "all", "failure_type"));
  EXPECT_GT(types.size(), 5U);
  EXPECT_LT(types.size(), failures);
  EXPECT_THAT(types, testing::Each(7.0));
}

TEST(AddRunsTest, SearchesOfASweepAreUnitsAndCanBeTakenAlone) {
  const std::vector<Experiment> experiments = {SmallExperiment({}), SmallExperiment({"seed=2"})};
  MemoryStore store = Campaign(experiments);
  const RunSet both = SetOf(experiments, store, "");
  EXPECT_EQ(both.values.clusters.size(), 2U);
  ASSERT_EQ(both.origins.size(), 2U);
  EXPECT_EQ(both.origins[1].place, "c:search:2");
  EXPECT_EQ(SetOf(experiments, store, "search:2").values.clusters,
            (analysis::Clusters{both.values.clusters[1]}));
  RunSet set;
  const std::vector<SearchPlan> plans = PlansOf(experiments);
  EXPECT_EQ(AddRuns(plans, store, {"c", {}, "1", {}}, *ParseSubset("search:3", "c"), "fitness", set)
                .error()
                .message,
            "c has no search 3: its searches are 1 to 2");
}

TEST(AddRunsTest, MetricsAreReadAndThoseWithNothingToMeasureLeftOut) {
  const std::vector<Experiment> experiments = {
      SmallExperiment({"search.algorithm=random", "search.cases=40"})};
  MemoryStore store = Campaign(experiments);
  const std::vector<double> fitness = Flat(SetOf(experiments, store, "all"));
  std::vector<double> expected;
  for (const double value : fitness) expected.push_back(std::floor(10.0 * value));
  EXPECT_EQ(Flat(SetOf(experiments, store, "all", "birds_left")), expected);

  const RunSet splits = SetOf(experiments, store, "all", "split_time");
  EXPECT_EQ(Flat(splits).size(), static_cast<std::size_t>(std::ranges::count_if(
                                     fitness, [](double value) { return value < 0.3; })));
  ASSERT_EQ(splits.notes.size(), 1U);
  EXPECT_EQ(splits.notes[0],
            "c: " + std::to_string(40 - Flat(splits).size()) +
                " of 40 runs are left out: without a result, or without a value of split_time");

  RunSet set;
  EXPECT_EQ(AddRuns(PlansOf(experiments), store, {}, {}, "birds_lft", set).error().message,
            "unknown metric 'birds_lft'; did you mean 'birds_left'?");
}

TEST(AddRunsTest, HalfACampaignIsNamedAsSuch) {
  const std::vector<Experiment> experiments = {SmallExperiment({})};
  MemoryStore store = Campaign(experiments);
  store.searches[0].finished_with = 0;
  EXPECT_THAT(SetOf(experiments, store, "").notes,
              testing::Contains("c is half-finished: what it has so far is compared"));
}

std::vector<CaseSet> CasesIn(const std::vector<Experiment>& experiments, MemoryStore& store,
                             const std::string& subset) {
  const std::vector<SearchPlan> plans = PlansOf(experiments);
  const auto sets = CasesOf(plans, store, "c", *ParseSubset(subset, "c"));
  EXPECT_TRUE(sets.ok()) << (sets.ok() ? "" : sets.error().message);
  return sets.ok() ? *sets : std::vector<CaseSet>();
}

TEST(CasesOfTest, EveryMemberOfThePopulationOnceClonesIncluded) {
  const std::vector<Experiment> experiments = {SmallExperiment({"search.replicates=2"}),
                                               SmallExperiment({"seed=2"})};
  MemoryStore store = Campaign(experiments);
  const std::vector<CaseSet> sets = CasesIn(experiments, store, "final");
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets[0].place, "c:search:1");
  EXPECT_EQ(sets[1].place, "c:search:2");
  const auto search = MakeStoredSearch(PlansOf(experiments)[0], store);
  ASSERT_TRUE(search.ok());
  ASSERT_TRUE(RestoreSearch(1, store, **search).ok());
  std::vector<IndividualId> population;
  for (const Individual& one : (*search)->Population()) population.push_back(one.id);
  std::ranges::sort(population);
  std::vector<IndividualId> taken;
  for (const Individual& one : sets[0].members) taken.push_back(one.id);
  EXPECT_EQ(taken, population);
  for (const Individual& one : sets[0].members) EXPECT_EQ(one.test_case.obstacles.size(), 8U);
  EXPECT_GT(CasesIn(experiments, store, "search:1:all")[0].members.size(), population.size());
}

TEST(CasesOfTest, HalfACampaignIsNamedAsSuch) {
  const std::vector<Experiment> experiments = {SmallExperiment({})};
  MemoryStore store = Campaign(experiments);
  store.searches[0].finished_with = 0;
  EXPECT_THAT(
      CasesIn(experiments, store, "")[0].notes,
      ElementsAre("c is half-finished: the cases of 6 individuals that it has stored so far are taken"));
}

RunSet From(const Experiment& experiment, const std::string& version, std::uint64_t hash) {
  RunSet set;
  set.origins = {{"c-" + version, experiment, version, {{"flocking", hash}}}};
  return set;
}

TEST(WhatDiffersTest, ControllersMayDifferAndNothingElse) {
  const RunSet base = From(SmallExperiment({}), "1.0", 7);
  EXPECT_THAT(WhatDiffers(base, From(SmallExperiment({"controller=flocking-improved"}), "1.0", 7)),
              ElementsAre());
  EXPECT_THAT(WhatDiffers(base, From(SmallExperiment({}), "1.1", 7)), ElementsAre());
  EXPECT_THAT(
      WhatDiffers(base, From(SmallExperiment({}), "1.0", 8)),
      ElementsAre(
          "golden hash of controller flocking: c-1.0 has 0000000000000007, c-1.0 has 0000000000000008"));
  EXPECT_THAT(WhatDiffers(base, From(SmallExperiment({"scenario_parameters.time_limit=77"}), "1.0", 7)),
              ElementsAre("scenario_parameters.time_limit: c-1.0 has 900, c-1.0 has 77"));
  Experiment other = SmallExperiment({});
  other.scenario = "foraging";
  EXPECT_THAT(WhatDiffers(base, From(other, "1.0", 7)),
              ElementsAre("scenario: c-1.0 has flocking, c-1.0 has foraging"));
}

TEST(WhatDiffersTest, ScenariosOfOneNameInTwoLibrariesAreToldApart) {
  Experiment experiment = SmallExperiment({});
  experiment.scenario_plugin = std::string(64, 'a');
  const RunSet base = From(experiment, "1.0", 7);
  EXPECT_THAT(WhatDiffers(base, base), ElementsAre());
  experiment.scenario_plugin = std::string(64, 'b');
  EXPECT_THAT(WhatDiffers(base, From(experiment, "1.0", 7)),
              ElementsAre(HasSubstr("library of the scenario flocking: c-1.0 has aaaa")));
}

TEST(WhatDiffersTest, ScenariosThatFilesDefineAreToldApart) {
  const auto gathering = [](const std::vector<std::string>& sets) {
    return From(LoadExperiment("gathering", sets, BuiltInCatalogue()).value(), "1.0", 7);
  };
  const RunSet base = gathering({});
  EXPECT_THAT(WhatDiffers(base, gathering({"controller=flocking"})), ElementsAre());
  EXPECT_THAT(WhatDiffers(base, gathering({"generic.fitness=clusters"})),
              ElementsAre("generic.fitness: c-1.0 has 1 / (1 + goal_distance), c-1.0 has clusters"));
  EXPECT_THAT(WhatDiffers(base, gathering({"generic.nest.1.radius=1"})),
              testing::Contains("generic.nest.1.radius: c-1.0 has none, c-1.0 has 1"));
}

TEST(ReadRunSetTest, CsvColumnsAreSetsAndPathsMayHoldColonsAndCommas) {
  testing_support::TemporaryDirectory scratch;
  const std::string path = scratch / "a:b,c.csv";
  std::ofstream(path) << "fitness,other\n1,2\n3,4\n";
  const auto set = ReadRunSet(path, "fitness");
  ASSERT_TRUE(set.ok()) << set.error().message;
  EXPECT_THAT(Flat(*set), ElementsAre(1, 3));
  EXPECT_EQ(set->unit, "row");
  EXPECT_THAT(set->notes, testing::IsEmpty());
  const std::string gaps = scratch / "gaps.csv";
  std::ofstream(gaps) << "run,fitness\n1,7\n2,\n3,8\n";
  const auto with_gaps = ReadRunSet(gaps, "fitness");
  EXPECT_THAT(Flat(*with_gaps), ElementsAre(7, 8));
  EXPECT_THAT(with_gaps->notes,
              ElementsAre(gaps + ": 1 of 3 rows are left out: their cell of fitness is empty"));
  const std::string plain = scratch / "plain.csv";
  std::ofstream(plain) << "fitness\n5\n";
  EXPECT_THAT(Flat(*ReadRunSet(plain + "," + plain + ":fitness", "fitness")), ElementsAre(5, 5));
  EXPECT_THAT(ReadRunSet(plain, "other").error().message, HasSubstr("unknown column 'other'"));
}

TEST(ReadRunSetTest, SaysWhatSetsThereAre) {
  EXPECT_EQ(ReadRunSet("nowhere:final", "fitness").error().message,
            "nowhere:final: no such campaign or CSV file (DIR, DIR:final, DIR:all, DIR:random:100, "
            "DIR:search:2:final, FILE.csv:COLUMN)");
  EXPECT_EQ(ReadRunSet("", "fitness").error().message,
            ": no such campaign or CSV file (DIR, DIR:final, DIR:all, DIR:random:100, DIR:search:2:final, "
            "FILE.csv:COLUMN)");
}

}  // namespace
}  // namespace gauntlet
