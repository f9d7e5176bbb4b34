#include "study/questions/questioned_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "base/hash.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "master/campaign/verdict_text.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/campaign_ownership.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "search/cases/case_file.h"
#include "search/failure_tally.h"
#include "search/search_table.h"
#include "sim/arena/validity.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

constexpr std::string_view kOfRun = "run ";  // begins the name of a run's case

// The number of the plan with the run's settings, which is added where they are its own.
std::size_t PlanOf(const sim::RunSpec& spec, std::size_t search, std::vector<SearchPlan>& plans) {
  if (!RowOf(plans.at(search).experiment).varies_settings) return search;
  const sim::RunSettings& settings = spec;
  const auto has = [&](const SearchPlan& plan) {
    const sim::RunSettings& its = plan.experiment;
    return its == settings;
  };
  const auto known = std::find_if(plans.begin() + static_cast<std::ptrdiff_t>(search), plans.end(), has);
  if (known != plans.end()) return static_cast<std::size_t>(known - plans.begin());
  plans.push_back({"", plans[search].experiment});
  static_cast<sim::RunSettings&>(plans.back().experiment) = settings;
  return plans.size() - 1;
}

Result<CaseInQuestion> CaseOfRun(ResultStore& store, RunId id, const std::string& dir,
                                 std::vector<SearchPlan>& plans) {
  TRY(const auto run, store.LoadRun(id));
  if (!run.has_value())
    return Error{ErrorKind::kNotFound, fmt::format("there is no run {} in {}", proto::RunText(id), dir)};
  TRY(auto spec, proto::DecodeRunSpec(run->spec));
  const std::size_t plan = PlanOf(spec, run->search - 1, plans);
  return CaseInQuestion{fmt::format("{}{}", kOfRun, proto::RunText(id)), plan, std::move(spec.test_case)};
}

// The first run of each individual: the one by which an elite is named, as it failed in it.
Result<std::map<IndividualId, RunId>> FirstRuns(SearchId search, ResultStore& store) {
  std::map<IndividualId, RunId> first;
  TRY(store.ForEachRow(search, 0, [&](const StoredRun& run) -> Status {
    first.emplace(run.individual, run.id);
    return Ok{};
  }));
  return first;
}

// Every different case of a subset, named by its first run in it; elites by their first run of all.
Result<QuestionedCampaign> CasesOfSubset(const std::string& dir, const std::string& subset,
                                         bool only_failing) {
  TRY(const auto opened, OpenSubset({dir, subset}));
  ResultStore& store = *opened.campaign.store;
  QuestionedCampaign questioned{opened.plans, {}};
  const auto add = [&](const SubsetSearch& search) -> Status {
    const std::string failing(FailingOf(search.plan.experiment));
    TRY(const auto runs, SelectRuns(search, store, opened.subset, failing));
    std::map<IndividualId, RunId> first;
    if (!only_failing && RowOf(search.plan.experiment).individuals == Individuals::kElites) {
      TRY(first, FirstRuns(search.plan.id, store));
    }
    std::set<IndividualId> individuals;
    std::set<std::pair<std::size_t, std::uint64_t>> cases;
    for (const SelectedRun& run : runs) {
      if ((only_failing && run.value != 1.0) || !individuals.insert(run.individual).second) continue;
      const RunId naming = first.empty() ? run.run : first.at(run.individual);
      TRY(auto one, CaseOfRun(store, naming, dir, questioned.plans));
      if (cases.insert({one.search, CaseHash(one.test_case)}).second)
        questioned.cases.push_back(std::move(one));
    }
    return Ok{};
  };
  TRY(ForEachSearch(opened.plans, store, dir, opened.subset, add));
  return questioned;
}

}  // namespace

Result<QuestionedCampaign> CasesOfRuns(const std::string& dir, const std::vector<RunId>& runs) {
  TRY(const auto campaign, ViewCampaign(dir, Checked::kRows));
  TRY(auto plans, ReadSearchPlans(campaign.directory));
  QuestionedCampaign questioned{std::move(plans), {}};
  for (const RunId id : runs) {
    TRY(auto one, CaseOfRun(*campaign.store, id, dir, questioned.plans));
    questioned.cases.push_back(std::move(one));
  }
  return questioned;
}

Result<QuestionedCampaign> FailingCases(const std::string& dir) {
  return CasesOfSubset(dir, "all", /*only_failing=*/true);
}

Result<QuestionedCampaign> PopulationCases(const std::string& dir) {
  return CasesOfSubset(dir, "final", /*only_failing=*/false);
}

Result<RunId> ParseRunId(const std::string& text) {
  if (const auto run = proto::ParseRun(text)) return *run;
  return InvalidInput(fmt::format(
      "{} is no run: RUN_ID is a whole number or SEARCH:RUN, such as 15 or 2:15, see 'gauntlet show DIR'",
      text));
}

RunId RunOfName(const std::string& name) {
  if (!name.starts_with(kOfRun)) return 0;
  return proto::ParseRun(std::string_view(name).substr(kOfRun.size())).value_or(0);
}

std::string CurrentName(const std::string& name) {
  const RunId run = RunOfName(name);
  return run == 0 ? name : fmt::format("{}{}", kOfRun, proto::RunText(run));
}

std::uint64_t KeyOfCase(const Experiment& about, const sim::TestCase& test_case) {
  Fnv1a64 hash;
  hash.AddBytes(SearchIdentity(SetupOf(about, {}, {test_case})));
  return hash.value();
}

std::optional<CaseRefusal> RefusalOf(const Experiment& experiment, const sim::TestCase& test_case) {
  if (controllers::FindScenario(experiment) == nullptr) return std::nullopt;
  const auto requirements = controllers::RequirementsOf(SpecOf(experiment, test_case, experiment.seed));
  if (!requirements) return CaseRefusal{"", requirements.error().message};
  if (const auto violation = sim::CheckValidity(test_case, *requirements))
    return CaseRefusal{std::string(sim::NameOf(violation->rule)), violation->message};
  if (const Status fits = CheckSwarmFits(experiment, test_case); !fits)
    return CaseRefusal{RuleOf(fits.error().message), fits.error().message};
  return std::nullopt;
}

Status CheckTakesFiles(const QuestionedCampaign& questioned, const std::string& dir,
                       const std::string& file) {
  const bool fit = RowOf(questioned.plans.front().experiment).varies_settings;
  if (questioned.plans.size() == 1 && !fit) return Ok{};
  const std::string what = fit ? "runs" : fmt::format("{} searches", questioned.plans.size());
  return InvalidInput(
      fmt::format("{} has {} with different settings: to which would the file {} belong? Name runs instead",
                  dir, what, file));
}

Result<QuestionedCampaign> NamedCases(const std::string& dir, const std::vector<std::string>& names) {
  if (const auto swapped = std::ranges::find_if(names, CampaignDirectory::IsCampaign);
      swapped != names.end() && !CampaignDirectory::IsCampaign(dir)) {
    return InvalidInput(fmt::format(
        "{} is a campaign and {} is none: the campaign comes first, then its runs", *swapped, dir));
  }
  std::vector<RunId> runs;
  std::vector<CaseInQuestion> files;
  for (const std::string& text : names) {
    if (std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || c == ':'; })) {
      TRY(const RunId run, ParseRunId(text));
      runs.push_back(run);
      continue;
    }
    TRY(LoadedCase loaded, LoadCase(text));
    files.push_back({std::filesystem::path(text).filename().string(), 0, std::move(loaded.test_case)});
  }
  TRY(QuestionedCampaign questioned, CasesOfRuns(dir, runs));
  if (!files.empty()) {
    TRY(CheckTakesFiles(questioned, dir, files.front().name));
  }
  for (CaseInQuestion& file : files) {
    if (const auto refusal = RefusalOf(questioned.plans.front().experiment, file.test_case))
      return InvalidInput(fmt::format("{}: {}", file.name, refusal->message));
    questioned.cases.push_back(std::move(file));
  }
  std::map<std::pair<std::size_t, std::uint64_t>, std::string> known;
  std::erase_if(questioned.cases, [&](const CaseInQuestion& one) {
    const auto [first, is_new] = known.try_emplace({one.search, CaseHash(one.test_case)}, one.name);
    if (!is_new && first->second != one.name)
      questioned.notices.push_back(fmt::format("{} has the same case as {}", one.name, first->second));
    return !is_new;
  });
  return questioned;
}

}  // namespace gauntlet
