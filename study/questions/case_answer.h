// What is known of cases that somebody asked about: their stored runs, told again to the pure question that
// asked for them. Each call of a question is a campaign of its own, so that it survives a kill, resumes and
// is replayed like any other and changes nothing of the one that its cases come from.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "analysis/tables/table.h"
#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/store/result_store.h"
#include "search/given/layout_question.h"

namespace gauntlet {

// Where robots were in a run of the case as it is.
struct Whereabouts {
  std::vector<sim::Vec2> stuck;        // m: where one stayed for 5 s
  std::uint64_t failing_robots = 0;    // of a run that failed: that were lost, or all, when none is ever lost
  std::vector<std::uint64_t> touched;  // [obstacle]: how many of these were at it
  std::string mechanism;               // of a run that failed: MechanismOf
};

struct CaseRun {
  RunId id = 0;
  std::uint64_t seed = 0;
  bool as_it_is = true;     // else of some of the case's obstacles
  LayoutRuns became;        // what the question was told
  sim::RunResult result;    // without its robots
  Whereabouts whereabouts;  // where trajectories are kept
};

struct CaseAnswer {
  std::string name;        // "run 17", or what its file is called
  RunId run = 0;           // that it is the case of; 0 when it came from a file
  std::size_t search = 0;  // of the plan that it was asked in, from 0
  sim::TestCase test_case;
  std::shared_ptr<const Experiment> experiment;  // that asks about it
  std::uint64_t key = 0;                         // CaseKey, of what is asked
  std::string refused_rule;                      // that the case breaks, "no-path"; "" = none that has a name
  std::string refused;                           // why it cannot be simulated; "" = it can
  // What came of it.
  std::string campaign;       // the directory that holds its runs; "" = nothing is known
  std::vector<CaseRun> runs;  // in the order in which they were asked for
  bool decided = false;       // the question wants no more runs
  bool ended = false;         // the call has come to its end

  FailureTally tally() const;   // of the case as it is
  std::string Message() const;  // of the first run that ended without a result; "" = none did
};
// So named, as it may have been asked about as another run's.
CaseAnswer Renamed(CaseAnswer answer, const std::string& name);
// Tells the question all that is stored.
void TellAll(const CaseAnswer& answer, LayoutQuestion& question);

// The calls in a folder of a campaign, directories, the earliest name first; none when there is no folder.
std::vector<std::string> CallsIn(const std::string& folder);

// What an answer is known by: KeyOfCase, or less of it.
using CaseKey = std::uint64_t (*)(const Experiment& about, const sim::TestCase& test_case);

// The cases of a stored campaign, in the order of its searches and their cases. Errors: those of reading, and
// kCorrupt where runs are not those that the question asks for.
Result<std::vector<CaseAnswer>> AnswersIn(const std::vector<SearchPlan>& plans, ResultStore& store,
                                          const std::string& directory, CaseKey key);
// The same of a call's directory; none while it is just being made, or its master just ends.
Result<std::vector<CaseAnswer>> AnswersOfCall(const std::string& directory, CaseKey key);
// The same of all calls in a folder of a campaign; none when there is no folder.
Result<std::vector<CaseAnswer>> AnswersOfCalls(const std::string& folder, CaseKey key);
// Of those that are decided, each key once: what stands on most runs, of these the first.
std::vector<CaseAnswer> BestOf(std::vector<CaseAnswer> answers);

// What became of each run, for programs.
Table TableOf(std::span<const CaseRun> runs);

// "5 of 6": how many runs failed.
std::string OutOf(const FailureTally& tally);
// Of the probability to fail (Wilson, 95 %); 0 to 1 without a run.
analysis::Interval FailureInterval(const FailureTally& tally);

}  // namespace gauntlet
