// How often cases of a campaign fail with fresh seeds: what `gauntlet confirm` has found out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "analysis/tables/table.h"
#include "base/result.h"
#include "search/archive/failure_archive.h"
#include "search/failure_tally.h"
#include "study/questions/baselines.h"
#include "study/questions/case_answer.h"
#include "study/questions/question.h"
#include "study/questions/smallest_layouts.h"
#include "study/sets/failure_groups.h"

namespace gauntlet {

struct FailedRun {
  RunId id = 0;
  FailureFeatures features = {};
};

struct Confirmation {
  std::string name;       // of the case, as in CaseAnswer
  RunId run = 0;          // that it is the case of; 0 when it came from a file
  std::uint64_t key = 0;  // ConfirmationKey
  FailureTally tally;
  FailureVerdict verdict = FailureVerdict::kOpen;
  analysis::Interval interval;  // of the probability to fail (Wilson, 95 %)
  // Of its failed runs, along the scenario's descriptor axes. Nothing when none could be described.
  std::optional<Descriptor> middle;
  std::string message;  // of the first run that ended without a result; "" = none did
  std::vector<FailedRun> failed = {};
  std::string campaign = "";  // the directory that holds its runs
  // The same asked elsewhere (confirm --engine), by the name of the physics engine or the experiment's file.
  std::map<std::string, FailureTally> elsewhere = {};
  // Of the failed runs the first that fails as most of them do; null: none failed.
  const FailedRun* Typical() const;
};
// The same for the same case under the same experiment, whatever it is called and however many runs are asked
// for.
std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case);
Confirmation ConfirmationIn(const CaseAnswer& answer);
// What the campaign in `dir` knows, each case once, also while it is being found out; open ones are left
// out. Of a case that was confirmed twice, what stands on more runs.
Result<std::vector<Confirmation>> ReadConfirmations(const std::string& dir);

// By which cases are ordered: the lower bound of the failure probability, so that 5 of 5 runs say less than
// 61 of 64.
double Toughness(const Confirmation& one);
// Of the confirmed cases that a run names, the toughest; of equal ones the first. Null: there is none. All
// that tells of a toughest case means this one, once cases were confirmed.
const Confirmation* ToughestOf(const std::vector<Confirmation>& confirmations);

// With keys for programs: [{run, case, k, n, interval: [lo, hi], verdict, message}]; run is null for a case
// from a file.
Table ConfirmationsTable(const std::vector<Confirmation>& confirmations);

// What `confirm`, `minimise` and `baseline` have found out about the cases of the campaign in `dir`.
struct CampaignAnswers {
  std::vector<Confirmation> confirmations;
  std::vector<SmallestLayout> smallest_layouts;
  std::vector<Baseline> baselines;
};
Result<CampaignAnswers> ReadAnswers(const std::string& dir);

Question ConfirmQuestion();

}  // namespace gauntlet
