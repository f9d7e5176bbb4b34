#include "study/sets/run_set.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "search/experiment/definition_table.h"
#include "search/search_table.h"
#include "study/sets/csv_column.h"

namespace gauntlet {
namespace {

// One evolution is one unit, as its individuals are relatives; otherwise each case is one.
Status AddUnits(const SubsetSearch& search, ResultStore& store, const std::vector<SelectedRun>& runs,
                bool evolves, RunSet& set) {
  std::map<IndividualId, std::vector<double>> units;
  std::map<IndividualId, CaseInSet> cases;
  for (const SelectedRun& run : runs) {
    if (!run.value) continue;
    units[evolves ? 0 : run.individual].push_back(*run.value);
    CaseInSet& one = cases[run.individual];
    one.mean += *run.value;
    ++one.runs;
  }
  std::size_t unit = set.values.clusters.size();
  TRY(const auto individuals, store.LoadIndividuals(search.plan.id));
  for (const Individual& individual : individuals) {
    const auto found = cases.find(individual.id);
    if (found == cases.end()) continue;
    CaseInSet& one = found->second;
    one.hash = CaseHash(individual.test_case);
    one.mean /= static_cast<double>(one.runs);
  }
  for (auto& [individual, one] : cases) {
    one.unit = evolves ? unit : unit++;
    set.cases.push_back(one);
  }
  for (auto& [individual, values] : units) set.values.clusters.push_back(std::move(values));
  return Ok{};
}

Status AddSearch(const SubsetSearch& search, ResultStore& store, const Subset& subset,
                 const std::string& metric, RunSet& set) {
  TRY(const auto runs, SelectRuns(search, store, subset, metric));
  const auto left_out = std::ranges::count_if(runs, [](const SelectedRun& run) { return !run.value; });
  if (left_out > 0) {
    set.notes.push_back(
        fmt::format("{}: {} of {} runs are left out: without a result, or without a value of {}",
                    search.place, left_out, runs.size(), metric));
  }
  const bool evolves = RowOf(search.plan.experiment).Related();
  TRY(AddUnits(search, store, runs, evolves, set));
  const std::string unit = evolves ? "evolution" : "case";
  set.unit = set.unit.empty() || set.unit == unit ? unit : "evolution or case";
  return Ok{};
}

Status AddCampaign(const SetPart& part, const std::string& metric, RunSet& set) {
  TRY(const auto opened, OpenSubset(part));
  TRY(CheckOneSetting(opened.plans, part.path, opened.campaign.store.get()));
  if (!opened.note.empty()) set.notes.push_back(opened.note);
  SqliteStore& store = *opened.campaign.store;
  TRY(auto hashes, proto::ReadGoldenHashes(store.meta().golden_hashes));
  const RunOrigin campaign{part.path, {}, store.meta().software_version, std::move(hashes)};
  return AddRuns(opened.plans, store, campaign, opened.subset, metric, set);
}

Status AddCsv(const SetPart& part, const std::string& metric, RunSet& set) {
  const std::string& name = part.rest.empty() ? metric : part.rest;
  TRY(const auto column, ReadCsvColumn(part.path, name));
  if (column.empty_cells > 0) {
    set.notes.push_back(fmt::format("{}: {} of {} rows are left out: their cell of {} is empty", part.path,
                                    column.empty_cells, column.empty_cells + column.values.size(), name));
  }
  for (const double value : column.values) set.values.clusters.push_back({value});
  set.unit = set.unit.empty() || set.unit == "row" ? "row" : set.unit + " or row";
  return Ok{};
}

// What an experiment says of its scenario, by key.
std::map<std::string, std::string> ScenarioSettings(const Experiment& experiment) {
  std::map<std::string, std::string> settings;
  for (const auto& [name, value] : experiment.scenario_parameters)
    settings.emplace("scenario_parameters." + name, fmt::format("{}", value));
  for (auto& setting : DefinitionSettings(experiment.definition)) settings.insert(std::move(setting));
  for (auto& setting : RequirementSettings(experiment.requirements)) settings.insert(std::move(setting));
  return settings;
}

}  // namespace

Status AddRuns(const std::vector<SearchPlan>& plans, ResultStore& store, const RunOrigin& campaign,
               const Subset& subset, const std::string& metric, RunSet& set) {
  return ForEachSearch(plans, store, campaign.place, subset, [&](const SubsetSearch& search) -> Status {
    TRY(AddSearch(search, store, subset, metric, set));
    if (!search.finished) {
      set.notes.push_back(search.place + " is half-finished: what it has so far is compared");
    }
    RunOrigin& origin = set.origins.emplace_back(campaign);
    origin.place = search.place;
    origin.experiment = search.plan.experiment;
    return Ok{};
  });
}

Result<RunSet> ReadRunSet(const std::string& text, const std::string& metric) {
  RunSet set;
  set.values.name = text;
  TRY(const auto parts, SplitSet(text));
  for (const SetPart& part : parts) {
    std::error_code error;
    TRY(std::filesystem::is_directory(part.path, error) ? AddCampaign(part, metric, set)
                                                        : AddCsv(part, metric, set));
  }
  return set;
}

std::vector<std::string> WhatDiffers(const RunSet& first, const RunSet& second) {
  std::vector<const RunOrigin*> origins;
  for (const RunSet* set : {&first, &second}) {
    for (const RunOrigin& origin : set->origins) origins.push_back(&origin);
  }
  std::vector<std::string> differences;
  for (const RunOrigin* origin : origins) {
    const RunOrigin& base = *origins.front();
    const auto differs = [&](const std::string& what, const std::string& of_base,
                             const std::string& of_other) {
      differences.push_back(
          fmt::format("{}: {} has {}, {} has {}", what, base.place, of_base, origin->place, of_other));
    };
    if (origin->experiment.scenario != base.experiment.scenario) {
      differs("scenario", base.experiment.scenario, origin->experiment.scenario);
      continue;
    }
    if (origin->experiment.scenario_plugin != base.experiment.scenario_plugin) {
      differs("library of the scenario " + base.experiment.scenario, base.experiment.scenario_plugin,
              origin->experiment.scenario_plugin);
      continue;
    }
    const std::map<std::string, std::string> there = ScenarioSettings(base.experiment);
    const std::map<std::string, std::string> here = ScenarioSettings(origin->experiment);
    for (const auto& [key, value] : there) {
      const auto other = here.find(key);
      if (other == here.end() || other->second != value)
        differs(key, value, other == here.end() ? "none" : other->second);
    }
    for (const auto& [key, value] : here) {
      if (!there.contains(key)) differs(key, "none", value);
    }
    for (const auto& [controller, hash] : base.golden_hashes) {
      const auto other = origin->golden_hashes.find(controller);
      if (other == origin->golden_hashes.end() || other->second == hash) continue;
      differs("golden hash of controller " + controller, fmt::format("{:016x}", hash),
              fmt::format("{:016x}", other->second));
    }
  }
  return differences;
}

}  // namespace gauntlet
