// What waiting costs: the share of their time for which workers have nothing to do, generation by generation
// and in the steady-state mode, in virtual time with heavy-tailed durations. A table in Markdown.
#include <cmath>
#include <cstdio>
#include <vector>

#include "master/search/make_search.h"
#include "tests/master/search/simulated_cluster.h"
#include "tests/master/search/toy_search.h"

namespace gauntlet::master {
namespace {

SearchSetup ReportSetup() {
  SearchSetup setup = ToySetup();
  setup.experiment.search.parent_selection = ParentSelection::kAllParentBestHalf;
  setup.experiment.search.population = 20;
  setup.experiment.search.generations = 30;
  return setup;
}

void Row(const char* name, const Experiment& experiment, const sim::ArenaRequirements& requirements) {
  std::printf("| %s |", name);
  for (const int workers : {2, 4, 8, 16, 64}) {
    const auto search = MakeSearch(experiment, requirements, 1);
    if (!search.ok()) return;
    std::printf(" %.0f %% |", 100.0 * RunOnCluster(**search, workers, HeavyTailed, SumOfX).idle_share);
  }
  std::printf("\n");
}

void PrintReport() {
  std::printf("Idle share of the workers; 600 evaluations, population 20, durations Pareto(1.5)\n\n");
  std::printf("| search | 2 workers | 4 | 8 | 16 | 64 |\n|---|---|---|---|---|---|\n");
  SearchSetup setup = ReportSetup();
  Row("generational", setup.experiment, setup.requirements);
  setup.experiment.search.mode = SearchMode::kSteadyState;
  for (const int lag : {2, 5, 10, 15, 19}) {
    setup.experiment.search.lag = lag;
    char name[32];
    std::snprintf(name, sizeof(name), "steady-state, lag %d", lag);
    Row(name, setup.experiment, setup.requirements);
  }
}

}  // namespace
}  // namespace gauntlet::master

int main() {
  gauntlet::master::PrintReport();
  return 0;
}
