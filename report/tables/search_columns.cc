#include "report/tables/search_columns.h"

#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "search/experiment/schema.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

Value CellOf(const KeyValue& value) {
  return std::visit([](const auto& one) { return Value(one); }, value);
}

// A key, and its value in each search; none where the search does not have it.
struct Setting {
  Key key;
  std::vector<Value> values;

  // Searches that have the key differ in it.
  bool Varies() const {
    const Value* first = nullptr;
    for (const Value& value : values) {
      if (std::holds_alternative<std::monostate>(value)) continue;
      if (first == nullptr) first = &value;
      if (value != *first) return true;
    }
    return false;
  }
};

std::vector<Setting> SettingsOf(const std::vector<SearchPlan>& plans) {
  std::vector<Setting> settings;
  std::map<std::string, std::size_t> places;
  for (std::size_t search = 0; search < plans.size(); ++search) {
    for (Key& key : AllKeysOf(plans[search].experiment)) {
      if (key.for_people || key.type == KeyType::kSeed) continue;
      const auto [place, is_new] = places.emplace(key.path, settings.size());
      const Value value = CellOf(key.get(plans[search].experiment));
      if (is_new) settings.push_back({std::move(key), std::vector<Value>(plans.size())});
      settings[place->second].values[search] = value;
    }
  }
  return settings;
}

}  // namespace

std::vector<DataColumn> CommonSearchColumns() {
  return {{"search", "", "number of the search in the campaign, from 1"},
          {"search_name", "",
           "the search's name: what differs from the others, or the experiment's name if there is one search "
           "only"},
          {"search_seed", "", "the search's seed, 64 bits"}};
}

SearchColumns::SearchColumns(const std::vector<SearchPlan>& plans)
    : columns_(CommonSearchColumns()), cells_(plans.size()) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SearchPlan& plan = plans[i];
    cells_[i] = {std::uint64_t{i + 1}, plan.settings.empty() ? plan.experiment.name : plan.settings,
                 fmt::format("{}", plan.experiment.seed)};
  }
  if (plans.size() == 1) return;
  for (Setting& setting : SettingsOf(plans)) {
    if (!setting.Varies()) continue;
    columns_.push_back({setting.key.path, setting.key.unit, setting.key.description});
    for (std::size_t i = 0; i < plans.size(); ++i) cells_[i].push_back(std::move(setting.values[i]));
  }
}

}  // namespace gauntlet
