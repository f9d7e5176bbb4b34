#include "master/session/campaign_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>

#include "base/system/atomic_file.h"
#include "base/system/process_identity.h"
#include "controllers/registry.h"
#include "master/directory/campaign_keys.h"
#include "master/directory/campaign_ownership.h"
#include "master/dispatch/local_pool.h"
#include "master/dispatch/remote_backend.h"
#include "master/dispatch/run_limits.h"
#include "master/dispatch/worker_program.h"
#include "master/dispatch/zmq_transport.h"
#include "master/experiment/experiment_file.h"
#include "master/report/campaign_status.h"
#include "master/report/metrics_text.h"
#include "master/report/stored_campaign.h"
#include "master/report/stored_search.h"
#include "master/search/case_list_search.h"
#include "master/search/make_search.h"
#include "master/session/access_file.h"
#include "master/session/bind_endpoint.h"
#include "master/session/campaign_runner.h"
#include "master/session/master_log.h"
#include "master/session/metrics_server.h"
#include "master/session/reachable_endpoints.h"
#include "master/session/reproduction_bundle.h"

namespace gauntlet::master {
namespace {

constexpr std::string_view kSoftwareVersion = GAUNTLET_VERSION;
constexpr std::chrono::milliseconds kShutdownTime{2000};
constexpr std::chrono::milliseconds kStatusEvery{1000};

std::string HashText(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

// Golden hashes decide whether this machine computes the bits that the campaign was begun with.
Status CheckGoldenHash(const CampaignMeta& meta, std::uint64_t golden_hash) {
  if (meta.golden_hash == HashText(golden_hash)) return Ok{};
  return Error{
      ErrorKind::kVersion,
      fmt::format("the campaign was begun by version {} with golden hash {}, this is version {} with {}: its "
                  "simulations would not be comparable",
                  meta.software_version, meta.golden_hash, kSoftwareVersion, HashText(golden_hash))};
}

std::vector<std::string> NamesOfControllers() {
  std::vector<std::string> names;
  for (const controllers::ControllerInfo& controller : controllers::Controllers())
    names.emplace_back(controller.name);
  return names;
}

// Adds the searches that the store does not know yet; those it knows come back.
Result<std::vector<StoredSearch>> AddSearches(const std::vector<SearchPlan>& plans, ResultStore& store) {
  Result<std::vector<StoredSearch>> known = store.LoadSearches();
  if (!known) return known;
  // A master may have died between creating the campaign and storing its searches.
  for (std::size_t i = known->size(); i < plans.size(); ++i) {
    const Experiment& experiment = plans[i].experiment;
    std::string name = experiment.name;
    if (!plans[i].settings.empty()) name += ": " + plans[i].settings;
    store.AddSearch({static_cast<SearchId>(i + 1), name, std::string(NameOf(experiment.search.kind)),
                     experiment.seed, false});
  }
  return known;
}

std::vector<SearchId> FinishedOf(const std::vector<StoredSearch>& searches) {
  std::vector<SearchId> finished;
  for (const StoredSearch& search : searches) {
    if (search.finished) finished.push_back(search.id);
  }
  return finished;
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

// A socket for workers, with keys when others than this machine can reach it.
struct Serving {
  std::unique_ptr<ZmqTransport> transport;
  AccessInfo access;
};
Result<Serving> Listen(const CampaignOwnership& campaign, const SessionOptions& options) {
  AccessInfo access;
  access.campaign = campaign.origin.campaign_id;
  access.epoch = campaign.epoch;
  ZmqTransportOptions transport_options;
  transport_options.endpoint = options.bind;
  if (!IsLocalEndpoint(options.bind) && !options.insecure) {
    Result<CampaignKeys> keys = LoadOrMakeKeys(campaign.directory.key_path());
    if (!keys) return keys.error();
    access.curve = AccessKeys{keys->master.public_key, keys->worker.public_key, keys->worker.secret_key};
    transport_options.curve = CurveServer{keys->master, {keys->worker.public_key}};
  }
  Result<std::unique_ptr<ZmqTransport>> transport = ZmqTransport::Bind(transport_options);
  if (!transport) return transport.error();
  access.endpoints = ReachableEndpoints((*transport)->endpoint());
  if (Status written = WriteAccessFile(campaign.directory.access_path(), access); !written)
    return written.error();
  return Serving{*std::move(transport), std::move(access)};
}

// The master's log, beside those of its workers.
void OpenLog(const CampaignDirectory& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory.log_path(), error);
  OpenMasterLog(directory.log_path() + "/master.log");
}

// Removes what only a living master may leave in the directory.
class LivingMasterFiles {
 public:
  LivingMasterFiles(const CampaignDirectory& directory, std::uint64_t epoch)
      : directory_(directory), epoch_(epoch) {}
  LivingMasterFiles(const LivingMasterFiles&) = delete;
  LivingMasterFiles& operator=(const LivingMasterFiles&) = delete;
  ~LivingMasterFiles() {
    if (Status removed = RemoveAccessFile(directory_.access_path(), epoch_); !removed) {
      spdlog::warn("{}", removed.error().message);
    }
    if (!directory_.CheckEpoch(epoch_)) return;  // the rest is a newer master's
    std::error_code ignored;
    std::filesystem::remove(directory_.status_path(), ignored);
    std::filesystem::remove(directory_.stop_path(), ignored);
  }

 private:
  const CampaignDirectory& directory_;
  std::uint64_t epoch_;
};

Result<std::unique_ptr<WorkerPool>> MakePool(const CampaignDirectory& directory,
                                             const SessionOptions& options, const Clock& clock) {
  if (options.make_pool) {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(directory.path(), error);
    if (error) return SystemError(fmt::format("cannot find {}", directory.path()), error.value());
    return options.make_pool({absolute / "access.json", absolute / "log"});
  }
  if (options.workers == 0) return std::unique_ptr<WorkerPool>();
  LocalPoolOptions pool_options;
  pool_options.workers = options.workers;
  pool_options.access_file = directory.access_path();
  pool_options.log_directory = directory.log_path();
  Result<std::unique_ptr<LocalPool>> pool = LocalPool::Start(pool_options, clock.Now());
  if (!pool) return pool.error();
  return std::unique_ptr<WorkerPool>(*std::move(pool));
}

std::string DescribePool(const SessionOptions& options) {
  return options.make_pool ? "an elastic pool" : fmt::format("{} workers", options.workers);
}

// Serves an owned campaign until its search has finished or it is to stop.
Result<SessionReport> Serve(CampaignOwnership& campaign, const std::vector<SearchPlan>& plans,
                            std::uint64_t golden_hash, const SessionOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const double cpu_before = CostOfThisProcess().cpu_seconds;
  SqliteStore& store = *campaign.store;
  OpenLog(campaign.directory);
  spdlog::info("master {} of campaign {} with {}", campaign.epoch, campaign.origin.campaign_id,
               DescribePool(options));
  const LivingMasterFiles living(campaign.directory, campaign.epoch);

  const Result<std::vector<StoredSearch>> known = AddSearches(plans, store);
  if (!known) return known.error();
  std::vector<std::unique_ptr<SearchAlgorithm>> searches;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    Result<std::unique_ptr<SearchAlgorithm>> search =
        MakeStoredSearch(plans[i].experiment, static_cast<SearchId>(i + 1), store);
    if (!search) return search.error();
    searches.push_back(*std::move(search));
  }

  AllowManyConnections();
  Result<Serving> serving = Listen(campaign, options);
  if (!serving) return serving.error();
  if (!serving->access.curve && !IsLocalEndpoint(options.bind)) {
    spdlog::warn("INSECURE: whoever reaches {} can read this campaign and feed it results",
                 serving->access.endpoints.front());
  }
  const SteadyClock clock;
  Result<std::unique_ptr<WorkerPool>> made_pool = MakePool(campaign.directory, options, clock);
  if (!made_pool) return made_pool.error();
  const std::unique_ptr<WorkerPool> pool = *std::move(made_pool);

  const CampaignIdentity identity{campaign.origin.campaign_id, campaign.epoch, std::string(kSoftwareVersion),
                                  golden_hash, NamesOfControllers()};
  DispatchOptions dispatch;
  dispatch.audit_share = options.audit_share;
  for (const SearchPlan& plan : plans) {
    dispatch.cpu_limit_seconds =
        std::max(dispatch.cpu_limit_seconds,
                 CpuLimitSeconds(plan.experiment.scenario, plan.experiment.scenario_parameters));
  }
  RemoteBackend backend(identity, dispatch, *serving->transport, clock, pool.get());
  backend.WatchFd(store.CommitNotifier());
  const BundleContext bundles{campaign.directory.path(), campaign.origin.campaign_id,
                              std::string(kSoftwareVersion), HashText(golden_hash), dispatch};
  const auto keep_bundle = [&bundles](const Experiment& experiment) {
    return [&bundles, &experiment](const StoredRun& run, const FinishedRun& finished) {
      if (!LeavesBundle(finished.result.verdict)) return;
      const Status written = WriteBundle(bundles, experiment, run, finished);
      if (!written) spdlog::warn("no bundle for run {}: {}", run.id, written.error().message);
    };
  };
  std::deque<SearchDriver> drivers;
  CampaignRunner::Parts parts{{}, backend, store, clock};
  for (std::size_t i = 0; i < plans.size(); ++i) {
    drivers.emplace_back(SearchDriver::Parts{.experiment = plans[i].experiment,
                                             .search_id = static_cast<SearchId>(i + 1),
                                             .search = *searches[i],
                                             .backend = backend,
                                             .store = store,
                                             .on_run = keep_bundle(plans[i].experiment)});
    parts.searches.push_back(&drivers.back());
  }
  CampaignRunner runner(parts);
  if (Status restored = runner.Restore(FinishedOf(*known)); !restored) return restored.error();
  if (!campaign.origin.copied_from.empty()) {
    const std::string text =
        fmt::format("this directory is a copy of campaign {}; it is campaign {} from now on",
                    campaign.origin.copied_from, campaign.origin.campaign_id);
    spdlog::info("copied: {}", text);
    store.AddEvent({UnixMilliseconds(), "copied", text});
  }
  store.AddEvent({UnixMilliseconds(), campaign.epoch == 1 ? "start" : "resume",
                  fmt::format("master {} with {}", campaign.epoch, DescribePool(options))});

  MasterView view;
  view.campaign_id = campaign.origin.campaign_id;
  view.experiment = plans.front().experiment.name;
  view.host = IdentifyThisProcess().host;
  view.pid = getpid();
  view.epoch = campaign.epoch;
  view.started_unix_ms = UnixMilliseconds();
  view.endpoints = serving->access.endpoints;
  view.encrypted = serving->access.curve.has_value();
  view.batch_job = options.batch_job;
  const Result<std::uint64_t> nondeterministic = CountNondeterministic(store);
  if (!nondeterministic) return nondeterministic.error();
  view.nondeterministic_before = *nondeterministic;
  if (options.metrics != nullptr) view.metrics_url = options.metrics->url();
  options.on_serving({view.endpoints, view.encrypted});

  TimePoint last_status = clock.Now() - kStatusEvery;
  const std::uint64_t runs_before = runner.runs_done();
  bool outdated = false;  // a newer master has begun
  const auto stop = [&] {
    if (outdated || options.stop_requested()) return StopWish::kNow;
    return view.stopping ? StopWish::kAfterRuns : StopWish::kNone;
  };
  Result<CampaignEnd> end = runner.Run(stop, [&](const CampaignProgress& progress) {
    if (const TimePoint now = clock.Now(); now - last_status >= kStatusEvery) {
      last_status = now;
      const Status newest = campaign.directory.CheckEpoch(campaign.epoch);
      outdated = !newest && newest.error().kind == ErrorKind::kInUse;
      if (outdated) return;  // what lies there is the newer one's
      std::error_code ignored;
      if (!view.stopping && std::filesystem::exists(campaign.directory.stop_path(), ignored)) {
        view.stopping = true;
        spdlog::info("asked to stop");
      }
      view.now_unix_ms = UnixMilliseconds();
      const BackendView seen = backend.Describe();
      const Status written =
          ReplaceFile(campaign.directory.status_path(), StatusJson(view, progress, seen), kReadableByAll);
      if (!written) spdlog::debug("status: {}", written.error().message);
      if (options.metrics != nullptr)
        options.metrics->Publish(MetricsText(view, progress, seen, CostOfThisProcess()));
    }
    options.on_progress(progress);
  });
  if (outdated && end) end = campaign.directory.CheckEpoch(campaign.epoch).error();
  outdated = outdated || (!end && end.error().kind == ErrorKind::kInUse);
  // Workers from elsewhere outlive this master unless there is nothing left to do, or no more is wanted.
  const bool unfinished = !view.stopping && (!end || *end == CampaignEnd::kStopped);
  const bool to_successor = outdated || (unfinished && !options.batch_job.empty());
  if (pool == nullptr ? unfinished : to_successor && pool->Release()) {
    backend.StopLeasing();
    (void)backend.Poll(std::chrono::milliseconds(0));  // sends the last acknowledgements
  } else {
    backend.Shutdown(kShutdownTime);
  }
  if (!end) {
    spdlog::error("stopped: {}", end.error().message);
    return end.error();
  }
  runner.StoreEvents();  // of the time since
  const WorkerStatistics workers = backend.Statistics();
  if (workers.audits > 0) {
    store.AddEvent(
        {UnixMilliseconds(), "audit",
         fmt::format("{} runs were simulated on a second worker, {} again on the only one there "
                     "was, {} ended differently",
                     workers.audits - workers.audits_alone, workers.audits_alone, workers.nondeterministic)});
  }
  store.AddEvent({UnixMilliseconds(), *end == CampaignEnd::kFinished ? "finished" : "stop",
                  fmt::format("{} runs stored", runner.runs_done())});
  if (Status flushed = store.Flush(); !flushed) return flushed.error();

  SessionReport report;
  report.workers = workers;
  report.end = *end;
  report.runs_this_session = runner.runs_done() - runs_before;
  report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  report.master_cpu_seconds = CostOfThisProcess().cpu_seconds - cpu_before;
  Result<CampaignSummary> summary = SummariseAll(plans, store);
  if (!summary) return summary.error();
  report.summary = std::move(*summary);
  return report;
}

}  // namespace

namespace {

struct NewCampaign {
  CampaignOwnership ownership;
  std::uint64_t golden_hash = 0;
};

// Whether every search can begin, asked before anything is written.
Status CheckSearches(const std::vector<SearchPlan>& plans) {
  for (const SearchPlan& plan : plans) {
    if (plan.experiment.search.kind == SearchKind::kCases) continue;
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeSearch(plan.experiment, kOnlySearch);
    if (search) continue;
    if (plan.settings.empty()) return search.error();
    return Error{search.error().kind, fmt::format("{}: {}", plan.settings, search.error().message)};
  }
  return Ok{};
}

Result<NewCampaign> Create(const std::string& dir, const std::vector<SearchPlan>& plans,
                           const std::vector<sim::TestCase>& cases, const std::string& slurm) {
  if (Status possible = CheckSearches(plans); !possible) return possible.error();
  Result<std::uint64_t> golden_hash = GoldenHashOfThisMachine();
  if (!golden_hash) return golden_hash.error();
  CampaignMeta meta;
  meta.software_version = kSoftwareVersion;
  meta.golden_hash = HashText(*golden_hash);
  const Experiment& experiment = plans.front().experiment;
  std::vector<std::string> header = {
      fmt::format("Resolved experiment of this campaign; made by gauntlet {}, golden hash {}.",
                  kSoftwareVersion, meta.golden_hash)};
  if (plans.size() > 1) header.emplace_back("It is the first of several: searches.json has all.");
  const CampaignTexts texts{WriteExperiment(experiment, header),
                            plans.size() > 1 ? WriteSearchPlans(plans) : "", slurm};
  Result<CampaignOwnership> campaign = CreateCampaign(dir, texts, meta);
  if (!campaign) return campaign.error();
  SqliteStore& store = *campaign->store;
  if (const auto added = AddSearches(plans, store); !added) return added.error();
  if (experiment.search.kind == SearchKind::kCases) {
    store.AddIndividuals(kOnlySearch, CaseListSearch(cases, experiment.search.replicates).Population());
  }
  if (Status flushed = store.Flush(); !flushed) return flushed.error();
  return NewCampaign{*std::move(campaign), *golden_hash};
}

}  // namespace

Result<SessionReport> StartCampaign(const std::string& dir, const Experiment& experiment,
                                    const std::vector<sim::TestCase>& cases, const SessionOptions& options) {
  const std::vector<SearchPlan> plans = {{"", experiment}};
  // Before anything is made: the corrected command is to find the directory as this one did.
  if (Status possible = TryToListen(options.bind); !possible) return possible.error();
  Result<NewCampaign> created = Create(dir, plans, cases, "");
  if (!created) return created.error();
  return Serve(created->ownership, plans, created->golden_hash, options);
}

Status PrepareCampaign(const std::string& dir, const std::vector<SearchPlan>& searches,
                       const std::string& slurm) {
  const Result<NewCampaign> created = Create(dir, searches, {}, slurm);
  if (!created) return created.error();
  return Ok{};
}

Result<SessionReport> ResumeCampaign(const std::string& dir, const SessionOptions& options) {
  Result<CampaignOwnership> campaign =
      TakeCampaign(dir, options.batch_job.empty() ? LivingMaster::kRespect : LivingMaster::kFence);
  if (!campaign) return campaign.error();
  const Result<std::vector<SearchPlan>> plans = ReadSearchPlans(campaign->directory);
  if (!plans) return plans.error();
  Result<std::uint64_t> golden_hash = GoldenHashOfThisMachine();
  if (!golden_hash) return golden_hash.error();
  if (Status comparable = CheckGoldenHash(campaign->store->meta(), *golden_hash); !comparable)
    return comparable.error();

  if (Status whole = CheckAllStored(*plans, *campaign->store); !whole) return whole.error();
  const Result<std::vector<StoredSearch>> searches = campaign->store->LoadSearches();
  if (!searches) return searches.error();
  if (FinishedOf(*searches).size() == plans->size()) {
    Result<CampaignSummary> summary = SummariseAll(*plans, *campaign->store);
    if (!summary) return summary.error();
    SessionReport report;
    report.summary = std::move(*summary);
    return report;
  }
  return Serve(*campaign, *plans, *golden_hash, options);
}

}  // namespace gauntlet::master
