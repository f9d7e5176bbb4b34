// A campaign's summary and the results of `evaluate` and `replay`: for a person at a terminal, and as the
// JSON that scripts rely on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "master/campaign/campaign_summary.h"
#include "master/campaign/replay.h"
#include "study/questions/campaign_answers.h"

namespace gauntlet {

struct EvaluatedRun {
  RunId id = 0;
  std::uint64_t seed = 0;
  sim::RunResult result;
};

// What came of a file given to `evaluate`.
struct EvaluatedCase {
  std::string file;
  std::string error;               // why it was not simulated, "" when it was
  std::string refused_rule;        // name of the broken validity rule, "" when none
  std::vector<EvaluatedRun> runs;  // in the order of the replicates
};

// Mean over the completed runs; nothing when there is none.
std::optional<double> MeanFitness(const EvaluatedCase& evaluated);

// How the commands in hints begin and which campaign they name.
struct HintContext {
  std::string program = "gauntlet";
  std::string directory;
};

// Ends with the next commands to try.
std::string SummaryText(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const HintContext& context);
std::string EvaluationText(const std::vector<EvaluatedCase>& cases, const HintContext& context);

// The total failures by the types that the scenario declares, of each search.
std::string TypesText(const CampaignSummary& summary);

// One JSON document, indented, ending with '\n'. Seeds, hashes and ids above 2^53 are strings; a fitness that
// does not exist (nothing completed) is null.
std::string SummaryJson(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const std::string& directory);
// {"cases": [{file, fitness, refused, error, runs: [{id, seed, fitness, verdict, metrics, failure, hash}]}],
// ...}. `summary` is of the campaign that simulated them; nullptr when no case could be simulated.
std::string EvaluationJson(const std::vector<EvaluatedCase>& cases, const CampaignSummary* summary,
                           const std::string& directory);
// {"run", "reproduced", "stored_hash", "hash", "differences": [...], "verdict", "fitness"}.
std::string ReplayJson(const ReplayReport& report);

}  // namespace gauntlet
