#include "study/tuning.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/parse_number.h"
#include "controllers/registry.h"
#include "search/experiment/experiment_file.h"
#include "search/experiment/schema.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr int kMostRepeats = 100;
constexpr std::size_t kMostSets = 10'000;
constexpr const char* kDefaultSizes = "1, 5, 10, 20, 50, 100";
// Every part has seeds of its own, so that sets are independent, and more repeats leave the first ones as
// they are.
constexpr std::uint64_t kSeedsOfAPart = 1000;
constexpr std::uint64_t kFirstAgain = 1'000'000;

std::vector<Key> AllKeys(const Experiment& experiment) {
  std::vector<Key> keys = BuiltInKeys();
  const auto add = [&](std::vector<Key> more) { std::ranges::move(more, std::back_inserter(keys)); };
  if (const auto* scenario = controllers::FindScenario(experiment)) add(ScenarioParameterKeys(*scenario));
  if (const auto* controller = controllers::FindController(experiment))
    add(ControllerParameterKeys(*controller));
  return keys;
}

// The value of a key as --set takes it.
std::string ValueOf(const Experiment& experiment, const std::string& path) {
  for (const Key& key : AllKeys(experiment)) {
    if (key.path != path) continue;
    const KeyValue value = key.get(experiment);
    const auto* text = std::get_if<std::string>(&value);
    return text != nullptr ? *text : ToToml(value);
  }
  return "";
}

class Expander {
 public:
  Expander(const StudyFileTable& table, const TuningChanges& changes, const Catalogue& catalogue)
      : table_(table), catalogue_(catalogue) {
    tuning_.experiment = changes.experiment.empty() ? table.Key("experiment") : changes.experiment;
    for (const auto& [key, value] : table.Nested("set")) sets_.push_back(fmt::format("{}={}", key, value));
    sets_.insert(sets_.end(), changes.sets.begin(), changes.sets.end());
    repeats_ = changes.repeats.empty() ? table.Key("repeats") : changes.repeats;
    repeats_place_ = changes.repeats.empty() ? table.PlaceOf("repeats") + ": repeats" : "--repeats";
  }

  Result<ExpandedTuning> Expand() {
    TRY(ReadNumbers());
    TRY(auto baseline, LoadExperiment(tuning_.experiment, sets_, catalogue_));
    const SearchRow& search = RowOf(baseline);
    if (!search.Breeds()) {
      return InvalidInput(
          fmt::format("{}: search.algorithm = \"{}\" has no population: tuning is for genetic "
                      "and steady-state searches",
                      tuning_.experiment, search.info.name));
    }
    tuning_.baseline_part = table_.name + ".baseline";
    TRY(AddParts(tuning_.baseline_part, baseline, {}));
    const auto candidates = table_.Nested("candidates");
    if (candidates.empty()) {
      return InvalidInput(fmt::format(
          "{}: [tune.{}] has no candidates: write candidates.search.population = \"10, 20\" or the like",
          table_.where, table_.name));
    }
    for (const auto& [key, values] : candidates) {
      TRY(AddParameter(baseline, key, ListItems(values)));
    }
    return ExpandedTuning{std::move(tuning_), std::move(parts_)};
  }

 private:
  Status ReadNumbers() {
    const auto repeats = ParseNumber<int>(repeats_);
    if (!repeats || *repeats < 1 || *repeats > kMostRepeats) {
      return InvalidInput(
          fmt::format("{} {}: give a whole number from 1 to {}", repeats_place_, repeats_, kMostRepeats));
    }
    tuning_.repeats = *repeats;
    for (const std::string& item : ListItems(table_.Has("sizes") ? table_.Key("sizes") : kDefaultSizes)) {
      const auto size = ParseNumber<std::size_t>(item);
      const bool ascending = size && (tuning_.sizes.empty() || *size > tuning_.sizes.back());
      if (!ascending || *size < 1 || *size > kMostSets) {
        return InvalidInput(fmt::format("{}: sizes are '{}', expected ascending whole numbers from 1 to {}",
                                        table_.PlaceOf("sizes"), table_.Key("sizes"), kMostSets));
      }
      tuning_.sizes.push_back(*size);
    }
    return Ok{};
  }

  // The evolutions of one candidate, and the part that simulates their populations again.
  Status AddParts(const std::string& name, const Experiment& experiment,
                  const std::vector<std::string>& change) {
    StudyPart evolutions;
    evolutions.name = name;
    evolutions.where = table_.where;
    evolutions.group = table_.name + ", evolutions";
    evolutions.experiment = experiment;
    const std::uint64_t first = kSeedsOfAPart * (parts_.size() / 2) + 1;
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(tuning_.repeats); ++i)
      evolutions.seeds.push_back(first + i);
    StudyPart again = evolutions;
    again.name = AgainPart(name);
    again.group = table_.name + ", populations again";
    again.kind = StudyPart::Kind::kEvaluate;
    again.from = name;
    again.seeds = {kFirstAgain + first};
    std::vector<std::string> sets = sets_;
    sets.insert(sets.end(), change.begin(), change.end());
    std::erase_if(sets, [](const std::string& set) { return set.starts_with("search."); });
    sets.emplace_back("search.algorithm=cases");
    TRY(again.experiment, LoadExperiment(tuning_.experiment, sets, catalogue_));
    again.experiment.search.replicates = 1;
    parts_.push_back(std::move(evolutions));
    parts_.push_back(std::move(again));
    return Ok{};
  }

  Status AddParameter(const Experiment& baseline, const std::string& key,
                      const std::vector<std::string>& candidates) {
    const std::string where = table_.PlaceOf("candidates." + key);
    if (key == "seed" || key == "scenario" || key == "search.algorithm" || key == "name") {
      return InvalidInput(fmt::format("{}: {} is no parameter of a search", where, key));
    }
    const SearchInfo& search = RowOf(baseline).info;
    if (key.starts_with("search.") && !Reads(search, key)) {
      // An unknown key is an error of the experiment, which says what was meant.
      const Result<Experiment> known = LoadWith(key, candidates.empty() ? "0" : candidates.front());
      if (!known) return Error{known.error().kind, fmt::format("{}: {}", where, known.error().message)};
      return InvalidInput(fmt::format("{}: the search '{}' does not read {}", where, search.name, key));
    }
    TunedParameter parameter{key, ValueOf(baseline, key), {}};
    bool has_baseline = false;
    for (const std::string& candidate : candidates) {
      const Result<Experiment> changed = LoadWith(key, candidate);
      if (!changed) return Error{changed.error().kind, fmt::format("{}: {}", where, changed.error().message)};
      const std::string value = ValueOf(*changed, key);
      if (std::ranges::count(parameter.values, value, &TunedValue::value) > 0) {
        return InvalidInput(fmt::format("{}: {} is given twice", where, candidate));
      }
      const bool is_baseline = value == parameter.baseline;
      has_baseline = has_baseline || is_baseline;
      const std::string part =
          is_baseline ? tuning_.baseline_part : fmt::format("{}.{}={}", table_.name, key, value);
      parameter.values.push_back({value, part});
      if (is_baseline) continue;
      TRY(AddParts(part, *changed, {fmt::format("{}={}", key, candidate)}));
    }
    if (!has_baseline)
      parameter.values.insert(parameter.values.begin(), {parameter.baseline, tuning_.baseline_part});
    if (parameter.values.size() < 2) {
      return InvalidInput(fmt::format("{}: {} has no candidate besides its baseline value {}", where, key,
                                      parameter.baseline));
    }
    tuning_.parameters.push_back(std::move(parameter));
    return Ok{};
  }

  Result<Experiment> LoadWith(const std::string& key, const std::string& value) const {
    std::vector<std::string> sets = sets_;
    sets.push_back(fmt::format("{}={}", key, value));
    return LoadExperiment(tuning_.experiment, sets, catalogue_);
  }

  const StudyFileTable& table_;
  const Catalogue& catalogue_;
  std::string repeats_;
  std::string repeats_place_;
  std::vector<std::string> sets_;
  Tuning tuning_;
  std::vector<StudyPart> parts_;
};

}  // namespace

std::string AgainPart(const std::string& part) {
  return part + "-again";
}

Result<ExpandedTuning> ExpandTuning(const StudyFileTable& table, const TuningChanges& changes,
                                    const Catalogue& catalogue) {
  return Expander(table, changes, catalogue).Expand();
}

}  // namespace gauntlet
