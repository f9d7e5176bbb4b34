#include "master/session/campaign_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "master/directory/campaign_ownership.h"
#include "master/dispatch/worker_program.h"
#include "master/experiment/experiment_file.h"
#include "master/report/stored_campaign.h"
#include "master/search/make_search.h"
#include "master/search/search_table.h"
#include "master/session/bind_endpoint.h"
#include "master/session/campaign_server.h"
#include "master/store/run_numbers.h"

namespace gauntlet::master {
namespace {

constexpr std::string_view kSoftwareVersion = GAUNTLET_VERSION;

// The golden hashes that the campaign was begun with. They decide whether this machine computes the bits that
// it has stored so far.
Result<proto::GoldenHashes> CheckGoldenHashes(const CampaignMeta& meta) {
  Result<proto::GoldenHashes> begun_with = proto::ReadGoldenHashes(meta.golden_hashes);
  if (!begun_with) return begun_with;
  const Result<proto::GoldenHashes> ours = GoldenHashesOfThisMachine();
  if (!ours) return ours;
  const auto difference = proto::FirstDifference(*begun_with, *ours);
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
                  meta.software_version, difference->needed, difference->controller, kSoftwareVersion,
                  *difference->offered)};
}

// Of the controllers that the searches use.
Result<proto::GoldenHashes> GoldenHashesFor(const std::vector<SearchPlan>& plans) {
  const Result<proto::GoldenHashes> ours = GoldenHashesOfThisMachine();
  if (!ours) return ours;
  proto::GoldenHashes used;
  for (const SearchPlan& plan : plans) {
    const auto hash = ours->find(plan.experiment.controller);
    if (hash == ours->end()) {
      return Error{ErrorKind::kVersion, fmt::format("gauntlet-worker was built without the controller '{}'",
                                                    plan.experiment.controller)};
    }
    used.insert(*hash);
  }
  return used;
}

struct NewCampaign {
  CampaignOwnership ownership;
  proto::GoldenHashes golden_hashes;
};

// Whether every search can begin, asked before anything is written.
Status CheckSearches(const std::vector<SearchPlan>& plans, const std::vector<sim::TestCase>& cases) {
  for (const SearchPlan& plan : plans) {
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeSearch(plan.experiment, kOnlySearch, cases);
    if (search) continue;
    if (plan.settings.empty()) return search.error();
    return Error{search.error().kind, fmt::format("{}: {}", plan.settings, search.error().message)};
  }
  return Ok{};
}

Result<NewCampaign> Create(const std::string& dir, const std::vector<SearchPlan>& plans,
                           const std::vector<sim::TestCase>& cases, const std::string& slurm) {
  if (Status possible = CheckSearches(plans, cases); !possible) return possible.error();
  Result<proto::GoldenHashes> golden_hashes = GoldenHashesFor(plans);
  if (!golden_hashes) return golden_hashes.error();
  CampaignMeta meta;
  meta.software_version = kSoftwareVersion;
  meta.golden_hashes = proto::WriteGoldenHashes(*golden_hashes);
  const Experiment& experiment = plans.front().experiment;
  std::vector<std::string> header = {
      fmt::format("Resolved experiment of this campaign; made by gauntlet {}, golden hash {:016x}.",
                  kSoftwareVersion, golden_hashes->at(experiment.controller))};
  if (plans.size() > 1) header.emplace_back("It is the first of several: searches.json has all.");
  const CampaignTexts texts{WriteExperiment(experiment, header, BuiltInCatalogue()),
                            plans.size() > 1 ? WriteSearchPlans(plans) : "", slurm};
  Result<CampaignOwnership> campaign = CreateCampaign(dir, texts, meta);
  if (!campaign) return campaign.error();
  SqliteStore& store = *campaign->store;
  if (Status added = AddSearches(plans, store); !added) return added.error();
  if (!cases.empty()) {
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeSearch(experiment, kOnlySearch, cases);
    if (!search) return search.error();
    store.AddIndividuals(kOnlySearch, (*search)->Population());
  }
  if (Status flushed = store.Flush(); !flushed) return flushed.error();
  return NewCampaign{*std::move(campaign), *std::move(golden_hashes)};
}

Result<SessionReport> Serve(CampaignOwnership& campaign, const std::vector<SearchPlan>& plans,
                            const proto::GoldenHashes& golden_hashes, const SessionOptions& options) {
  return CampaignServer(campaign, plans, {std::string(kSoftwareVersion), golden_hashes}, options).Serve();
}

}  // namespace

Result<SessionReport> StartCampaign(const std::string& dir, const Experiment& experiment,
                                    const std::vector<sim::TestCase>& cases, const SessionOptions& options) {
  const std::vector<SearchPlan> plans = {{"", experiment}};
  // Before anything is made: the corrected command is to find the directory as this one did.
  if (Status possible = TryToListen(options.bind); !possible) return possible.error();
  Result<NewCampaign> created = Create(dir, plans, cases, "");
  if (!created) return created.error();
  return Serve(created->ownership, plans, created->golden_hashes, options);
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
  const Result<proto::GoldenHashes> golden_hashes = CheckGoldenHashes(campaign->store->meta());
  if (!golden_hashes) return golden_hashes.error();

  if (Status whole = CheckAllStored(*plans, *campaign->store); !whole) return whole.error();
  const Result<std::vector<StoredSearch>> searches = campaign->store->LoadSearches();
  if (!searches) return searches.error();
  const auto finished = std::ranges::count_if(*searches, &StoredSearch::finished);
  if (static_cast<std::size_t>(finished) == plans->size()) {
    Result<CampaignSummary> summary = SummariseAll(*plans, *campaign->store);
    if (!summary) return summary.error();
    SessionReport report;
    report.summary = *std::move(summary);
    return report;
  }
  return Serve(*campaign, *plans, *golden_hashes, options);
}

}  // namespace gauntlet::master
