#include "master/directory/search_plans.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/system/regular_file.h"
#include "master/directory/campaign_plugins.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr int kListFormat = 1;
constexpr std::size_t kMostListBytes = std::size_t{64} << 20;

Error BadList(const std::string& path, const std::string& what) {
  return {ErrorKind::kCorrupt, fmt::format("{}: {}", path, what)};
}

}  // namespace

std::vector<SearchPlan> Numbered(std::vector<SearchPlan> plans) {
  for (std::size_t i = 0; i < plans.size(); ++i) plans[i].id = static_cast<SearchId>(i + 1);
  return plans;
}

std::string WriteSearchPlans(const std::vector<SearchPlan>& plans) {
  nlohmann::ordered_json searches = nlohmann::ordered_json::array();
  for (const SearchPlan& plan : plans)
    searches.push_back({{"settings", plan.settings},
                        {"experiment", WriteExperiment(plan.experiment, {}, BuiltInCatalogue())}});
  return nlohmann::ordered_json{{"format", kListFormat}, {"searches", std::move(searches)}}.dump(1) + "\n";
}

Result<std::vector<SearchPlan>> ReadSearchPlans(const CampaignDirectory& directory) {
  TRY(KnowPlugins(directory.plugins_path()));
  std::vector<SearchPlan> plans;
  const auto add = [&](const std::string& settings, const std::string& text,
                       const std::string& place) -> Status {
    TRY(Experiment experiment, ParseExperiment(text, place, {}, BuiltInCatalogue()));
    plans.push_back({settings, std::move(experiment)});
    return Ok{};
  };
  const std::string path = directory.searches_path();
  const Result<std::string> list = ReadRegularFile(path, kMostListBytes);
  if (!list) {
    if (list.error().kind != ErrorKind::kNotFound) return list.error();
    TRY(const std::string text, ReadRegularFile(directory.experiment_path()));
    TRY(add("", text, directory.experiment_path()));
    return Numbered(std::move(plans));
  }
  const nlohmann::json json = nlohmann::json::parse(*list, nullptr, /*allow_exceptions=*/false);
  const bool is_list = json.is_object() && json.contains("format") && json["format"] == kListFormat &&
                       json.contains("searches") && json["searches"].is_array();
  if (!is_list) return BadList(path, fmt::format("is no list of searches in format {}", kListFormat));
  for (const nlohmann::json& search : json["searches"]) {
    const auto is_text = [&](const char* key) { return search.contains(key) && search[key].is_string(); };
    if (!search.is_object() || !is_text("experiment") || !is_text("settings"))
      return BadList(path, "a search without settings or an experiment");
    TRY(add(search["settings"], search["experiment"], path));
  }
  if (plans.empty()) return BadList(path, "no searches");
  return Numbered(std::move(plans));
}

Status AddSearches(const std::vector<SearchPlan>& plans, ResultStore& store) {
  TRY(const std::vector<StoredSearch> known, store.LoadSearches());
  for (std::size_t i = known.size(); i < plans.size(); ++i) {
    const Experiment& experiment = plans[i].experiment;
    std::string name = experiment.name;
    if (!plans[i].settings.empty()) name += ": " + plans[i].settings;
    store.AddSearch({plans[i].id, name, experiment.search.algorithm, experiment.seed});
  }
  return Ok{};
}

}  // namespace gauntlet
