// What `gauntlet adopt` does: an ARGoS project is run to see what it does, and becomes an experiment.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "base/result.h"
#include "cli/adopt/engine_comparison.h"
#include "cli/adopt/score_candidates.h"
#include "search/cases/argos_template.h"

namespace gauntlet {

struct AdoptionOptions {
  std::string argos_file;
  std::string
      experiment;  // the file to write, with what it needs beside it in NAME.adopted; "": nothing is written
  std::string score;  // as ScoreNamed takes it, or a measure's name; "": the first that is seen
  ArgosTemplateOptions form;
};

struct Adopted {
  std::vector<std::string> taken_over;
  std::vector<ArgosRemark> differs;
  std::vector<ArgosRemark> unsupported;
  std::vector<ScoreCandidate> scores;
  std::string score;
  std::vector<std::string> libraries;  // that the experiment keeps
  bool reproducible = false;           // two runs with one seed had the same trajectories
  EngineComparison engine;
  double seconds = 0.0;  // that a run takes
};

// Runs the project up to thirteen times, each in a folder of its own, and cases like its own up to ten times;
// nothing is written into the project's.
// `say` gets what it does, `said` what a compiler or ARGoS printed before it failed. Error: ARGoS is missing,
// the project does not run, or a box in the way of its robots changes nothing.
Result<Adopted> Adopt(const AdoptionOptions& options, const std::function<void(const std::string&)>& say,
                      std::ostream& said);

}  // namespace gauntlet
