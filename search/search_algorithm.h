// A search decides which test cases are evaluated next. It is a pure state machine: no clock, no files, no
// processes, and all randomness keyed by the campaign seed, so the outcome does not depend on workers,
// failures or timing.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/canonical_encoder.h"
#include "base/result.h"
#include "controllers/failure_descriptor.h"
#include "sim/arena/test_case.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet {

using IndividualId = std::uint64_t;  // 1, 2, 3, ... in order of birth within a search

// One round of runs of one individual.
struct EvaluationRequest {
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;  // 0 = the individual's first
  std::uint32_t replicates = 1;  // runs, each with its own seed
  std::uint32_t generation = 0;  // 1 = initial population; for display
  sim::TestCase test_case = {};
  std::vector<IndividualId> parents = {};  // their runs tell how long this one's will take
  // That its runs have instead of the experiment's; nullptr = those. Only of a search over settings.
  std::shared_ptr<const sim::RunSettings> settings = nullptr;
  // From which the seeds of its runs are derived instead of the experiment's; only of a stream.
  std::optional<std::uint64_t> seed = {};
};

// What a run does beside what it is judged by.
struct SideEffects {
  double contacts = -1.0;  // that robots began; -1: nobody has counted
  double seconds = 0.0;    // simulated
  double distance = 0.0;   // m, driven by all robots
};
SideEffects SideEffectsOf(const sim::RunResult& result);

// What came of one run.
struct RunOutcome {
  sim::Verdict verdict = sim::Verdict::kCompleted;
  double fitness = 0.0;  // meaningless unless completed
  bool total_failure = false;
  int failure_type = -1;  // of the scenario; -1 = none or not classified
  // By name, in the scenario's order. Only for a search that WantsMetrics.
  std::vector<std::pair<std::string, double>> metrics = {};
  SideEffects effects = {};                    // likewise
  std::vector<sim::RobotSummary> robots = {};  // only for a search that WantsWays

  bool completed() const { return verdict == sim::Verdict::kCompleted; }
};

// What came of an EvaluationRequest.
struct EvaluationOutcome {
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;
  bool completed = false;        // at least one run has the verdict "completed"
  double fitness = 0.0;          // mean over the completed runs; meaningless when there is none
  std::vector<RunOutcome> runs;  // one for each replicate, in order
};
EvaluationOutcome OutcomeOfRuns(IndividualId individual, std::uint32_t evaluation,
                                std::vector<RunOutcome> runs);

// A member of the population as it stands.
struct Individual {
  IndividualId id = 0;
  std::vector<IndividualId> parents;  // empty in the initial population
  std::uint32_t birth_generation = 0;
  sim::TestCase test_case;
  std::uint32_t evaluations = 0;         // with a fitness
  std::uint32_t failed_evaluations = 0;  // without one
  double fitness_sum = 0.0;              // of all evaluations, added in their order
  double fitness = 0.0;  // aggregated over the evaluations; lower = tougher; +infinity before the first
};

// What a search keeps of one kind of failure.
struct ArchivedFailure {
  std::vector<int> cell;       // part of each axis, from 0
  std::vector<double> middle;  // median of each axis' metric over its failures
  IndividualId individual = 0;
  int failures = 0;
  int runs = 0;  // with a result; they took part in choosing it
};
// The cells of a grid over the kinds of failure that hold something, row by row.
struct ArchiveView {
  std::vector<controllers::DescriptorAxis> axes;  // none: the search keeps no archive
  std::vector<ArchivedFailure> failures;
  bool toughest = false;  // it keeps the toughest case of each cell rather than the smallest reliable one
};

struct SearchProgress {
  std::uint32_t generation = 0;   // the one being evaluated, or the last when finished
  std::uint32_t generations = 0;  // planned; 1 for searches without generations
  std::uint64_t evaluations_done = 0;
  std::uint64_t evaluations_planned = 0;
  std::uint64_t individuals_planned = 0;  // that will have been born; of those bred some may be equal
  bool finished = false;
};

// Hands over all outcomes that the search had been told when a state was saved, in the order in which it was
// told. They come from the stored runs; an error of reading them is passed on.
using History = std::function<Status(const std::function<void(const EvaluationOutcome&)>& visit)>;

class CaseStream;
class FitRounds;
class MarginStages;
class ProbabilityCourse;
class RepairCourse;

class SearchAlgorithm {
 public:
  virtual ~SearchAlgorithm() = default;
  // The evaluations that may start now and were not asked for before, in logical order. Empty while it waits
  // for Tell, and at the end.
  virtual std::vector<EvaluationRequest> Ask() = 0;
  // Outcomes in the very order of the requests, whatever order they arrived in.
  virtual void Tell(const EvaluationOutcome& outcome) = 0;
  // Whether outcomes are to carry the metrics of their runs; constant. They have to be decoded for it.
  virtual bool WantsMetrics() const { return false; }
  // Whether also their trajectories; constant. Its campaign has to keep them (store.trajectories).
  virtual bool WantsWays() const { return false; }
  virtual SearchProgress Progress() const = 0;
  // The current population, in a fixed order (all cases told so far for searches without survivors).
  virtual const std::vector<Individual>& Population() const = 0;
  // The same from a search that is not used any more.
  virtual std::vector<Individual> TakePopulation() = 0;
  virtual ArchiveView Archive() const { return {}; }
  // Of a search over settings; else nullptr.
  virtual const FitRounds* Fit() const { return nullptr; }
  // Of a search along a range; else nullptr.
  virtual const MarginStages* Margin() const { return nullptr; }
  // Of a search for a repair; else nullptr.
  virtual const RepairCourse* Repair() const { return nullptr; }
  // Of a search for a failure probability; else nullptr.
  virtual const ProbabilityCourse* Probability() const { return nullptr; }
  // Of a search to which cases are added; else nullptr.
  virtual CaseStream* Stream() { return nullptr; }
  // Individuals born since the last call, so that they can be stored once.
  virtual std::vector<Individual> TakeNewborns() = 0;
  // A figure or two of the search itself, e.g. {"clone_rate", 0.61}.
  virtual std::vector<std::pair<std::string, double>> Statistics() const = 0;

  // Whether state may be saved now: at moments that depend on the number of told outcomes only.
  virtual bool AtBoundary() const = 0;
  // The state in the canonical encoding; only at a boundary. Its size is bounded by the population: what else
  // has come to pass is read from the stored runs, by Restore.
  virtual void Save(CanonicalEncoder& encoder) const = 0;
  // Afterwards Ask gives everything that was not told when the state was saved. Call on a search that was
  // just made; after an error it must not be used. Errors: kVersion for another format; kCorrupt for what is
  // no state; kInvalidInput for the state of another experiment, naming the first setting in which they
  // differ.
  virtual Status Restore(CanonicalDecoder& decoder, const History& history) = 0;
};

}  // namespace gauntlet
