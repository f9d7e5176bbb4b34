#include "master/campaign/campaign_session.h"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "master/campaign/access_file.h"
#include "master/campaign/atomic_file.h"
#include "master/campaign/campaign_keys.h"
#include "master/campaign/campaign_ownership.h"
#include "master/campaign/campaign_status.h"
#include "master/campaign/process_identity.h"
#include "master/campaign/reachable_endpoints.h"
#include "master/campaign/stored_check.h"
#include "master/campaign/worker_program.h"
#include "master/dispatch/local_pool.h"
#include "master/dispatch/remote_backend.h"
#include "master/dispatch/zmq_transport.h"
#include "master/experiment/experiment_file.h"
#include "master/search/case_list_search.h"
#include "master/search/make_search.h"

namespace gauntlet::master {
namespace {

constexpr std::string_view kSoftwareVersion = GAUNTLET_VERSION;
constexpr SearchId kOnlySearch = 1;
constexpr std::chrono::milliseconds kShutdownTime{2000};
constexpr std::chrono::milliseconds kStatusEvery{1000};

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string HashText(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

Result<Experiment> ReadExperiment(const CampaignDirectory& directory) {
  Result<std::string> text = ReadSmallFile(directory.experiment_path());
  if (!text) return text.error();
  return ParseExperiment(*text, directory.experiment_path(), {});
}

// The search as it was before its first evaluation.
Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const Experiment& experiment, ResultStore& store) {
  if (experiment.search.kind != SearchKind::kCases) return MakeSearch(experiment, kOnlySearch);
  Result<std::vector<Individual>> individuals = store.LoadIndividuals(kOnlySearch);
  if (!individuals) return individuals.error();
  if (individuals->empty()) {
    return Error{ErrorKind::kCorrupt,
                 "the campaign was stopped before its cases were stored: evaluate them anew"};
  }
  std::vector<sim::TestCase> cases;
  for (Individual& individual : *individuals) cases.push_back(std::move(individual.test_case));
  return std::unique_ptr<SearchAlgorithm>(
      std::make_unique<CaseListSearch>(std::move(cases), experiment.search.replicates));
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

// A socket for workers, with keys when others than this machine can reach it.
struct Serving {
  std::unique_ptr<ZmqTransport> transport;
  AccessInfo access;
};
Result<Serving> Listen(const CampaignOwnership& campaign, const SessionOptions& options) {
  AccessInfo access;
  access.campaign = campaign.store->meta().campaign_id;
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

// The master's log, beside those of its workers. Logging is no reason to stop: without a file it is silent.
void OpenLog(const CampaignDirectory& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory.log_path(), error);
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(directory.log_path() + "/master.log");
    auto logger = std::make_shared<spdlog::logger>("master", std::move(sink));
    logger->flush_on(spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex&) {
    spdlog::set_level(spdlog::level::off);
  }
}

// Removes what only a living master may leave in the directory.
class LivingMasterFiles {
 public:
  LivingMasterFiles(const CampaignDirectory& directory, std::uint64_t epoch)
      : directory_(directory), epoch_(epoch) {
    std::error_code ignored;
    std::filesystem::remove(directory.stop_path(), ignored);  // meant for a former master
  }
  LivingMasterFiles(const LivingMasterFiles&) = delete;
  LivingMasterFiles& operator=(const LivingMasterFiles&) = delete;
  ~LivingMasterFiles() {
    if (Status removed = RemoveAccessFile(directory_.access_path(), epoch_); !removed) {
      spdlog::warn("{}", removed.error().message);
    }
    std::error_code ignored;
    std::filesystem::remove(directory_.status_path(), ignored);
    std::filesystem::remove(directory_.stop_path(), ignored);
  }

 private:
  const CampaignDirectory& directory_;
  std::uint64_t epoch_;
};

// Serves an owned campaign until its search has finished or it is to stop.
Result<SessionReport> Serve(CampaignOwnership& campaign, const Experiment& experiment,
                            std::uint64_t golden_hash, const SessionOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const double cpu_before = CpuSeconds();
  SqliteStore& store = *campaign.store;
  OpenLog(campaign.directory);
  spdlog::info("master {} of campaign {}: {} workers", campaign.epoch, store.meta().campaign_id,
               options.workers);
  const LivingMasterFiles living(campaign.directory, campaign.epoch);

  Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(experiment, store);
  if (!search) return search.error();

  Result<Serving> serving = Listen(campaign, options);
  if (!serving) return serving.error();
  const SteadyClock clock;
  std::unique_ptr<LocalPool> pool;
  if (options.workers > 0) {
    LocalPoolOptions pool_options;
    pool_options.workers = options.workers;
    pool_options.access_file = campaign.directory.access_path();
    pool_options.log_directory = campaign.directory.log_path();
    Result<std::unique_ptr<LocalPool>> started_pool = LocalPool::Start(pool_options, clock.Now());
    if (!started_pool) return started_pool.error();
    pool = *std::move(started_pool);
  }

  const CampaignIdentity identity{store.meta().campaign_id, campaign.epoch, std::string(kSoftwareVersion),
                                  golden_hash};
  RemoteBackend backend(identity, DispatchOptions{}, *serving->transport, clock, pool.get());
  backend.WatchFd(store.CommitNotifier());
  CampaignRunner runner({.experiment = experiment,
                         .search_id = kOnlySearch,
                         .purpose = PurposeOf(experiment.search.kind),
                         .search = **search,
                         .backend = backend,
                         .store = store,
                         .clock = clock});
  if (Status restored = runner.Restore(); !restored) return restored.error();
  store.AddEvent({UnixMilliseconds(), campaign.epoch == 1 ? "start" : "resume",
                  fmt::format("master {} with {} workers", campaign.epoch, options.workers)});

  MasterView view;
  view.campaign_id = store.meta().campaign_id;
  view.experiment = experiment.name;
  view.host = IdentifyThisProcess().host;
  view.pid = getpid();
  view.epoch = campaign.epoch;
  view.started_unix_ms = UnixMilliseconds();
  view.endpoints = serving->access.endpoints;
  view.encrypted = serving->access.curve.has_value();
  options.on_serving({view.endpoints, view.encrypted});

  TimePoint last_status = clock.Now() - kStatusEvery;
  const std::uint64_t runs_before = runner.runs_done();
  const auto stop = [&] {
    if (options.stop_requested()) return StopWish::kNow;
    return view.stopping ? StopWish::kAfterRuns : StopWish::kNone;
  };
  Result<CampaignEnd> end = runner.Run(stop, [&](const CampaignProgress& progress) {
    if (const TimePoint now = clock.Now(); now - last_status >= kStatusEvery) {
      std::error_code ignored;
      if (!view.stopping && std::filesystem::exists(campaign.directory.stop_path(), ignored)) {
        view.stopping = true;
        spdlog::info("asked to stop");
      }
      view.now_unix_ms = UnixMilliseconds();
      const Status written = ReplaceFile(campaign.directory.status_path(),
                                         StatusJson(view, progress, backend.Describe()), kReadableByAll);
      if (!written) spdlog::debug("status: {}", written.error().message);
      last_status = now;
    }
    options.on_progress(progress);
  });
  // Workers from elsewhere outlive this master unless there is nothing left to do, or no more is wanted.
  const bool workers_stay = pool == nullptr && !view.stopping && (!end || *end == CampaignEnd::kStopped);
  if (workers_stay) {
    backend.StopLeasing();
    (void)backend.Poll(std::chrono::milliseconds(0));  // sends the last acknowledgements
  } else {
    backend.Shutdown(kShutdownTime);
  }
  if (!end) {
    spdlog::error("stopped: {}", end.error().message);
    return end.error();
  }
  store.AddEvent({UnixMilliseconds(), *end == CampaignEnd::kFinished ? "finished" : "stop",
                  fmt::format("{} runs stored", runner.runs_done())});
  if (Status flushed = store.Flush(); !flushed) return flushed.error();

  SessionReport report;
  report.end = *end;
  report.runs_this_session = runner.runs_done() - runs_before;
  report.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  report.master_cpu_seconds = CpuSeconds() - cpu_before;
  Result<std::unique_ptr<SearchAlgorithm>> fresh = MakeStoredSearch(experiment, store);
  if (!fresh) return fresh.error();
  Result<CampaignSummary> summary = Summarise(experiment, kOnlySearch, **fresh, store);
  if (!summary) return summary.error();
  report.summary = std::move(*summary);
  return report;
}

}  // namespace

Result<SessionReport> StartCampaign(const std::string& dir, const Experiment& experiment,
                                    const std::vector<sim::TestCase>& cases, const SessionOptions& options) {
  Result<std::uint64_t> golden_hash = GoldenHashOfThisMachine();
  if (!golden_hash) return golden_hash.error();
  CampaignMeta meta;
  meta.software_version = kSoftwareVersion;
  meta.golden_hash = HashText(*golden_hash);
  const std::string text = WriteExperiment(
      experiment, {fmt::format("Resolved experiment of this campaign; made by gauntlet {}, golden hash {}.",
                               kSoftwareVersion, meta.golden_hash)});
  Result<CampaignOwnership> campaign = CreateCampaign(dir, text, meta);
  if (!campaign) return campaign.error();
  SqliteStore& store = *campaign->store;
  store.AddSearch(
      {kOnlySearch, experiment.name, std::string(NameOf(experiment.search.kind)), experiment.seed, false});
  if (experiment.search.kind == SearchKind::kCases) {
    store.AddIndividuals(kOnlySearch, CaseListSearch(cases, experiment.search.replicates).Population());
  }
  if (Status flushed = store.Flush(); !flushed) return flushed.error();
  return Serve(*campaign, experiment, *golden_hash, options);
}

Result<SessionReport> ResumeCampaign(const std::string& dir, const SessionOptions& options) {
  Result<CampaignOwnership> campaign = TakeCampaign(dir);
  if (!campaign) return campaign.error();
  Result<Experiment> experiment = ReadExperiment(campaign->directory);
  if (!experiment) return experiment.error();
  Result<std::uint64_t> golden_hash = GoldenHashOfThisMachine();
  if (!golden_hash) return golden_hash.error();
  if (Status comparable = CheckGoldenHash(campaign->store->meta(), *golden_hash); !comparable)
    return comparable.error();

  if (Status whole = CheckStored(*experiment, kOnlySearch, *campaign->store); !whole) return whole.error();

  Result<std::vector<StoredSearch>> searches = campaign->store->LoadSearches();
  if (!searches) return searches.error();
  if (searches->empty()) {  // the master died between creating the campaign and storing its search
    campaign->store->AddSearch({kOnlySearch, experiment->name, std::string(NameOf(experiment->search.kind)),
                                experiment->seed, false});
  } else if (searches->front().finished) {
    Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(*experiment, *campaign->store);
    if (!search) return search.error();
    Result<CampaignSummary> summary = Summarise(*experiment, kOnlySearch, **search, *campaign->store);
    if (!summary) return summary.error();
    SessionReport report;
    report.summary = std::move(*summary);
    return report;
  }
  return Serve(*campaign, *experiment, *golden_hash, options);
}

Result<CampaignSummary> ReadCampaign(const std::string& dir) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  Result<Experiment> experiment = ReadExperiment(campaign->directory);
  if (!experiment) return experiment.error();
  Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(*experiment, *campaign->store);
  if (!search) return search.error();
  if (Status whole = CheckStored(*experiment, kOnlySearch, *campaign->store); !whole) return whole.error();
  return Summarise(*experiment, kOnlySearch, **search, *campaign->store);
}

Status ForEachStoredRun(const std::string& dir, const std::function<void(const StoredRun&)>& visit) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  return campaign->store->ForEachRun(kOnlySearch, 0, visit);
}

Result<CampaignReplay> ReplayCampaignRun(const std::string& dir, RunId run) {
  Result<CampaignView> campaign = ViewCampaign(dir);
  if (!campaign) return campaign.error();
  Result<Experiment> experiment = ReadExperiment(campaign->directory);
  if (!experiment) return experiment.error();
  Result<ReplayReport> report = ReplayRun(*campaign->store, run);
  if (!report) return report.error();
  if (report->damage.empty()) {
    if (Status belongs = CheckSeed(*experiment, report->stored); !belongs) return belongs.error();
  }
  return CampaignReplay{std::move(*experiment), std::move(*report)};
}

}  // namespace gauntlet::master
