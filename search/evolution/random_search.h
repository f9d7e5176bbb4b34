// Random testing, the baseline: independent random test cases, each evaluated once.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "search/evolution/population_search.h"
#include "search/search_row.h"

namespace gauntlet {

// Case k is the same however many cases are asked for. There are no generations: every case is of generation
// 1 and the population is all cases told so far. A state says how many these are; the cases are drawn again
// and their outcomes come from the stored runs.
class RandomSearch : public PopulationSearch {
 public:
  static constexpr std::uint64_t kChunk = 100;  // cases per Ask: drawing them takes a fraction of a second
  static constexpr std::uint64_t kLookahead = 1000;     // Ask waits while so many are outstanding
  static constexpr std::uint64_t kSaveInterval = 1000;  // outcomes from boundary to boundary

  // Draws the first cases as a trial. Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<RandomSearch>> Create(SearchSetup setup);

  std::vector<EvaluationRequest> Ask() override;
  SearchProgress Progress() const override;
  // After every kSaveInterval outcomes, and at the end. What was asked and not told is asked again.
  bool AtBoundary() const override;

 private:
  explicit RandomSearch(SearchSetup setup) : PopulationSearch(std::move(setup)) {}

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  std::uint64_t Planned() const;
  // Create has found that cases can be drawn, so it tries until it has one.
  Individual Draw(IndividualId id) const;

  std::deque<Individual> waiting_;  // asked for and not told
};

SearchRow RandomRow();

}  // namespace gauntlet
