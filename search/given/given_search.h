// The search through given cases: what is simulated of each of them, a pure question says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "search/evolution/population_search.h"
#include "search/given/layout_question.h"
#include "search/search_row.h"

namespace gauntlet {

// Waypoints at which the robot was at the obstacle, where it stands at the beginning: its proximity ring saw
// it.
std::uint64_t CountVisits(const sim::RobotSummary& robot, const sim::ObstacleGene& obstacle);

// What a question is told of runs of an experiment.
class RunJudge {
 public:
  explicit RunJudge(const Experiment& experiment);
  LayoutRuns WhatBecameOf(const RunOutcome& run, const sim::Genome& obstacles) const;
  // Whether it reads the metrics of runs.
  bool WantsMetrics() const { return FailingNeedsMetrics(failing_); }

 private:
  const std::string_view failing_;
  const bool leaves_out_refused_;
  const controllers::FailureDescriptor& failures_;
};

// Tells the question what became of runs of its case, each by itself, in the order in which they were asked
// for; `each`: runs of an evaluation. Those of a batch that is not complete are not told. False: they are
// more than it asks for.
bool TellStored(std::span<const LayoutRuns> runs, int each, LayoutQuestion& question);

// Case i of SearchSetup::cases is individual i + 1; every other layout that is simulated is an individual
// too, a child of its case. What a question wants is asked for at once, and more only when all of it is told,
// so that no run is wasted; the cases do not wait for each other. Their validity is the caller's business;
// nothing here is random.
class GivenSearch final : public PopulationSearch {
 public:
  static Result<std::unique_ptr<GivenSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return WantsWays() || judge_.WantsMetrics(); }
  bool WantsWays() const override { return setup_.row->reads_trajectories; }
  SearchProgress Progress() const override;

 private:
  struct Case {
    std::unique_ptr<LayoutQuestion> question;
    std::map<std::uint64_t, Individual> layouts;  // by GenomeHash: those that were simulated
    LayoutRuns batch;                             // of the evaluations that were asked for
    int waiting = 0;                              // of these, not told

    int Missing() const { return waiting > 0 ? waiting : question->runs(); }
  };

  explicit GivenSearch(const SearchSetup& setup);

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;
  void AskMore(std::size_t index);

  const RunJudge judge_;
  std::vector<Case> cases_;
  std::uint64_t missing_ = 0;                // evaluations, of all cases
  std::vector<std::size_t> case_of_;         // [individual - 1]
  std::vector<EvaluationRequest> requests_;  // that Ask has not handed out; they follow from what was told
};

// An experiment that asks about cases of `experiment` what the search `algorithm` does.
Experiment AboutCasesOf(const Experiment& experiment, std::string_view algorithm);

}  // namespace gauntlet
