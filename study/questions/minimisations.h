// The smallest parts of a campaign's cases that still fail: what `gauntlet minimise` finds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "base/result.h"
#include "proto/case_json.h"
#include "search/given/case_minimiser.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {

struct Minimisation {
  std::string name;       // of the case, as in CaseInQuestion
  RunId run = 0;          // that it is the case of; 0 when it came from a file
  std::uint64_t key = 0;  // KeyOfCase, of the question as it was asked
  std::string directory;  // of the call that has found it
  sim::TestCase original;
  MinimisedTo outcome = MinimisedTo::kOpen;
  FailureTally found;                 // of the case as it is
  FailureTally empty;                 // of the empty arena
  std::vector<MinimisingStep> steps;  // to what is left (CaseMinimiser::steps)
  LayoutRuns verified;                // of what is left
  analysis::Interval interval;        // of the probability that it fails (Wilson, 95 %)
  bool same_way = false;              // it fails where the case fails
  bool has_place = false;             // the scenario's failures have a place
  std::uint64_t runs = 0;             // simulated for this case
  std::string message;                // of the first run that ended without a result; "" = none did
  proto::CaseDocument smallest;       // what is left, with its lineage; the case itself when refused

  bool Smaller() const { return outcome == MinimisedTo::kLayout && steps.size() > 1; }
};

// The step in words: "without obstacle 3".
std::string DescribeStep(const MinimisingStep& step);

// A campaign that minimises those of the cases that are not `known`; `shorten`: also the lengths of their
// obstacles.
CallPlan PlanMinimisation(const std::string& dir, const QuestionedCampaign& questioned, bool shorten,
                          const std::vector<Minimisation>& known);
// What all calls about cases of the campaign in `dir` have found that have come to their end.
Result<std::vector<Minimisation>> ReadMinimisations(const std::string& dir);
// Of these, the answers to one call, in the order of its cases and under the names that it gives them: the
// same case may have been asked about as another run's.
std::vector<Minimisation> AnswersTo(const QuestionedCampaign& questioned, bool shorten,
                                    const std::vector<Minimisation>& known);

}  // namespace gauntlet
