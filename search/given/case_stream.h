// The search through cases that arrive one after the other, while it runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "search/evolution/population_search.h"
#include "search/search_row.h"

namespace gauntlet {

// What arrives: a case, and how it is simulated.
struct StreamedCase {
  sim::TestCase test_case;
  std::shared_ptr<const sim::RunSettings> settings = nullptr;  // nullptr = the experiment's
  std::optional<std::uint64_t> seed = {};                      // instead of the experiment's
  std::uint32_t replicates = 1;
};

// Individuals 1, 2, ... are the cases in the order in which they were added, and each is evaluated once; the
// same case again is another individual with the same seeds. The search comes to its end when no more will be
// added and all are told. It keeps what is not told: Population() is empty, but of a search that was made
// with the cases that are stored (SearchSetup::cases) and restored.
class CaseStream final : public PopulationSearch {
 public:
  static constexpr std::uint64_t kSaveInterval = 1000;  // outcomes from boundary to boundary

  static Result<std::unique_ptr<CaseStream>> Create(SearchSetup setup);

  // The number of its individual.
  IndividualId Add(StreamedCase one);
  // No more will be added.
  void End() { ended_ = true; }
  std::uint64_t told() const { return evaluations_done_; }
  // Cases from the oldest that is not told to the newest.
  std::size_t open() const { return open_.size(); }

  CaseStream* Stream() override { return this; }
  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return true; }
  SearchProgress Progress() const override;
  // After every kSaveInterval outcomes, and at the end. What was added and not told is added again.
  bool AtBoundary() const override;

 private:
  explicit CaseStream(SearchSetup setup) : PopulationSearch(std::move(setup)) {}

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  struct Open {
    Individual individual;
    StreamedCase asked;  // without the case
  };
  std::deque<Open> open_;  // added and not told
  std::size_t asked_ = 0;  // of these
  bool ended_ = false;
};

SearchRow StreamRow();

}  // namespace gauntlet
