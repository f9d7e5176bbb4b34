// A search over settings: every individual is a test case under settings of its own, and what its runs give
// is held against targets (fit_rounds.h).
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "search/evolution/population_search.h"
#include "search/fit/fit_rounds.h"
#include "search/search_row.h"

namespace gauntlet {

// The cases that were handed in are individuals 1, 2, ...; then follow those of each setting, which has its
// own random cases, one run each, and its own copies of others, with as many evaluations as FitPlan says. A
// round's settings follow from the runs of all before it.
class FitSearch final : public PopulationSearch {
 public:
  static constexpr std::size_t kLookahead = 1000;  // Ask waits while so many evaluations are outstanding

  // Error: that of MakeFitPlan; a target is about cases that were not handed in; no setting can be simulated.
  static Result<std::unique_ptr<FitSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return true; }
  SearchProgress Progress() const override;
  // At the end of each round.
  bool AtBoundary() const override { return asked_.empty() && unasked_.empty(); }

  const FitRounds* Fit() const override { return &rounds_; }

 private:
  struct Asked {
    std::size_t setting = 0;  // of rounds_.settings()
    std::size_t cases = 0;    // of FitPlan::cases
  };
  // An individual of a setting and how often it is evaluated.
  struct Member : Asked {
    IndividualId id = 0;
    std::size_t given = 0;  // the case that was handed in, from 1; 0 = another
    int evaluations = 1;
  };
  // What runs of a setting begin with.
  struct Beginning {
    std::shared_ptr<const Experiment> experiment;
    GenomeGenerator generator;
  };

  FitSearch(const SearchSetup& setup, FitPlan plan);

  void Told(const EvaluationOutcome& outcome) override;
  void SaveRest(CanonicalEncoder& encoder) const override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  Status CheckSomeBegin();
  void BeginRound();
  // What the settings of the last round are simulated with.
  void AddMembers();
  void AskFor(const Member& member, std::vector<EvaluationRequest>& requests);
  // Error: no swarm can begin with these settings, or no case can be drawn.
  Result<Beginning> BeginningOf(const FitSetting& setting) const;

  FitRounds rounds_;
  TargetReader reader_;
  std::deque<Member> unasked_;           // of the round
  std::deque<Asked> asked_;              // not told
  std::vector<std::size_t> round_ends_;  // settings when each round had begun
  std::optional<Beginning> beginning_;   // of setting `begun_`
  std::size_t begun_ = 0;
  IndividualId born_ = 0;
  bool ended_ = false;
};

SearchRow FitRow();

}  // namespace gauntlet
