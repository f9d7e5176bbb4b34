// What saving its state costs a search: the bytes of all states it saves on the way to so many runs of
// flocking, with a toy fitness instead of simulations. A table in Markdown.
#include <cstdio>
#include <string>
#include <vector>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/search/state_growth.h"

namespace gauntlet {
namespace {

void PrintRow(const std::string& algorithm, int runs) {
  constexpr int kPopulation = 20;
  const auto experiment =
      LoadExperiment("flocking",
                     {"search.algorithm=" + algorithm, "search.cases=" + std::to_string(runs),
                      "search.generations=" + std::to_string(runs / kPopulation)},
                     BuiltInCatalogue());
  if (!experiment.ok()) return;
  const auto search = MakeSearch(*experiment);
  if (!search.ok()) return;
  const StateGrowth growth = GrowthOf(**search);
  std::printf("| %s | %llu | %llu | %.1f | %.0f |\n", algorithm.c_str(),
              static_cast<unsigned long long>(growth.runs), static_cast<unsigned long long>(growth.states),
              static_cast<double>(growth.bytes) / 1e6, growth.bytes_per_run());
  std::fflush(stdout);
}

}  // namespace
}  // namespace gauntlet

int main() {
  std::printf("| search | runs | states | MB in all | bytes per run |\n|---|---|---|---|---|\n");
  for (const char* algorithm : {"genetic", "steady-state", "random"}) {
    for (const int runs : {2'000, 6'000, 20'000, 60'000, 200'000}) {
      gauntlet::PrintRow(algorithm, runs);
    }
  }
  return 0;
}
