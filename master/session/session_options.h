// What a session of a campaign is asked to do, and what it says of itself at its end.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/dispatch/worker_pool.h"
#include "master/report/campaign_progress.h"
#include "master/report/campaign_summary.h"

namespace gauntlet::master {

class MetricsServer;

// What a master says of itself once workers can reach it.
struct ServingNotice {
  std::vector<std::string> endpoints;
  bool encrypted = false;
};

// Where the workers of a pool find what they need; absolute paths.
struct PoolSite {
  std::string access_file;
  std::string log_directory;
};

struct SessionOptions {
  int workers = 1;  // processes of the local pool; 0: workers come from elsewhere
  // Makes another pool than the local one.
  std::function<Result<std::unique_ptr<WorkerPool>>(const PoolSite&)> make_pool;
  // For a master that is a batch job: a living master is a twin that a lost node has left behind, and is made
  // to stop; and when a signal ends this one, its pool is left to the next.
  std::string batch_job;  // its id; "" = no such master
  // Where workers connect. Reachable from other machines: encrypted, for known keys only, unless `insecure`.
  std::string bind = "tcp://127.0.0.1:*";
  bool insecure = false;
  double audit_share = 0.0;          // of runs, 0 to 1, that a second worker simulates too, to be compared
  MetricsServer* metrics = nullptr;  // told every second what goes on; nullptr = nobody asks
  std::function<void(const ServingNotice&)> on_serving = [](const ServingNotice&) {};
  // Asks for a clean stop at once. Workers from elsewhere stay and look for the campaign's next master; when
  // `gauntlet stop` asks, runs that have begun are waited for and all workers are let go.
  std::function<bool()> stop_requested = [] { return false; };
  std::function<void(const CampaignProgress&)> on_progress = [](const CampaignProgress&) {};
};

enum class CampaignEnd { kFinished, kStopped };

struct SessionReport {
  CampaignEnd end = CampaignEnd::kFinished;
  CampaignSummary summary;
  double wall_seconds = 0.0;
  double master_cpu_seconds = 0.0;      // user + system of the master process alone, in this session
  std::uint64_t runs_this_session = 0;  // simulated, not taken from the store
  WorkerStatistics workers;
};

}  // namespace gauntlet::master
