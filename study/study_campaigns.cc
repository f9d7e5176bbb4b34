#include "study/study_campaigns.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/trusted_path.h"
#include "controllers/registry.h"
#include "master/campaign/campaign_summary.h"
#include "master/directory/campaign_plugins.h"
#include "master/directory/search_length.h"
#include "master/store/event_kinds.h"
#include "master/store/run_numbers.h"
#include "proto/json_text.h"
#include "proto/run_codec.h"
#include "search/evolution/population_search.h"
#include "search/search_table.h"
#include "study/sets/case_set.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;

bool IsFirst(const StudyPart& part) {
  return StageOf(part) == StudyStage::kSearches;
}

// How many searches of the first stage, one for each seed.
std::size_t SearchesOf(const StudyPart& part) {
  return part.seeds.size();
}

std::string Settings(const StudyPart& part, std::uint64_t number) {
  return fmt::format("{}, seed {}", part.name, number);
}

// The experiments of a stage, by which it is recognised: of evaluations without their cases.
std::vector<SearchPlan> ExpectedPlans(const Study& study, StudyStage stage) {
  std::vector<SearchPlan> plans;
  for (const StudyPart& part : study.parts) {
    if (StageOf(part) != stage) continue;
    if (stage == StudyStage::kSearches) {
      for (const std::uint64_t seed : part.seeds) {
        plans.push_back({Settings(part, seed), part.experiment, {}});
        plans.back().experiment.seed = seed;
        if (part.kind == StudyPart::Kind::kEmpty) plans.back().cases = {EmptyArena(part.experiment.arena)};
      }
      continue;
    }
    const auto source = std::ranges::find(study.parts, part.from, &StudyPart::name);
    for (std::size_t i = 0; i < SearchesOf(*source); ++i) {
      const std::string which = part.subset.empty() ? "final" : part.subset;
      plans.push_back({fmt::format("{}, {} of {}", part.name, which, Settings(*source, source->seeds[i])),
                       part.experiment,
                       {}});
      Experiment& experiment = plans.back().experiment;
      if (RowOf(source->experiment).Related()) experiment.search.algorithm = "resimulation";
      experiment.seed = part.seeds.front() + i;
    }
  }
  return plans;
}

Result<OpenedSubset> OpenStage(const std::string& dir, StudyStage stage) {
  return OpenSubset({CampaignOf(dir, stage), "all"});
}

std::string PluginsOf(const std::string& dir) {
  return dir + "/plugins";
}

Status WriteStudy(const std::string& dir, const Study& study) {
  nlohmann::ordered_json json = {{"format", kFormat}, {"main", study.main_file}, {"files", study.texts}};
  if (const TuningChanges& changes = study.changes; changes != TuningChanges{}) {
    json["changes"] = {
        {"experiment", changes.experiment}, {"repeats", changes.repeats}, {"sets", changes.sets}};
  }
  if (!study.plugins.empty()) json["plugins"] = study.plugins;
  // The libraries first: a study whose file is there is whole.
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    TRY(KeepPlugins(PluginsOf(dir), ExpectedPlans(study, stage)));
  }
  return WriteFileAtomically(StudyFile(dir), JsonText(json), kReadableByAll);
}

}  // namespace

StudyStage StageOf(const StudyPart& part) {
  return part.kind == StudyPart::Kind::kEvaluate ? StudyStage::kEvaluations : StudyStage::kSearches;
}

std::string StudyFile(const std::string& dir) {
  return dir + "/study.json";
}

std::string CampaignOf(const std::string& dir, StudyStage stage) {
  return dir + (stage == StudyStage::kSearches ? "/searches" : "/evaluations");
}

std::string UnfinishedCampaignOf(const std::string& dir, StudyStage stage) {
  return CampaignOf(dir, stage) + ".new";
}

std::vector<std::string> CampaignsIn(const std::string& dir) {
  std::vector<std::string> campaigns;
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    std::error_code error;
    if (fs::exists(CampaignOf(dir, stage), error)) campaigns.push_back(CampaignOf(dir, stage));
  }
  return campaigns;
}

bool IsStudy(const std::string& dir) {
  std::error_code error;
  return fs::exists(StudyFile(dir), error);
}

Status BeginStudy(const std::string& dir, const Study& study) {
  std::error_code error;
  if (IsStudy(dir)) {
    TRY(const auto there, OpenStudy(dir));
    if (there.name != study.name) {
      return InvalidInput(fmt::format("{} holds the study '{}': name another --dir", dir, there.name));
    }
    for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
      TRY(LookAtStage(study, dir, stage));
    }
    // What is computed from the same runs may change.
    const bool same =
        there.texts == study.texts && there.changes == study.changes && there.plugins == study.plugins;
    return same ? Status(Ok{}) : WriteStudy(dir, study);
  }
  if (fs::exists(dir, error)) {
    if (!fs::is_directory(dir, error)) return InvalidInput(dir + " is no directory");
    for (const fs::directory_entry& entry : fs::directory_iterator(dir, error)) {
      const std::string name = entry.path().filename().string();
      // What a write that was killed has left.
      if (name.find("study.json") != std::string::npos || name == "plugins") continue;
      return InvalidInput(
          fmt::format("{} holds no study, but {}: name a directory that is new or empty", dir, name));
    }
  }
  fs::create_directories(dir, error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", dir, error.message())};
  return WriteStudy(dir, study);
}

Result<Study> OpenStudy(const std::string& dir) {
  constexpr std::string_view kFiles[] = {"study.json"};
  TRY(CheckOnlyWeWrite(dir, kFiles));
  TRY(const auto text, ReadRegularFile(StudyFile(dir)));
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  const Error damaged{ErrorKind::kCorrupt,
                      fmt::format("{} is no study in format {}", StudyFile(dir), kFormat)};
  if (!json.is_object() || json.value("format", nlohmann::json()) != kFormat || !json.contains("files") ||
      !json["files"].is_object()) {
    return damaged;
  }
  std::map<std::string, std::string> texts;
  for (const auto& [name, content] : json["files"].items()) {
    if (!content.is_string()) return damaged;
    texts[name] = content.get<std::string>();
  }
  TuningChanges changes;
  if (json.contains("changes")) {
    const nlohmann::json& changed = json["changes"];
    if (!changed.is_object()) return damaged;
    changes.experiment = TextAt(changed, "experiment");
    changes.repeats = TextAt(changed, "repeats");
    for (const nlohmann::json& set : changed.value("sets", nlohmann::json::array())) {
      if (!set.is_string()) return damaged;
      changes.sets.push_back(set.get<std::string>());
    }
  }
  TRY(KnowPlugins(PluginsOf(dir)));
  std::vector<std::string> plugins;
  for (const nlohmann::json& hash : json.value("plugins", nlohmann::json::array())) {
    if (!hash.is_string() || controllers::FindPlugin(hash.get<std::string>()) == nullptr) return damaged;
    plugins.push_back(hash.get<std::string>());
  }
  return ReadStudy(texts, TextAt(json, "main"), changes, plugins);
}

Result<std::vector<SearchPlan>> PlanSearchStage(const Study& study) {
  return ExpectedPlans(study, StudyStage::kSearches);
}

Result<std::vector<SearchPlan>> PlanEvaluationStage(const Study& study, const std::string& dir) {
  TRY(const auto searches, OpenStage(dir, StudyStage::kSearches));
  std::map<std::string, SearchId> first_of_part;
  SearchId next = 1;
  for (const StudyPart& part : study.parts) {
    if (!IsFirst(part)) continue;
    first_of_part[part.name] = next;
    next += static_cast<SearchId>(SearchesOf(part));
  }
  std::vector<SearchPlan> plans = ExpectedPlans(study, StudyStage::kEvaluations);
  std::size_t plan = 0;
  for (const StudyPart& part : study.parts) {
    if (IsFirst(part)) continue;
    const auto source = std::ranges::find(study.parts, part.from, &StudyPart::name);
    for (std::size_t i = 0; i < SearchesOf(*source); ++i, ++plan) {
      TRY(auto subset, ParseSubset(part.subset, part.where));
      subset.search = first_of_part.at(part.from) + static_cast<SearchId>(i);
      TRY(auto sets,
          CasesOf(searches.plans, *searches.campaign.store, fmt::format("part '{}'", part.name), subset));
      for (Individual& member : sets.front().members) {
        member.test_case.name =
            fmt::format("{} individual {}", Settings(*source, source->seeds[i]), member.id);
        plans[plan].cases.push_back(std::move(member.test_case));
      }
    }
  }
  return plans;
}

std::vector<SearchPlan> ForecastPlans(const Study& study, const StudyPart& part) {
  const StudyPart& source =
      IsFirst(part) ? part : *std::ranges::find(study.parts, part.from, &StudyPart::name);
  std::vector<SearchPlan> plans;
  for (const std::uint64_t seed : source.seeds) {
    SearchPlan& plan = plans.emplace_back(SearchPlan{Settings(source, seed), part.experiment, {}});
    plan.experiment.seed = seed;
    if (part.kind == StudyPart::Kind::kEmpty) plan.cases = {EmptyArena(part.experiment.arena)};
    if (IsFirst(part)) continue;
    const Result<Subset> subset = ParseSubset(part.subset, part.where);
    const SearchSpec& cases = source.experiment.search;
    double members = cases.population;
    if (source.kind == StudyPart::Kind::kRandom) members = cases.parameters.at("cases");
    if (source.kind == StudyPart::Kind::kEmpty) members = 1.0;
    if (subset && subset->count > 0) members = static_cast<double>(subset->count);
    plan.experiment.search.algorithm = "random";
    plan.experiment.search.parameters["cases"] = members;
  }
  return plans;
}

Result<StageState> LookAtStage(const Study& study, const std::string& dir, StudyStage stage) {
  const std::string campaign = CampaignOf(dir, stage);
  std::error_code error;
  if (!fs::exists(campaign, error)) return StageState{};
  TRY(const auto view, ViewCampaign(campaign, Checked::kTotals));
  TRY(const auto plans, ReadSearchPlans(view.directory));
  std::vector<SearchPlan> expected = ExpectedPlans(study, stage);
  if (expected.size() == 1) expected.front().settings.clear();
  if (!AreSameSearches(plans, expected)) {
    return InvalidInput(fmt::format(
        "{} was begun with other parts or settings than the study has now: name another --dir", campaign));
  }
  TRY(const auto totals, SummariseTotals(plans, *view.store));
  return StageState{true, totals.finished};
}

Result<StudyRuns> StudyRuns::Open(const Study& study, const std::string& dir) {
  StudyRuns runs(study);
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    TRY(auto opened, OpenStage(dir, stage));
    const CampaignMeta& meta = opened.campaign.store->meta();
    TRY(auto hashes, proto::ReadGoldenHashes(meta.golden_hashes));
    RunOrigin origin{gauntlet::CampaignOf(dir, stage), {}, meta.software_version, std::move(hashes)};
    runs.campaigns_.push_back({std::move(opened), std::move(origin)});
  }
  return runs;
}

const StudyPart& StudyRuns::Part(const std::string& name) const {
  return *std::ranges::find(study_->parts, name, &StudyPart::name);
}

StudyRuns::Range StudyRuns::RangeOf(const std::string& name) const {
  const StudyPart& wanted = Part(name);
  Range range;
  range.stage = StageOf(wanted);
  for (const StudyPart& part : study_->parts) {
    if (StageOf(part) != range.stage) continue;
    const std::size_t searches = SearchesOf(IsFirst(part) ? part : Part(part.from));
    range.end = range.first + static_cast<SearchId>(searches);
    if (&part == &wanted) break;
    range.first = range.end;
  }
  return range;
}

Result<RunSet> StudyRuns::Set(const std::string& text, const std::string& metric) {
  RunSet set;
  set.values.name = text;
  for (const StudySet& one : SplitStudySets(text)) {
    TRY(auto subset, ParseSubset(one.subset, one.part));
    const Range range = RangeOf(one.part);
    Campaign& campaign = CampaignOf(range);
    for (SearchId id = range.first; id < range.end; ++id) {
      subset.search = id;
      TRY(AddRuns(campaign.opened.plans, *campaign.opened.campaign.store, campaign.origin, subset, metric,
                  set));
    }
  }
  return set;
}

Result<std::vector<std::vector<double>>> StudyRuns::Windows(const std::string& text,
                                                            const std::string& prefix) {
  std::vector<std::vector<double>> all;
  for (const StudySet& one : SplitStudySets(text)) {
    const Range range = RangeOf(one.part);
    Campaign& campaign = CampaignOf(range);
    for (SearchId id = range.first; id < range.end; ++id) {
      TRY(campaign.opened.campaign.store->ForEachRun(id, 0, [&](const StoredRun& run) -> Status {
        const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
        if (!result) return Error{ErrorKind::kCorrupt, result.error().message};
        if (result->verdict != sim::Verdict::kCompleted) return Ok{};
        std::vector<double>& windows = all.emplace_back();
        for (const auto& [name, value] : result->metrics) {
          if (name == fmt::format("{}{}", prefix, windows.size() + 1)) windows.push_back(value);
        }
        return Ok{};
      }));
    }
  }
  if (all.empty() || all.front().empty()) {
    return InvalidInput(fmt::format("{}: no run has a metric {}1", text, prefix));
  }
  return all;
}

Result<std::vector<std::vector<std::vector<int>>>> StudyRuns::TypesByGeneration(const std::string& part) {
  std::vector<std::vector<std::vector<int>>> searches;
  const Range range = RangeOf(part);
  Campaign& campaign = CampaignOf(range);
  for (SearchId id = range.first; id < range.end; ++id) {
    std::vector<std::vector<int>>& generations = searches.emplace_back();
    TRY(campaign.opened.campaign.store->ForEachRow(id, 0, [&](const StoredRun& run) {
      if (run.generation == 0) return Ok{};
      if (generations.size() < run.generation) generations.resize(run.generation);
      if (run.total_failure && run.failure_type >= 0)
        generations[run.generation - 1].push_back(run.failure_type);
      return Ok{};
    }));
  }
  return searches;
}

std::vector<std::string> StudyRuns::FailureTypes(const std::string& set) const {
  std::vector<std::string> names;
  const Experiment& experiment = Part(SplitStudySets(set).front().part).experiment;
  const auto* scenario = controllers::FindScenario(experiment);
  if (scenario == nullptr) return names;
  for (const controllers::FailureType& type : scenario->failure_types) names.push_back(type.name);
  return names;
}

std::string StudyRuns::SourceOf(const std::string& part) const {
  return IsFirst(Part(part)) ? part : Part(part).from;
}

PartCost& PartCost::operator+=(const PartCost& other) {
  searches += other.searches;
  runs += other.runs;
  cases += other.cases;
  distinct_cases += other.distinct_cases;
  cpu_seconds += other.cpu_seconds;
  return *this;
}

Result<PartCost> StudyRuns::CostOf(const std::string& name) {
  const Range range = RangeOf(name);
  Campaign& campaign = CampaignOf(range);
  ResultStore& store = *campaign.opened.campaign.store;
  TRY(const auto totals, store.LoadTotals());
  PartCost cost;
  cost.part = name;
  cost.searches = range.end - range.first;
  for (const SearchTotals& one : totals) {
    if (one.search < range.first || one.search >= range.end) continue;
    cost.runs += one.runs;
    TRY(const auto individuals, store.LoadIndividuals(one.search));
    cost.distinct_cases += CountDistinctGenomes(individuals);
    const Experiment& experiment = campaign.opened.plans[one.search - 1].experiment;
    const bool breeds = RowOf(experiment).Breeds();
    cost.cases += breeds ? static_cast<std::uint64_t>(experiment.search.population) : individuals.size();
  }
  return cost;
}

Result<double> StudyRuns::CpuSecondsOf(const std::string& part) {
  const Range range = RangeOf(part);
  ResultStore& store = *CampaignOf(range).opened.campaign.store;
  double seconds = 0.0;
  for (SearchId id = range.first; id < range.end; ++id) {
    TRY(store.ForEachRun(id, 0, [&](const StoredRun& run) -> Status {
      TRY(const sim::RunResult result, proto::DecodeStoredResult(run.result));
      seconds += result.cpu_seconds;
      return Ok{};
    }));
  }
  return seconds;
}

Result<ClockTime> StudyRuns::TimeOf(StudyStage stage) {
  ClockTime time;
  const std::size_t index = stage == StudyStage::kSearches ? 0 : 1;
  if (index >= campaigns_.size()) return time;
  TRY(const auto events, campaigns_[index].opened.campaign.store->LoadEvents());
  // From each start of a master to its end, or to its last event where it was killed.
  std::int64_t total = 0;
  std::int64_t started = 0;
  std::int64_t last = 0;
  bool ended = true;
  for (const StoredEvent& one : events) {
    if (one.kind == event::kStart || one.kind == event::kResume) {
      total += last - started;
      started = one.unix_ms;
      time.at_least = time.at_least || !ended;
      ended = false;
    }
    ended = ended || one.kind == event::kStop || one.kind == event::kFinished;
    last = one.unix_ms;
  }
  time.seconds = static_cast<double>(total + last - started) / 1000.0;
  return time;
}

}  // namespace gauntlet
