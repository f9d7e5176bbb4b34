// What a campaign does right now: what runs where, since when, and why nothing runs. The living master says
// it in status.json; this is the only way to know, because nobody else reads the database meanwhile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/report/campaign_progress.h"

namespace gauntlet::master {

struct MasterView {
  std::string campaign_id;
  std::string experiment;
  std::string host;
  std::int64_t pid = 0;
  std::uint64_t epoch = 0;
  std::int64_t started_unix_ms = 0;
  std::int64_t now_unix_ms = 0;
  std::vector<std::string> endpoints;
  bool encrypted = false;
  std::string batch_job;                      // that it is, "" = none
  std::string metrics_url = "";               // "" = none
  std::uint64_t nondeterministic_before = 0;  // results that differed, under former masters
  bool stopping = false;                      // lets the runs that have begun end
};

// The document of status.json, README section "Status".
std::string StatusJson(const MasterView& master, const CampaignProgress& progress,
                       const BackendView& backend);

// One sentence why no run is simulated at this moment; "" while some are.
std::string WhyNothingRuns(const MasterView& master, const CampaignProgress& progress,
                           const BackendView& backend);

// Whether a master serves the campaign. Error: `dir` is no campaign.
Result<bool> MasterLives(const std::string& dir);

// status.json of a living master (with "state": "running" or "stopping", and "status_age_seconds"); else what
// is stored, with "state": "stopped" or "finished" and no workers. Error: no campaign, or one that does not
// read back.
Result<std::string> ReadStatus(const std::string& dir);

// Asks the living master to let the runs that have begun end, to let its workers go, and to stop. It answers
// by ending. kNotFound when there is no campaign.
Status RequestStop(const std::string& dir);

}  // namespace gauntlet::master
