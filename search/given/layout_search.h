// Questions about given test cases, each answered by runs of some of its obstacles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "controllers/behaviour.h"
#include "search/evolution/population_search.h"
#include "search/given/layout_question.h"

namespace gauntlet {

// Where the scenario's failures happen; nullptr: they have no place.
const controllers::FailurePlace* FailurePlaceOf(const Experiment& experiment);

// Waypoints at which the robot was at the obstacle, where it stands at the beginning: its proximity ring saw
// it.
std::uint64_t CountVisits(const sim::RobotSummary& robot, const sim::ObstacleGene& obstacle);

// Case i of SearchSetup::cases is individual i + 1; every other layout that is simulated is an individual
// too, a child of its case. The cases do not wait for each other.
class LayoutSearch : public PopulationSearch {
 public:
  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return true; }
  bool WantsWays() const override { return true; }
  SearchProgress Progress() const override;

  // Of case `index`, and the runs that it has taken so far.
  const LayoutQuestion& QuestionOf(std::size_t index) const { return *cases_[index].question; }
  std::uint64_t RunsOf(std::size_t index) const { return cases_[index].runs; }

 protected:
  // One question for each case.
  LayoutSearch(const SearchSetup& setup, std::vector<std::unique_ptr<LayoutQuestion>> questions);

 private:
  struct Case {
    std::unique_ptr<LayoutQuestion> question;
    std::map<std::uint64_t, Individual> layouts;  // by GenomeHash: those that were simulated
    LayoutRuns batch;                             // of the runs that were asked for
    int waiting = 0;                              // of these, not told
    std::uint64_t runs = 0;
  };

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;
  void AskMore(std::size_t index);
  LayoutRuns WhatBecameOf(const RunOutcome& run, const sim::Genome& obstacles) const;

  const std::string_view failing_;
  const controllers::FailurePlace* const failure_place_;
  std::vector<Case> cases_;
  std::vector<std::size_t> case_of_;         // [individual - 1]
  std::vector<EvaluationRequest> requests_;  // that Ask has not handed out; they follow from what was told
};

// An experiment that asks about cases of `experiment`; it keeps the robots' trajectories.
Experiment LayoutExperiment(const Experiment& experiment, std::string_view algorithm);

}  // namespace gauntlet
