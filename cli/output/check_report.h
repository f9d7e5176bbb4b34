// What `gauntlet check` says of a corpus: for people, for scripts and for the machines that run tests.
#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "proto/messages.h"
#include "search/failure_tally.h"

namespace gauntlet {

struct CheckedCase {
  std::string name;
  std::string file;
  std::string expected;  // "fail", "flaky", "pass"
  FailureTally tally;
  FailureVerdict verdict = FailureVerdict::kOpen;
  analysis::Interval interval;  // of the probability to fail (Wilson, 95 %)
  std::string message;          // of the first run that ended without a result
  proto::RunId run = 0;         // one that failed, or ended without a result; 0 = none did
};

enum class CheckOutcome {
  kAsExpected,
  kBetter,  // it fails less than expected
  kWorse,   // more; or a run ended without a result
};
CheckOutcome OutcomeOf(const CheckedCase& checked);

struct CorpusReport {
  std::string corpus;
  std::string scenario;
  std::string controller;
  std::string campaign;  // the directory of the runs
  std::vector<CheckedCase> cases;

  int Count(CheckOutcome outcome) const;
};

// A table, what it comes to, and how to see what failed. `program`: how commands begin.
std::string CheckText(const CorpusReport& report, const std::string& program);
// {"cases": [{name, expected, k, n, interval, verdict, outcome}], failed, passed}.
std::string CheckJson(const CorpusReport& report);
// JUnit's XML: a case that is worse than expected is a failure, one without a result an error.
std::string CheckJunit(const CorpusReport& report);

}  // namespace gauntlet
