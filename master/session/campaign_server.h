// A master at work: serves a campaign that it owns to workers until its searches have finished or it is to
// stop, and cleans up whatever happens.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "master/directory/campaign_ownership.h"
#include "master/dispatch/remote_backend.h"
#include "master/dispatch/wire/zmq_transport.h"
#include "master/session/campaign_service.h"
#include "master/session/search_driver.h"
#include "master/session/search_loop.h"
#include "master/session/snapshot_publisher.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// Thread-safety: one thread, the main one (LocalPool wants it).
class CampaignServer {
 public:
  // Campaign, plans and options outlive the server. `golden_hashes`: of the controllers that the campaign
  // uses.
  CampaignServer(CampaignOwnership& campaign, const std::vector<SearchPlan>& plans,
                 const proto::GoldenHashes& golden_hashes, const SessionOptions& options);

  // Takes all the steps below, once. Error: what is stored does not fit the plans (kCorrupt), workers cannot
  // be served (kInvalidInput, kInUse), a newer master has begun (kInUse), somebody has deleted or replaced
  // the campaign's files (kNotFound), or the store or all workers have failed (kNoSpace, kIo);
  // except with kNotFound, whatever was acknowledged to workers is stored.
  Result<SessionReport> Serve();

 private:
  // The files by which a living master is found, followed and asked to stop: removed at its end, unless a
  // newer master has written its own.
  struct Files {
    const CampaignOwnership& campaign;
    ~Files();
  };

  Status MakeSearches();
  Status Listen();
  Status StartPool();
  Status RestoreSearches();
  Status Announce();
  Result<CampaignEnd> Run();
  void LetWorkersGo(const Result<CampaignEnd>& end);
  Result<SessionReport> Report(CampaignEnd end);

  // Every second: looks for newer masters and for who wants this one to stop, and says what goes on.
  void Publish(const CampaignProgress& progress);
  void KeepBundle(const Experiment& experiment, const StoredRun& run, const FinishedRun& finished) const;
  void NoteEvent(const std::string& kind, const std::string& text);

  CampaignOwnership& campaign_;
  const std::vector<SearchPlan>& plans_;
  const SessionOptions& options_;
  const CampaignIdentity identity_;
  const SteadyClock clock_;
  const TimePoint started_ = clock_.Now();
  const double cpu_before_;  // s
  DispatchOptions dispatch_;
  MasterView view_;
  TimePoint next_status_ = started_;
  std::optional<Error> outdated_;  // a newer master has begun, or what this one writes is gone
  std::uint64_t runs_before_ = 0;

  // From here on in the order in which they are made; they end the other way round.
  const Files files_;
  std::vector<std::unique_ptr<SearchAlgorithm>> searches_;
  std::unique_ptr<ZmqTransport> transport_;
  std::unique_ptr<WorkerPool> pool_;  // none: workers come from elsewhere
  std::unique_ptr<RemoteBackend> backend_;
  std::deque<SearchDriver> drivers_;
  std::optional<SearchLoop> loop_;
  std::optional<SnapshotPublisher> snapshots_;
};

}  // namespace gauntlet
