// Simulates a stored run again and holds the new result against the stored one.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "master/dispatch/trust/reproducibility.h"
#include "master/store/result_store.h"
#include "search/experiment/experiment.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet {

struct ReplayReport {
  StoredRun stored;
  sim::RunSpec spec;
  sim::RunResult stored_result;
  sim::RunResult replayed;               // with the whole trajectory
  std::vector<std::string> differences;  // one sentence each; empty = reproduced bit for bit
  // Why nothing could be compared: the stored spec or result does not even decode. What stands above from
  // `spec` on is then empty. "" = it was compared.
  std::string damage;
};

struct CampaignReplay {
  Experiment experiment;
  ReplayReport report;
  std::string as_of = "";  // CampaignView::as_of
  Reproducible reproducible = Reproducible::kPromised;
};

// Error: the run is not there (kNotFound), or its row contradicts the result stored in it (kCorrupt).
// `scratch`: as SimulateInRunner has it.
Result<ReplayReport> ReplayRun(ResultStore& store, RunId run, const std::string& scratch = "");
// The same of a run that was read. Thread-safe.
Result<ReplayReport> ReplayRun(StoredRun stored, const std::string& scratch = "");

}  // namespace gauntlet
