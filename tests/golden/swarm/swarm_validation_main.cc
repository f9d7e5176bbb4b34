// Prints the table of docs/validation.md, "Whole swarm". With a directory of NAME.argos and NAME.csv files it
// compares these instead of the cases that the repository keeps. Exit: 0 every margin holds, 1 one does not,
// 2 no cases.
#include <cstdio>

#include "tests/golden/swarm/swarm_comparison.h"

int main(int argc, char** argv) {
  using namespace gauntlet::golden;  // NOLINT(google-build-using-namespace)
  const auto cases =
      argc > 1 ? LoadSwarmCases(argv[1], argv[1]) : LoadSwarmCases(RecordedDirectory(), LayoutDirectory());
  if (!cases.ok()) {
    std::fprintf(stderr, "%s\n", cases.error().message.c_str());
    return 2;
  }
  std::vector<CaseComparison> comparisons;
  for (const SwarmCase& swarm_case : *cases) comparisons.push_back(Compare(swarm_case));
  const Verdict verdict = Judge(comparisons);
  std::fputs(verdict.table.c_str(), stdout);
  return verdict.holds ? 0 : 1;
}
