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

struct NewCampaign {
  CampaignOwnership ownership;
  std::uint64_t golden_hash = 0;
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
  return NewCampaign{*std::move(campaign), *golden_hash};
}

Result<SessionReport> Serve(CampaignOwnership& campaign, const std::vector<SearchPlan>& plans,
                            std::uint64_t golden_hash, const SessionOptions& options) {
  return CampaignServer(campaign, plans, {std::string(kSoftwareVersion), golden_hash}, options).Serve();
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
  const auto finished = std::ranges::count_if(*searches, &StoredSearch::finished);
  if (static_cast<std::size_t>(finished) == plans->size()) {
    Result<CampaignSummary> summary = SummariseAll(*plans, *campaign->store);
    if (!summary) return summary.error();
    SessionReport report;
    report.summary = *std::move(summary);
    return report;
  }
  return Serve(*campaign, *plans, *golden_hash, options);
}

}  // namespace gauntlet::master
