// What waiting costs: the share of their time for which workers have nothing to do, generation by generation
// and in the steady-state search, in virtual time with heavy-tailed durations. A table in Markdown.
#include <cmath>
#include <cstdio>
#include <vector>

#include "search/search_table.h"
#include "tests/search/simulated_cluster.h"
#include "tests/search/toy_search.h"

namespace gauntlet {
namespace {

SearchSetup ReportSetup() {
  SearchSetup setup = ToySetup();
  setup.experiment.search.parent_selection = ParentSelection::kAllParentBestHalf;
  return setup;
}

void Row(const char* name, const SearchSetup& setup) {
  std::printf("| %s |", name);
  for (const int workers : {2, 4, 8, 16, 64}) {
    const auto search = RowOf(setup.experiment).make(setup);
    if (!search.ok()) return;
    std::printf(" %.0f %% |", 100.0 * RunOnCluster(**search, workers, HeavyTailed, SumOfX).idle_share);
  }
  std::printf("\n");
}

void Table(int population, int generations, const std::vector<int>& lags) {
  std::printf("\n| %d generations of %d | 2 workers | 4 | 8 | 16 | 64 |\n|---|---|---|---|---|---|\n",
              generations, population);
  SearchSetup setup = ReportSetup();
  setup.experiment.search.population = population;
  setup.experiment.search.generations = generations;
  Row("generational", setup);
  SetAlgorithm(setup, "steady-state");
  for (const int lag : lags) {
    setup.experiment.search.parameters["lag"] = lag;
    char name[32];
    std::snprintf(name, sizeof(name), "steady-state, lag %d", lag);
    Row(name, setup);
  }
}

void ArchiveTable() {
  std::printf("\n| 600 runs | 2 workers | 4 | 8 | 16 | 64 |\n|---|---|---|---|---|---|\n");
  SearchSetup setup = ReportSetup();
  setup.experiment.scenario = "flocking";
  SetAlgorithm(setup, "archive");
  setup.experiment.search.parameters["runs"] = 600;
  for (const int slots : {32, 64, 128}) {
    setup.experiment.search.parameters["slots"] = slots;
    char name[32];
    std::snprintf(name, sizeof(name), "archive, %d slots", slots);
    Row(name, setup);
  }
}

void PrintReport() {
  std::printf("Idle share of the workers; 600 evaluations, durations Pareto(1.5)\n");
  Table(20, 30, {2, 5, 10, 15, 19});
  Table(100, 6, {10, 50, 99});
  ArchiveTable();
}

}  // namespace
}  // namespace gauntlet

int main() {
  gauntlet::PrintReport();
  return 0;
}
