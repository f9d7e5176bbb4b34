#include "master/cli/evaluation.h"

namespace gauntlet::master {

std::optional<double> MeanFitness(const EvaluatedCase& evaluated) {
  double sum = 0.0;
  int completed = 0;
  for (const EvaluatedRun& run : evaluated.runs) {
    if (run.result.verdict != sim::Verdict::kCompleted) continue;
    sum += run.result.fitness;
    ++completed;
  }
  if (completed == 0) return std::nullopt;
  return sum / completed;
}

}  // namespace gauntlet::master
