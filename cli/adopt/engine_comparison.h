// Whether Gauntlet's own engine, which is many times faster, moves a project's robots as ARGoS does.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cli/adopt/trial_run.h"
#include "search/cases/argos_template.h"

namespace gauntlet {

// The C++ sources that define the controller, and those beside them that it may need: all of the folder in
// which REGISTER_CONTROLLER names it, but loop functions and programs. Empty: there are none in the project.
std::vector<std::string> ControllerSources(const std::string& project, const std::string& controller);

struct EngineQuestion {
  std::string argos_file;
  std::string project;  // its folder
  const ArgosTemplate& form;
  struct Start {
    const TrialRun* run;    // of which the robots' places at the beginning are taken
    sim::Genome obstacles;  // that one of two cases has
  };
  std::vector<Start> starts;
  std::vector<std::string> kinds;  // of the robots
  // Runs the text of a file in ARGoS, as the experiment will.
  std::function<Result<TrialRun>(const std::string&)> run;
};

struct EngineComparison {
  bool compiles = false;
  int cases = 0;              // that were compared
  double seconds = 0.0;       // when: kComparedAt, or at the end of shorter runs
  int robots = 0;             // of all cases
  int near = 0;               // of them within kSamePlace then
  double apart = 0.0;         // m, the median of the robots then
  double apart_at_end = 0.0;  // m, likewise at the end
  std::string said;           // what to say of the engine, "may be trusted ..."
  bool trusted = false;
};
inline constexpr double kComparedAt = 10.0;  // s
inline constexpr double kSamePlace = 0.01;   // m
// Of a trusted engine's robots are near then; the others may have touched something.
inline constexpr double kTrustedShare = 0.9;

// Compiles the controller (`gauntlet build-controller`), simulates cases in our engine, has ARGoS run the
// very same (`gauntlet export --format argos`), without loop functions in both, and compares where the robots
// are.
EngineComparison CompareEngines(const EngineQuestion& question);

}  // namespace gauntlet
