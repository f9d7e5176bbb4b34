// Campaigns as commands know them: made, served, gone on with, looked at, stopped.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/campaign/campaign_status.h"
#include "master/campaign/campaign_summary.h"
#include "master/campaign/replay.h"
#include "master/directory/search_plans.h"
#include "master/dispatch/pool/worker_pool.h"

namespace gauntlet {

class EvaluationFeed;
class MetricsPage;

// What a master says of itself once workers can reach it.
struct ServingNotice {
  std::vector<std::string> endpoints;
  bool encrypted = false;
};

struct SessionOptions {
  int workers = 1;  // processes of the local pool; 0: workers come from elsewhere
  // Makes another pool than the local one.
  std::function<std::unique_ptr<WorkerPool>()> make_pool;
  std::string slurm;  // a new text for the campaign's slurm.toml; "" = as it is
  // For a master that is a batch job: a living master is a twin that a lost node has left behind, and is made
  // to stop; and when a signal ends this one, its pool is left to the next.
  std::string batch_job;                   // its id; "" = no such master
  std::string bind = "tcp://127.0.0.1:*";  // where workers connect
  bool insecure =
      false;  // in plaintext, open to whoever gets there; otherwise encrypted, for known keys only
  double audit_share = 0.0;        // of runs, 0 to 1, that a second worker simulates too, to be compared
  EvaluationFeed* feed = nullptr;  // of a campaign that is a stream of cases; nullptr of others
  MetricsPage* metrics = nullptr;  // told every second what goes on; nullptr = nobody asks
  std::function<void(const ServingNotice&)> on_serving = [](const ServingNotice&) {};
  // Asks for a clean stop at once. Workers from elsewhere stay and look for the campaign's next master; when
  // `gauntlet stop` asks, runs that have begun are waited for and all workers are let go.
  std::function<bool()> stop_requested = [] { return false; };
  std::function<void(const CampaignProgress&)> on_progress = [](const CampaignProgress&) {};
};

struct SessionReport {
  CampaignEnd end = CampaignEnd::kFinished;
  CampaignSummary summary;
  double wall_seconds = 0.0;
  double master_cpu_seconds = 0.0;      // user + system of the master process alone, in this session
  std::uint64_t runs_this_session = 0;  // simulated, not taken from the store
  WorkerStatistics workers = {};
};

// `dir` is the campaign's directory: kNotFound when there is no campaign in it. Those that look at a campaign
// do so beside a living master too (CampaignView), and wait for one that starts or ends just now.
class CampaignService {
 public:
  virtual ~CampaignService() = default;

  // Creates the campaign in `dir` (which must not exist or be empty) and runs it. `searches`: one, or those
  // of a sweep. Errors: kInvalidInput, kInUse; kNoSpace and kIo when the campaign stopped and can be resumed.
  virtual Result<SessionReport> Start(const std::string& dir, const std::vector<SearchPlan>& searches,
                                      const SessionOptions& options) = 0;
  // Creates the campaign without running it: Resume does. `slurm`: the text of its slurm.toml.
  virtual Status Prepare(const std::string& dir, const std::vector<SearchPlan>& searches,
                         const std::string& slurm) = 0;
  // Makes the campaign's searches longer ("key=value", WithLength) without running them: Resume does. Says
  // what has changed (DescribeLengths), "" when they are that long already. A kill leaves the old length or
  // the new one. `give_up` ends the wait for those who read the campaign. Errors: those of Resume and
  // WithLength.
  virtual Result<std::string> Extend(const std::string& dir, const std::vector<std::string>& sets,
                                     const std::function<bool()>& give_up) = 0;
  // Goes on where the campaign was; a finished one is only summarised, unless it is a stream, which goes on
  // with a feed and not without one.
  virtual Result<SessionReport> Resume(const std::string& dir, const SessionOptions& options) = 0;

  // Checks and summarises what is stored, but for specs and results in full (Resume checks them too).
  virtual Result<CampaignSummary> Read(const std::string& dir) = 0;
  // The runs of a campaign in logical order, search by search.
  virtual Status ForEachRun(const std::string& dir, const RunVisitor& visit) = 0;
  // `scratch`: as SimulateInRunner has it (master/dispatch/pool/worker_program.h).
  virtual Result<CampaignReplay> Replay(const std::string& dir, RunId run, const std::string& scratch) = 0;

  // status.json of a living master (with "state": "running" or "stopping", and "status_age_seconds"); else
  // what is stored, with "state": "stopped" or "finished" and no workers.
  virtual Result<std::string> ReadStatus(const std::string& dir) = 0;
  // Whether a master serves the campaign.
  virtual Result<bool> MasterLives(const std::string& dir) = 0;
  // Asks the living master to let the runs that have begun end, to let its workers go, and to stop. It
  // answers by ending.
  virtual Status RequestStop(const std::string& dir) = 0;
};

// The real one.
CampaignService& CampaignsOnDisk();

}  // namespace gauntlet
