#include "master/session/campaign_server.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/process_identity.h"
#include "master/campaign/observed_reproducibility.h"
#include "master/campaign/stored_search.h"
#include "master/directory/campaign_keys.h"
#include "master/directory/commands.h"
#include "master/dispatch/leases/run_limits.h"
#include "master/dispatch/pool/local_pool.h"
#include "master/session/bind_endpoint.h"
#include "master/session/master_log.h"
#include "master/session/metrics_page.h"
#include "master/session/metrics_text.h"
#include "master/session/reproduction_bundle.h"
#include "proto/access_file.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

constexpr std::uint32_t kNeverMany = 1U << 16;
constexpr std::chrono::milliseconds kShutdownTime{2000};
constexpr std::chrono::milliseconds kStatusEvery{1000};

// The most that any of the searches needs.
DispatchOptions LimitsFor(const std::vector<SearchPlan>& plans, const SessionOptions& options) {
  DispatchOptions limits;
  limits.audit_share = options.audit_share;
  // Whoever writes lines waits for each answer.
  if (options.feed != nullptr) limits.many_waiting = kNeverMany;
  limits.without_ways =
      std::ranges::none_of(plans, [](const SearchPlan& plan) { return KeepsWays(plan.experiment); });
  for (const SearchPlan& plan : plans) {
    limits.cpu_limit_seconds = std::max(limits.cpu_limit_seconds, CpuLimitSeconds(plan.experiment));
    if (plan.experiment.scenario != controllers::command::kScenario) continue;
    // One that cannot be read gives no run either, and is told there.
    const auto command = CommandOf(plan.experiment.scenario_plugin);
    if (!command) continue;
    limits.cores_per_run = std::max(limits.cores_per_run, command->cores);
    const int most = command->at_once;
    if (most > 0)
      limits.most_per_host = limits.most_per_host == 0 ? most : std::min(limits.most_per_host, most);
  }
  return limits;
}

// Every connection needs a descriptor, of workers and of strangers. As many as the system allows, within
// reason: each may cost the master some 10 KB.
void AllowManyConnections() {
  constexpr rlim_t kMostDescriptors = 16384;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kMostDescriptors) return;
  limit.rlim_cur = std::min(limit.rlim_max, kMostDescriptors);
  setrlimit(RLIMIT_NOFILE, &limit);
}

std::string DescribePool(const SessionOptions& options) {
  return options.make_pool ? "an elastic pool" : fmt::format("{} workers", options.workers);
}

}  // namespace

CampaignServer::CampaignServer(CampaignOwnership& campaign, const std::vector<SearchPlan>& plans,
                               const proto::GoldenHashes& golden_hashes, const SessionOptions& options)
    : campaign_(campaign),
      plans_(plans),
      options_(options),
      identity_{campaign.origin.campaign_id, campaign.epoch, GAUNTLET_VERSION, golden_hashes},
      cpu_before_(CostOfThisProcess().cpu_seconds),
      dispatch_(LimitsFor(plans, options)),
      files_{campaign} {
  view_.campaign_id = identity_.campaign_id;
  view_.experiment = plans.front().experiment.name;
  view_.host = IdentifyThisProcess().host;
  view_.pid = getpid();
  view_.epoch = campaign.epoch;
  view_.started_unix_ms = UnixMilliseconds();
  view_.batch_job = options.batch_job;
  if (options.metrics != nullptr) view_.metrics_url = options.metrics->url();
}

CampaignServer::Files::~Files() {
  // In the place of a directory that is gone may stand another campaign's.
  if (const Status ours = campaign.check(); !ours && ours.error().kind == ErrorKind::kNotFound) return;
  const CampaignDirectory& directory = campaign.directory;
  if (Status removed = proto::RemoveAccess(directory.access_path(), campaign.epoch); !removed)
    spdlog::warn("{}", removed.error().message);
  if (!directory.CheckEpoch(campaign.epoch)) return;
  std::error_code ignored;
  std::filesystem::remove(directory.status_path(), ignored);
  std::filesystem::remove(directory.stop_path(), ignored);
  std::filesystem::remove(directory.snapshot_path(), ignored);
}

Result<SessionReport> CampaignServer::Serve() {
  TRY(OpenMasterLog(campaign_.directory.log_path() + "/master.log"));
  spdlog::info("master {} of campaign {} with {}", view_.epoch, view_.campaign_id, DescribePool(options_));
  for (const auto step : {&CampaignServer::MakeSearches, &CampaignServer::Listen, &CampaignServer::StartPool,
                          &CampaignServer::RestoreSearches, &CampaignServer::Announce}) {
    TRY((this->*step)());
  }
  const Result<CampaignEnd> end = Run();
  LetWorkersGo(end);
  if (end) return Report(*end);
  spdlog::error("stopped: {}", end.error().message);
  return end.error();
}

Status CampaignServer::MakeSearches() {
  // A master may have died between creating the campaign and storing its searches.
  TRY(AddSearches(plans_, *campaign_.store));
  for (const SearchPlan& plan : plans_) {
    TRY(std::unique_ptr<SearchAlgorithm> search, MakeStoredSearch(plan, *campaign_.store));
    searches_.push_back(std::move(search));
  }
  return Ok{};
}

// A socket for workers, who have to know the campaign's key: other users of this machine reach every address
// of it, loopback included.
Status CampaignServer::Listen() {
  AllowManyConnections();
  proto::Access access;
  access.campaign_id = view_.campaign_id;
  access.epoch = view_.epoch;
  access.controllers = proto::ControllersOf(identity_.golden_hashes);
  ZmqTransportOptions transport;
  transport.endpoint = options_.bind;
  if (!options_.insecure) {
    TRY(CampaignKeys keys, LoadOrMakeKeys(campaign_.directory.key_path()));
    access.curve = proto::CurveKeys{keys.master.public_key, keys.worker.public_key, keys.worker.secret_key};
    transport.curve = keys;
  }
  TRY(transport_, ZmqTransport::Bind(transport));
  access.endpoints = ReachableEndpoints(transport_->endpoint());
  if (options_.insecure) {
    spdlog::warn("INSECURE: whoever reaches {} can read this campaign and feed it results",
                 access.endpoints.front());
  }
  view_.endpoints = access.endpoints;
  view_.encrypted = access.curve.has_value();
  return proto::WriteAccess(campaign_.directory.access_path(), access);
}

Status CampaignServer::StartPool() {
  if (options_.make_pool) {
    pool_ = options_.make_pool();
  } else if (options_.workers > 0) {
    LocalPoolOptions local;
    local.workers = options_.workers;
    local.access_file = campaign_.directory.access_path();
    local.log_directory = campaign_.directory.log_path();
    TRY(pool_, LocalPool::Start(local, clock_.Now()));
  }
  return Ok{};
}

Status CampaignServer::RestoreSearches() {
  TRY(const ObservedReproducibility observed, ReadReproducibility(plans_, *campaign_.store));
  dispatch_.reproducible = observed.state;
  backend_ = std::make_unique<RemoteBackend>(identity_, dispatch_, *transport_, clock_, pool_.get());
  backend_->WatchFd(campaign_.store->CommitNotifier());
  SearchLoop::Parts parts{{}, *backend_, *campaign_.store, clock_, options_.feed};
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Experiment& experiment = plans_[i].experiment;
    drivers_.emplace_back(SearchDriver::Parts{
        .plan = plans_[i],
        .search = *searches_[i],
        .backend = *backend_,
        .store = *campaign_.store,
        .on_run = [this, &experiment](const StoredRun& run,
                                      const FinishedRun& finished) { KeepBundle(experiment, run, finished); },
        .feed = options_.feed});
    parts.searches.push_back(&drivers_.back());
  }
  loop_.emplace(parts);
  TRY(loop_->Restore());
  runs_before_ = loop_->runs_done();
  if (options_.feed == nullptr) return Ok{};
  return options_.feed->Begin(plans_.front().id, *searches_.front()->Stream(), *campaign_.store);
}

// Into the campaign's events, and to who has started this master.
Status CampaignServer::Announce() {
  if (!campaign_.origin.copied_from.empty())
    spdlog::info("copied: the directory is a copy of campaign {}", campaign_.origin.copied_from);
  NoteEvent(view_.epoch == 1 ? event::kStart : event::kResume,
            fmt::format("master {} with {}", view_.epoch, DescribePool(options_)));
  TRY(view_.nondeterministic_before, CountNondeterministic(*campaign_.store));
  TRY(view_.lone_verdicts_before, CountLoneVerdicts(*campaign_.store));
  snapshots_.emplace(SnapshotOptions{.database = campaign_.directory.database_path(),
                                     .snapshot = campaign_.directory.snapshot_path(),
                                     .commits = [this] { return campaign_.store->Commits(); }});
  options_.on_serving({view_.endpoints, view_.encrypted});
  return Ok{};
}

Result<CampaignEnd> CampaignServer::Run() {
  const auto stop = [this] {
    if (outdated_ || options_.stop_requested()) return StopWish::kNow;
    return view_.stopping ? StopWish::kAfterRuns : StopWish::kNone;
  };
  const auto on_progress = [this](const CampaignProgress& progress) {
    if (const TimePoint now = clock_.Now(); now >= next_status_) {
      next_status_ = now + kStatusEvery;
      Publish(progress);
    }
    options_.on_progress(progress);
  };
  Result<CampaignEnd> end = loop_->Run(stop, on_progress);
  if (outdated_ && end) return *outdated_;
  return end;
}

void CampaignServer::Publish(const CampaignProgress& progress) {
  const CampaignDirectory& directory = campaign_.directory;
  if (const Status ours = campaign_.check();
      !ours && (ours.error().kind == ErrorKind::kInUse || ours.error().kind == ErrorKind::kNotFound)) {
    outdated_ = ours.error();
    return;  // what lies there is not ours
  }
  if (std::error_code ignored; !view_.stopping && std::filesystem::exists(directory.stop_path(), ignored)) {
    view_.stopping = true;
    spdlog::info("asked to stop");
  }
  view_.now_unix_ms = UnixMilliseconds();
  const BackendView seen = backend_->Describe();
  const std::string json = StatusJson(view_, progress, seen);
  if (const Status written = ReplaceFile(directory.status_path(), json, kReadableByAll); !written)
    spdlog::debug("status: {}", written.error().message);
  if (options_.metrics != nullptr)
    options_.metrics->Publish(MetricsText(StatusMetrics(view_, progress, seen), CostOfThisProcess()));
}

// Workers from elsewhere outlive this master unless there is nothing left to do, or no more is wanted.
void CampaignServer::LetWorkersGo(const Result<CampaignEnd>& end) {
  const bool unfinished = !view_.stopping && (!end || *end == CampaignEnd::kStopped);
  const bool replaced = !end && end.error().kind == ErrorKind::kInUse;
  const bool to_successor = replaced || (unfinished && !options_.batch_job.empty());
  if (pool_ == nullptr ? unfinished : to_successor && pool_->Release()) {
    backend_->StopLeasing();
    (void)backend_->Poll(std::chrono::milliseconds(0));  // sends the last acknowledgements
  } else {
    backend_->Shutdown(kShutdownTime);
  }
}

Result<SessionReport> CampaignServer::Report(CampaignEnd end) {
  loop_->StoreEvents();  // of the time in which workers were let go
  SessionReport report;
  report.end = end;
  report.workers = backend_->Statistics();
  if (report.workers.audits > 0) {
    NoteEvent(event::kAudit,
              fmt::format("{} runs were simulated on a second worker, {} again on the only one there "
                          "was, {} ended differently",
                          report.workers.audits - report.workers.audits_alone, report.workers.audits_alone,
                          report.workers.nondeterministic + report.workers.differences));
  }
  NoteEvent(end == CampaignEnd::kFinished ? event::kFinished : event::kStop,
            fmt::format("{} runs stored", loop_->runs_done()));
  TRY(campaign_.store->Flush());
  TRY(campaign_.check());
  report.runs_this_session = loop_->runs_done() - runs_before_;
  report.wall_seconds = std::chrono::duration<double>(clock_.Now() - started_).count();
  report.master_cpu_seconds = CostOfThisProcess().cpu_seconds - cpu_before_;
  // Of a stream nobody here needs to know every case.
  TRY(report.summary, options_.feed == nullptr ? Summarise(plans_, *campaign_.store)
                                               : SummariseTotals(plans_, *campaign_.store));
  return report;
}

void CampaignServer::KeepBundle(const Experiment& experiment, const StoredRun& run,
                                const FinishedRun& finished) const {
  if (!LeavesBundle(finished.result.verdict)) return;
  const BundleContext context{campaign_.directory.path(), identity_, dispatch_};
  if (const Status written = WriteBundle(context, experiment, run, finished); !written)
    spdlog::warn("no bundle for run {}: {}", proto::RunText(run.id), written.error().message);
}

void CampaignServer::NoteEvent(const std::string& kind, const std::string& text) {
  campaign_.store->AddEvent({UnixMilliseconds(), kind, text});
}

}  // namespace gauntlet
