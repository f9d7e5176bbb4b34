// What all searches of this folder have in common: individuals with an account of their evaluations, outcomes
// in the order of the requests, and how a state is saved.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "search/evolution/genome_generator.h"
#include "search/experiment/objective.h"
#include "search/experiment/schema.h"
#include "search/search_algorithm.h"
#include "search/search_setup.h"

namespace gauntlet {

// Rules of search.objective, for the rows of searches that read it.
std::optional<BrokenRule> CheckObjective(const Experiment& experiment);

// The mean over the runs; one that gave no result failed, -1.
double RobustnessOf(const EvaluationOutcome& outcome);

// Different genomes among the individuals.
std::uint64_t CountDistinctGenomes(const std::vector<Individual>& individuals);

// A search is written by saying what is asked, what becomes of an outcome, and what its state holds besides.
class PopulationSearch : public SearchAlgorithm {
 public:
  // Aborts when `outcome` is not the answer to the oldest request.
  void Tell(const EvaluationOutcome& outcome) final;
  const std::vector<Individual>& Population() const final { return population_; }
  std::vector<Individual> TakePopulation() final { return std::move(population_); }
  std::vector<Individual> TakeNewborns() final { return std::exchange(newborns_, {}); }
  std::vector<std::pair<std::string, double>> Statistics() const override { return {}; }
  bool AtBoundary() const override { return pending_.empty(); }
  bool WantsMetrics() const override;
  void Save(CanonicalEncoder& encoder) const final;
  Status Restore(CanonicalDecoder& decoder, const History& history) final;

 protected:
  explicit PopulationSearch(SearchSetup setup);

  // An outcome in its turn; evaluations_done_ counts it already.
  virtual void Told(const EvaluationOutcome& outcome) = 0;
  // What the state holds besides evaluations_done_, which Restore has read already. A decoder that is cut off
  // is noticed by the caller.
  virtual void SaveRest(CanonicalEncoder& /*encoder*/) const {}
  virtual Status RestoreRest(CanonicalDecoder& decoder, const History& history) = 0;

  const SearchSpec& spec() const { return setup_.experiment.search; }
  // A newborn with no evaluation: its fitness is +infinity.
  static Individual MakeIndividual(IndividualId id, sim::TestCase test_case);
  // The random case that individual `id` starts life with. Error: the ranges leave no room for a valid case.
  Result<sim::TestCase> DrawCase(IndividualId id) const;
  // The individual's next evaluation, whose outcome is waited for from now on; `ahead`: how many of it have
  // been asked for and not been told.
  EvaluationRequest Request(const Individual& individual, std::uint32_t generation, std::uint32_t ahead = 0);
  // Adds the outcome to the individual's account and aggregates its fitness, which is what search.objective
  // says, anew. An evaluation that was not completed, or whose fitness is not finite (a controller under test
  // may return anything), is counted as failed and left out of the aggregate.
  void Record(const EvaluationOutcome& outcome, Individual& individual) const;

  // For a search that evaluates individuals 1, 2, ... once each, in this order: hands over the outcomes of
  // evaluations_done_. Error: the history has others.
  Status Recall(const History& history, const std::function<void(const EvaluationOutcome&)>& recall) const;
  // Everything but the arena, which is the experiment's.
  static void SaveIndividuals(const std::vector<Individual>& individuals, CanonicalEncoder& encoder);
  // Error: they are not as many as `count`, or one of them does not fit: its number is not below `below`, or
  // it has more genes than the experiment.
  Result<std::vector<Individual>> RestoreIndividuals(std::uint64_t count, IndividualId below,
                                                     CanonicalDecoder& decoder) const;
  // "the saved search state is damaged: ..."
  static Error Damaged(const std::string& what);

  SearchSetup setup_;
  const GenomeGenerator generator_;
  const std::uint64_t search_seed_;
  std::vector<Individual> population_;
  std::vector<Individual> newborns_;
  std::uint64_t evaluations_done_ = 0;

 private:
  struct Pending {
    IndividualId individual;
    std::uint32_t evaluation;
  };

  // Of a program's runs, which may be refused by chance: half of them or more were.
  bool MostlyRefused(const EvaluationOutcome& outcome) const;
  // What search.objective makes of the outcome; lower = tougher.
  double FitnessOf(const EvaluationOutcome& outcome, const sim::Genome& obstacles) const;

  const Objective objective_;
  const std::string identity_;
  std::deque<Pending> pending_;  // asked for and not told
};

}  // namespace gauntlet
