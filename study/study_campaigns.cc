#include "study/study_campaigns.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/nearest_name.h"
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

constexpr StudyStage kStages[] = {StudyStage::kSearches, StudyStage::kEvaluations};

// Whose cases a part is about: its own, or those that it evaluates.
const StudyPart& SourceOf(const Study& study, const StudyPart& part) {
  return part.from.empty() ? part : *FindByName(study.parts, part.from);
}

// One of the searches of a part.
struct StudySearch {
  const StudyPart& part;
  const StudyPart& source;
  std::size_t number;  // from 0, of those of the source, of which there is one for each seed

  bool Evaluates() const { return &part != &source; }
  std::string SourceInWords() const { return fmt::format("{}, seed {}", source.name, source.seeds[number]); }
};

// Those of a stage, in the order of their ids.
std::vector<StudySearch> SearchesOf(const Study& study, StudyStage stage) {
  std::vector<StudySearch> searches;
  for (const StudyPart& part : study.parts) {
    if (StageOf(part) != stage) continue;
    const StudyPart& source = SourceOf(study, part);
    for (std::size_t i = 0; i < source.seeds.size(); ++i) searches.push_back({part, source, i});
  }
  return searches;
}

// What a search is recognised by: of an evaluation without its cases.
SearchPlan PlanOf(const StudySearch& search) {
  const auto& [part, source, number] = search;
  SearchPlan plan;
  plan.settings = search.SourceInWords();
  plan.experiment = part.experiment;
  plan.experiment.seed = source.seeds[number];
  if (part.kind == StudyPart::Kind::kEmpty) plan.cases = {EmptyArena(part.experiment.arena)};
  if (!search.Evaluates()) return plan;
  plan.settings =
      fmt::format("{}, {} of {}", part.name, part.subset.empty() ? "final" : part.subset, plan.settings);
  plan.experiment.seed = part.seeds.front() + number;
  if (RowOf(source.experiment).Related()) plan.experiment.search.algorithm = "resimulation";
  return plan;
}

std::vector<SearchPlan> PlansOf(const Study& study, StudyStage stage) {
  std::vector<SearchPlan> plans;
  for (const StudySearch& search : SearchesOf(study, stage)) plans.push_back(PlanOf(search));
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
    if (!changes.tries.empty()) json["changes"]["tries"] = changes.tries;
    if (!changes.budget.empty()) json["changes"]["budget"] = changes.budget;
  }
  if (!study.plugins.empty()) json["plugins"] = study.plugins;
  // The libraries first: a study whose file is there is whole.
  for (const StudyStage stage : kStages) {
    TRY(KeepPlugins(PluginsOf(dir), PlansOf(study, stage)));
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
  for (const StudyStage stage : kStages) {
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
    for (const StudyStage stage : kStages) {
      TRY(LookAtStage(study, dir, stage));
    }
    // What is computed from the same runs may change.
    const bool same =
        there.texts == study.texts && there.changes == study.changes && there.plugins == study.plugins;
    return same ? Status(Ok{}) : WriteStudy(dir, study);
  }
  if (fs::exists(dir, error)) {
    if (!fs::is_directory(dir, error)) return InvalidInput(dir + " is no directory");
    TRY(CheckOnlyWeWrite(dir));
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
    changes.budget = TextAt(changed, "budget");
    for (const auto& [name, texts_of] : {std::pair{"sets", &changes.sets}, {"tries", &changes.tries}}) {
      for (const nlohmann::json& one : changed.value(name, nlohmann::json::array())) {
        if (!one.is_string()) return damaged;
        texts_of->push_back(one.get<std::string>());
      }
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

Result<std::vector<SearchPlan>> PlanStage(const Study& study, const std::string& dir, StudyStage stage) {
  std::vector<SearchPlan> plans = PlansOf(study, stage);
  if (stage == StudyStage::kSearches) return plans;
  TRY(const auto opened, OpenStage(dir, StudyStage::kSearches));
  const std::vector<StudySearch> firsts = SearchesOf(study, StudyStage::kSearches);
  auto plan = plans.begin();
  for (const StudySearch& search : SearchesOf(study, stage)) {
    const auto source = std::ranges::find_if(firsts, [&](const StudySearch& one) {
      return &one.source == &search.source && one.number == search.number;
    });
    TRY(auto subset, ParseSubset(search.part.subset, search.part.where));
    subset.search = static_cast<SearchId>(source - firsts.begin() + 1);
    TRY(auto sets,
        CasesOf(opened.plans, *opened.campaign.store, fmt::format("part '{}'", search.part.name), subset));
    for (Individual& member : sets.front().members) {
      member.test_case.name = fmt::format("{} individual {}", search.SourceInWords(), member.id);
      plan->cases.push_back(std::move(member.test_case));
    }
    if (plan->cases.empty()) {
      return InvalidInput(
          fmt::format("part '{}': {} ended without such cases, so there is nothing to simulate again; "
                      "'worst:N' and 'all' "
                      "take its runs instead",
                      search.part.name, search.SourceInWords()));
    }
    ++plan;
  }
  return plans;
}

std::vector<SearchPlan> ForecastPlans(const Study& study, const StudyPart& part) {
  std::vector<SearchPlan> plans;
  for (const StudySearch& search : SearchesOf(study, StageOf(part))) {
    if (&search.part != &part) continue;
    SearchPlan& plan = plans.emplace_back(PlanOf(search));
    if (!search.Evaluates()) continue;
    const Result<Subset> subset = ParseSubset(part.subset, part.where);
    const SearchSpec& cases = search.source.experiment.search;
    double members = cases.population;
    if (search.source.kind == StudyPart::Kind::kRandom) members = cases.parameters.at("cases");
    if (search.source.kind == StudyPart::Kind::kEmpty) members = 1.0;
    if (subset && subset->count > 0) members = static_cast<double>(subset->count);
    plan.experiment.seed = search.source.seeds[search.number];
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
  std::vector<SearchPlan> expected = PlansOf(study, stage);
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
  for (const StudyStage stage : kStages) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    TRY(auto opened, OpenStage(dir, stage));
    const CampaignMeta& meta = opened.campaign.store->meta();
    TRY(auto hashes, proto::ReadGoldenHashes(meta.golden_hashes));
    RunOrigin origin{CampaignOf(dir, stage), {}, meta.software_version, std::move(hashes)};
    runs.campaigns_.push_back({std::move(opened), std::move(origin)});
  }
  return runs;
}

const StudyPart& StudyRuns::Part(const std::string& name) const {
  return *FindByName(study_->parts, name);
}

Status StudyRuns::ForEachSearch(const std::string& part,
                                const std::function<Status(Campaign&, SearchId)>& visit) {
  const StudyStage stage = StageOf(Part(part));
  SearchId id = 0;
  for (const StudySearch& search : SearchesOf(*study_, stage)) {
    ++id;
    if (search.part.name != part) continue;
    TRY(visit(campaigns_.at(static_cast<std::size_t>(stage)), id));
  }
  return Ok{};
}

Result<RunSet> StudyRuns::Set(const std::string& text, const std::string& metric) {
  RunSet set;
  set.values.name = text;
  for (const StudySet& one : SplitStudySets(text)) {
    TRY(auto subset, ParseSubset(one.subset, one.part));
    TRY(ForEachSearch(one.part, [&](Campaign& campaign, SearchId id) {
      subset.search = id;
      return AddRuns(campaign.opened.plans, *campaign.opened.campaign.store, campaign.origin, subset, metric,
                     set);
    }));
  }
  return set;
}

Result<std::vector<std::vector<double>>> StudyRuns::Windows(const std::string& text,
                                                            const std::string& prefix) {
  std::vector<std::vector<double>> all;
  for (const StudySet& one : SplitStudySets(text)) {
    TRY(ForEachResult(one.part, [&](const sim::RunResult& result) {
      if (result.verdict != sim::Verdict::kCompleted) return;
      std::vector<double>& windows = all.emplace_back();
      for (const auto& [name, value] : result.metrics) {
        if (name == fmt::format("{}{}", prefix, windows.size() + 1)) windows.push_back(value);
      }
    }));
  }
  if (all.empty() || all.front().empty()) {
    return InvalidInput(fmt::format("{}: no run has a metric {}1", text, prefix));
  }
  return all;
}

Status StudyRuns::ForEachResult(const std::string& part,
                                const std::function<void(const sim::RunResult&)>& visit) {
  return ForEachSearch(part, [&](Campaign& campaign, SearchId id) {
    return campaign.opened.campaign.store->ForEachRun(id, 0, [&](const StoredRun& run) -> Status {
      TRY(const sim::RunResult result, proto::DecodeStoredResult(run.result));
      visit(result);
      return Ok{};
    });
  });
}

Result<std::vector<std::vector<SelectedRun>>> StudyRuns::All(const std::string& part,
                                                             const std::string& metric) {
  std::vector<std::vector<SelectedRun>> searches;
  TRY(ForEachSearch(part, [&](Campaign& campaign, SearchId id) -> Status {
    const SubsetSearch search{campaign.opened.plans[id - 1], part, /*finished=*/true};
    TRY(searches.emplace_back(),
        SelectRuns(search, *campaign.opened.campaign.store, {Subset::Kind::kAll}, metric));
    return Ok{};
  }));
  return searches;
}

std::vector<std::string> StudyRuns::FailureTypes(const std::string& set) const {
  std::vector<std::string> names;
  const Experiment& experiment = Part(SplitStudySets(set).front().part).experiment;
  for (const controllers::FailureType& type : controllers::DeclaredScenario(experiment).failure_types.types)
    names.push_back(type.name);
  return names;
}

std::string StudyRuns::SourceOf(const std::string& part) const {
  return gauntlet::SourceOf(*study_, Part(part)).name;
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
  PartCost cost;
  cost.part = name;
  TRY(ForEachSearch(name, [&](Campaign& campaign, SearchId id) -> Status {
    ResultStore& store = *campaign.opened.campaign.store;
    TRY(const auto totals, store.LoadTotals());
    TRY(const auto individuals, store.LoadIndividuals(id));
    const auto one = std::ranges::find(totals, id, &SearchTotals::search);
    const Experiment& experiment = campaign.opened.plans[id - 1].experiment;
    const bool breeds = RowOf(experiment).Breeds();
    ++cost.searches;
    cost.runs += one == totals.end() ? 0 : one->runs;
    cost.distinct_cases += CountDistinctGenomes(individuals);
    cost.cases += breeds ? static_cast<std::uint64_t>(experiment.search.population) : individuals.size();
    return Ok{};
  }));
  return cost;
}

Result<double> StudyRuns::CpuSecondsOf(const std::string& part) {
  double seconds = 0.0;
  TRY(ForEachResult(part, [&](const sim::RunResult& result) { seconds += result.cpu_seconds; }));
  return seconds;
}

Result<ClockTime> StudyRuns::TimeOf(StudyStage stage) {
  ClockTime time;
  const auto index = static_cast<std::size_t>(stage);
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
