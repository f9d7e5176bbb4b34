#include "master/session/campaign_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/clock.h"
#include "base/system/regular_file.h"
#include "controllers/command/definition.h"
#include "controllers/registry.h"
#include "master/campaign/stored_check.h"
#include "master/directory/campaign_ownership.h"
#include "master/directory/campaign_plugins.h"
#include "master/directory/search_length.h"
#include "master/dispatch/pool/worker_program.h"
#include "master/session/bind_endpoint.h"
#include "master/session/campaign_server.h"
#include "master/store/event_kinds.h"
#include "master/store/run_numbers.h"
#include "proto/json_text.h"
#include "proto/run_text.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using nlohmann::ordered_json;

// The golden hashes that the campaign was begun with. They decide whether this machine computes the bits that
// it has stored so far.
Result<proto::GoldenHashes> CheckGoldenHashes(const CampaignMeta& meta) {
  TRY(proto::GoldenHashes begun_with, proto::ReadGoldenHashes(meta.golden_hashes));
  TRY(const proto::GoldenHashes ours, GoldenHashesOfThisMachine(proto::ControllersOf(begun_with)));
  const auto difference = proto::FirstDifference(begun_with, ours);
  if (!difference) return begun_with;
  if (!difference->offered) {
    return Error{
        ErrorKind::kVersion,
        fmt::format("the campaign uses controller '{}', which this build of gauntlet-worker does not have",
                    difference->controller)};
  }
  return Error{
      ErrorKind::kVersion,
      fmt::format("the campaign was begun by version {} with golden hash {:016x} of controller '{}', this is "
                  "version {} with {:016x}: its simulations would not be comparable",
                  meta.software_version, difference->needed, difference->controller, GAUNTLET_VERSION,
                  *difference->offered)};
}

// The controller whose golden hash says whether a machine computes the experiment's runs as another does. Of
// a plug-in, whose library is the same everywhere, it is the scenario's own; where that is of a plug-in too,
// any that is built in, for the arithmetic that all share. Of a command it is what its probe says.
std::string GoldenControllerOf(const Experiment& experiment) {
  if (experiment.scenario == controllers::command::kScenario)
    return controllers::command::kGoldenPrefix + experiment.plugin;
  if (experiment.plugin.empty()) return experiment.controller;
  if (experiment.scenario_plugin.empty())
    return std::string(controllers::FindScenario(experiment.scenario)->default_controller);
  return std::string(controllers::Controllers().front().name);
}

// Of the controllers that the searches use.
Result<proto::GoldenHashes> GoldenHashesFor(const std::vector<SearchPlan>& plans) {
  std::set<std::string> used;
  for (const SearchPlan& plan : plans) used.insert(GoldenControllerOf(plan.experiment));
  TRY(proto::GoldenHashes ours, GoldenHashesOfThisMachine({used.begin(), used.end()}));
  for (const std::string& controller : used) {
    if (ours.contains(controller)) continue;
    return Error{ErrorKind::kVersion,
                 fmt::format("gauntlet-worker was built without the controller '{}'", controller)};
  }
  return ours;
}

struct NewCampaign {
  CampaignOwnership ownership;
  proto::GoldenHashes golden_hashes;
};

// Whether every search can begin, asked before anything is written.
Status CheckSearches(const std::vector<SearchPlan>& plans) {
  for (const SearchPlan& plan : plans) {
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeSearch(plan.experiment, plan.cases);
    if (search) continue;
    if (plan.settings.empty()) return search.error();
    return Error{search.error().kind, fmt::format("{}: {}", plan.settings, search.error().message)};
  }
  return Ok{};
}

// Whether a command's arena without obstacles can begin, which only a run of it tells.
Status CheckCommands(const std::vector<SearchPlan>& plans) {
  std::set<std::string> known;
  for (const SearchPlan& plan : plans) {
    const Experiment& experiment = plan.experiment;
    if (experiment.scenario != controllers::command::kScenario || !known.insert(experiment.plugin).second)
      continue;
    TRY(const sim::RunResult result,
        SimulateInRunner(SpecOf(experiment, EmptyArena(experiment.arena), experiment.seed)));
    if (result.verdict == sim::Verdict::kCompleted) continue;
    return InvalidInput(
        fmt::format("the program gives no result in the arena without obstacles: {}", result.message));
  }
  return Ok{};
}

// The files that say what the campaign is to do, but for slurm.toml. `begun_with`: version and golden hashes
// are those of the campaign's beginning.
CampaignTexts TextsOf(const std::vector<SearchPlan>& plans, const std::string& version,
                      const proto::GoldenHashes& begun_with) {
  const Experiment& experiment = plans.front().experiment;
  std::vector<std::string> header = {
      fmt::format("Resolved experiment of this campaign; made by gauntlet {}, golden hash {:016x}.", version,
                  begun_with.at(GoldenControllerOf(experiment)))};
  if (plans.size() > 1) header.emplace_back("It is the first of several: searches.json has all.");
  return {WriteExperiment(experiment, header, BuiltInCatalogue()),
          plans.size() > 1 ? WriteSearchPlans(plans) : ""};
}

// The searches, and the cases of those that are given some.
Status AddPlans(const std::vector<SearchPlan>& plans, ResultStore& store) {
  TRY(AddSearches(plans, store));
  for (const SearchPlan& plan : plans) {
    if (plan.cases.empty()) continue;
    TRY(const std::unique_ptr<SearchAlgorithm> search, MakeSearch(plan.experiment, plan.cases));
    store.AddIndividuals(plan.id, search->Population());
  }
  return Ok{};
}

Result<NewCampaign> Create(const std::string& dir, const std::vector<SearchPlan>& plans,
                           const std::string& slurm) {
  TRY(CheckPlugins(plans));
  TRY(CheckSearches(plans));
  TRY(proto::GoldenHashes golden_hashes, GoldenHashesFor(plans));
  TRY(CheckCommands(plans));
  CampaignMeta meta;
  meta.software_version = GAUNTLET_VERSION;
  meta.golden_hashes = proto::WriteGoldenHashes(golden_hashes);
  CampaignTexts texts = TextsOf(plans, meta.software_version, golden_hashes);
  texts.slurm = slurm;
  texts.others = [&](const CampaignDirectory& directory) {
    return KeepPlugins(directory.plugins_path(), plans);
  };
  TRY(CampaignOwnership campaign,
      CreateCampaign(dir, texts, meta, [&](ResultStore& store) { return AddPlans(plans, store); }));
  return NewCampaign{std::move(campaign), std::move(golden_hashes)};
}

class Campaigns final : public CampaignService {
 public:
  Result<SessionReport> Start(const std::string& dir, const std::vector<SearchPlan>& searches,
                              const SessionOptions& options) override {
    GAUNTLET_CHECK(!RowOf(searches.front().experiment).streamed, "a stream is prepared, and then resumed");
    // Before anything is made: the corrected command is to find the directory as this one did.
    TRY(TryToListen(options.bind));
    const std::vector<SearchPlan> plans = Numbered(searches);
    TRY(NewCampaign created, Create(dir, plans, options.slurm));
    return CampaignServer(created.ownership, plans, created.golden_hashes, options).Serve();
  }

  Status Prepare(const std::string& dir, const std::vector<SearchPlan>& searches,
                 const std::string& slurm) override {
    TRY(Create(dir, Numbered(searches), slurm));
    return Ok{};
  }

  Result<std::string> Extend(const std::string& dir, const std::vector<std::string>& sets,
                             const std::function<bool()>& give_up) override {
    TRY(const CampaignOwnership campaign, TakeCampaign(dir, LivingMaster::kRespect, give_up));
    const CampaignDirectory& directory = campaign.directory;
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(directory));
    TRY(const std::vector<SearchPlan> longer, WithLength(plans, sets));
    std::string change = DescribeLengths(plans, longer);
    if (change.empty()) return change;
    const CampaignMeta& meta = campaign.store->meta();
    TRY(const proto::GoldenHashes begun_with, CheckGoldenHashes(meta));
    if (const std::string controller = GoldenControllerOf(longer.front().experiment);
        !begun_with.contains(controller)) {
      return Error{ErrorKind::kCorrupt,
                   fmt::format("{} names the controller '{}', with which the campaign has not begun",
                               directory.experiment_path(), controller)};
    }
    const CampaignTexts texts = TextsOf(longer, meta.software_version, begun_with);
    // Of a sweep searches.json decides; experiment.toml is for people there, and follows.
    for (const auto& [path, text] : {std::pair(directory.searches_path(), texts.searches),
                                     std::pair(directory.experiment_path(), texts.experiment)}) {
      if (text.empty()) continue;
      TRY(WriteFileAtomically(path, text, kReadableByAll));
    }
    campaign.store->AddEvent({UnixMilliseconds(), event::kExtended, change});
    TRY(campaign.store->Flush());
    return change;
  }

  Result<SessionReport> Resume(const std::string& dir, const SessionOptions& options) override {
    TRY(CampaignOwnership campaign,
        TakeCampaign(dir, options.batch_job.empty() ? LivingMaster::kRespect : LivingMaster::kFence,
                     options.stop_requested));
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(campaign.directory));
    if (RowOf(plans.front().experiment).streamed && options.feed == nullptr) {
      return InvalidInput(fmt::format(
          "{} is {}: it goes on by the command that began it, gauntlet evaluate ... --stdin --dir {}", dir,
          RowOf(plans.front().experiment).title, PastedPath(dir)));
    }
    TRY(const proto::GoldenHashes golden_hashes, CheckGoldenHashes(campaign.store->meta()));
    TRY(CheckPlugins(campaign.directory.plugins_path(), plans));
    TRY(CheckStored(plans, *campaign.store));
    TRY(const CampaignSummary totals, SummariseTotals(plans, *campaign.store));
    if (!totals.finished || options.feed != nullptr) {
      if (!options.slurm.empty()) {
        TRY(WriteFileAtomically(campaign.directory.slurm_path(), options.slurm, kReadableByAll));
      }
      return CampaignServer(campaign, plans, golden_hashes, options).Serve();
    }
    TRY(CampaignSummary summary, Summarise(plans, *campaign.store));
    return SessionReport{.summary = std::move(summary)};
  }

  Result<CampaignSummary> Read(const std::string& dir) override {
    TRY(const CampaignView campaign, ViewCampaign(dir, Checked::kRows));
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(campaign.directory));
    TRY(CampaignSummary summary, CheckAndSummarise(plans, *campaign.store));
    summary.as_of = campaign.as_of;
    return summary;
  }

  Status ForEachRun(const std::string& dir, const RunVisitor& visit) override {
    TRY(const CampaignView campaign, ViewCampaign(dir));
    TRY(const std::vector<StoredSearch> searches, campaign.store->LoadSearches());
    for (const StoredSearch& search : searches) {
      TRY(campaign.store->ForEachRun(search.id, 0, visit));
    }
    return Ok{};
  }

  Result<CampaignReplay> Replay(const std::string& dir, RunId run, const std::string& scratch) override {
    TRY(const CampaignView campaign, ViewCampaign(dir, Checked::kRows));
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(campaign.directory));
    TRY(ReplayReport report, ReplayRun(*campaign.store, run, scratch));
    const std::size_t search = SearchOf(run) - 1;
    if (search >= plans.size())
      return Error{ErrorKind::kCorrupt,
                   fmt::format("run {} is of a search that the campaign does not have", proto::RunText(run))};
    const Experiment& experiment = plans[search].experiment;
    if (report.damage.empty()) {
      TRY(CheckSeed(experiment, report.stored));
    }
    TRY(const ObservedReproducibility observed, ReadReproducibility(plans, *campaign.store));
    return CampaignReplay{experiment, std::move(report), campaign.as_of, observed.state};
  }

  Result<bool> MasterLives(const std::string& dir) override {
    TRY(const CampaignDirectory directory, CampaignDirectory::Open(dir));
    LockOptions options;
    options.patience = std::chrono::milliseconds(0);
    options.is_copy = [&directory] { return IsUntakenCopy(directory); };
    const Result<std::unique_ptr<CampaignLock>> lock =
        CampaignLock::AcquireForReading(directory.lock_path(), directory.path(), options);
    if (lock) return false;
    if (lock.error().kind == ErrorKind::kInUse) return true;
    return lock.error();
  }

  Result<std::string> ReadStatus(const std::string& dir) override {
    TRY(const bool lives, MasterLives(dir));
    TRY(const CampaignDirectory directory, CampaignDirectory::Open(dir));
    if (lives) {
      const Result<std::string> text = ReadRegularFile(directory.status_path(), 16U << 20);
      if (!text) {
        if (text.error().kind != ErrorKind::kNotFound) return text.error();
        return JsonText({{"state", "starting"},
                         {"why_nothing_runs", "the master has just started, or is about to end"},
                         {"worker_list", ordered_json::array()}});
      }
      ordered_json json = ordered_json::parse(*text, nullptr, /*allow_exceptions=*/false);
      if (!json.is_object()) {
        return Error{ErrorKind::kCorrupt, fmt::format("{} does not parse", directory.status_path())};
      }
      if (const Status right = CheckStatus(json); !right) {
        return Error{right.error().kind, fmt::format("{} is none that a master of this version writes: {}",
                                                     directory.status_path(), right.error().message)};
      }
      json["status_age_seconds"] =
          static_cast<double>(UnixMilliseconds() - json.value("unix_ms", std::int64_t{0})) / 1000.0;
      return JsonText(json);
    }
    TRY(const CampaignView campaign, ViewCampaign(dir, Checked::kTotals));
    TRY(const std::vector<SearchPlan> plans, ReadSearchPlans(campaign.directory));
    TRY(const CampaignSummary summary, SummariseTotals(plans, *campaign.store));
    return JsonText(
        {{"state", summary.finished ? "finished" : "stopped"},
         {"experiment", summary.experiment},
         {"master", nullptr},
         {"generation", summary.progress.generation},
         {"generations", summary.progress.generations},
         {"searches_in_words", summary.each.InWords()},
         {"runs_done", summary.runs_done},
         {"total_failures", summary.total_failures},
         {"runs_failed", summary.runs_failed},
         {"workers", 0},
         {"nondeterministic", summary.nondeterministic},
         {"verdicts_of_one_worker", summary.lone_verdicts},
         {"why_nothing_runs", summary.finished ? "the campaign has finished"
                              : RowOf(plans.front().experiment).streamed
                                  ? "no master serves the campaign: go on by the command that began it"
                                  : "no master serves the campaign: go on with `gauntlet resume DIR`"},
         {"worker_list", ordered_json::array()}});
  }

  Status RequestStop(const std::string& dir) override {
    TRY(const CampaignDirectory directory, CampaignDirectory::Open(dir));
    return ReplaceFile(directory.stop_path(), "stop\n", kReadableByAll);
  }
};

}  // namespace

CampaignService& CampaignsOnDisk() {
  static Campaigns campaigns;
  return campaigns;
}

}  // namespace gauntlet
