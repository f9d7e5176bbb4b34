// How many different failures the confirmed cases of a campaign are: by what happened, and by where.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/questions/confirmations.h"
#include "study/questions/smallest_layouts.h"
#include "study/sets/failure_groups.h"

namespace gauntlet {

// Cases most of whose failed runs have one feature.
struct DistinctFailure {
  const char* feature = "";                // of its grouping
  std::string name;                        // what they have in common, in words
  std::vector<const Confirmation*> cases;  // the toughest first, as in ToughestOf
  double share = 0.0;                      // of the cases that have runs enough to tell
  int agreeing_runs = 0;                   // of the cases' failed runs those that have the feature
  int failed_runs = 0;
  const FailedRun* typical = nullptr;  // of the toughest case the first failed run that has the feature
  // Of what `gauntlet minimise` has left of the cases, the one with the fewest obstacles; null: of none.
  const SmallestLayout* smallest = nullptr;

  // Whether one of the cases fails in at least half of its runs.
  bool Confirmed() const;
};

// Failures told apart by one feature.
struct FailureGrouping {
  const char* feature = "";                    // for programs: "mechanism", "place"
  const char* title = "";                      // "What happens"
  const char* phrase = "";                     // "what happens"
  const char* unknown = "";                    // why no run's is known, a sentence
  std::optional<double> agreement;             // AgreementWithin
  std::optional<LeadingFeature> overall = {};  // of all failed runs together; nothing: no run's is known
  // The toughest first, of equally tough ones that with most cases. None where runs of a case agree too
  // little.
  std::vector<DistinctFailure> groups = {};
  int mixed = 0;  // cases that have runs enough, no half of which agree

  bool Used() const { return overall && (!agreement || *agreement >= kLeastAgreement); }
};

struct DistinctFailures {
  std::vector<FailureGrouping> groupings;  // by mechanism, by place
  int failing = 0;                         // cases of which a run failed
  int too_few = 0;                         // of these have fewer failed runs than kRunsForGroup

  // Each group once, those by mechanism first.
  std::vector<const DistinctFailure*> All() const;
};
// The arguments must outlive it.
DistinctFailures DistinctFailuresOf(const std::vector<Confirmation>& confirmations,
                                    const std::vector<SmallestLayout>& layouts);

}  // namespace gauntlet
