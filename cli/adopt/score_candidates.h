// Where the score of an ARGoS project may be found.
#pragma once

#include <string>
#include <vector>

#include "cli/adopt/trial_run.h"

namespace gauntlet {

struct ScoreCandidate {
  std::string from;  // "log:PATTERN", "csv:FILE:COLUMN", "trajectory:MEASURE"
  double first = 0.0;
  double other_seed = 0.0;
  double with_obstacle = 0.0;

  // Of a number that is the same whatever the swarm does, such as a clock, nothing can be learnt.
  bool Varies() const { return first != other_seed || first != with_obstacle; }
};

// Numbers in lines that were printed once, the last line first, columns of files that were written, the last
// column first, and numbers in lines that were printed often; at most `most`. Only those that all three runs
// have.
std::vector<ScoreCandidate> FindScores(const TrialRun& first, const TrialRun& other_seed,
                                       const TrialRun& with_obstacle, const std::vector<std::string>& written,
                                       std::size_t most = 20);

// What a run has of it. Error: nothing.
Result<double> ScoreIn(const TrialRun& run, const std::string& from);

// One that the user names. Error: a run does not have it.
Result<ScoreCandidate> ScoreNamed(const std::string& from, const TrialRun& first, const TrialRun& other_seed,
                                  const TrialRun& with_obstacle);

}  // namespace gauntlet
