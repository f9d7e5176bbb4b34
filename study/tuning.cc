#include "study/tuning.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "study/study_file.h"

namespace gauntlet {
namespace {

constexpr int kMostRepeats = 100;
constexpr std::size_t kMostSets = 10'000;
constexpr std::uint64_t kLargestBudget = 1'000'000'000;
constexpr const char* kDefaultSizes = "1, 5, 10, 20, 50, 100";
// Every part has seeds of its own, so that sets are independent, and more repeats leave the first ones as
// they are.
constexpr std::uint64_t kSeedsOfAPart = 1000;
constexpr std::uint64_t kFirstAgain = 1'000'000;

// The value of a key as --set takes it.
std::string ValueOf(const Experiment& experiment, const std::string& path) {
  const std::vector<Key> keys = AllKeysOf(experiment);
  const Key* key = FindByName(keys, path);
  return key == nullptr ? "" : ToSet(key->get(experiment));
}

class Expander {
 public:
  Expander(const StudyFileTable& table, const TuningChanges& changes, const Catalogue& catalogue)
      : table_(table), changes_(changes), catalogue_(catalogue) {
    tuning_.experiment = changes.experiment.empty() ? table.Key("experiment") : changes.experiment;
    tuning_.title = changes.tries.empty() ? table.Key("title") : "Parameters of the search";
    sets_ = table.Sets();
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
    TRY(AddParts(tuning_.baseline_part, sets_, table_.where));
    TRY(const auto candidates, ReadCandidates());
    for (const Candidates& one : candidates) {
      TRY(AddParameter(baseline, one));
    }
    return ExpandedTuning{std::move(tuning_), std::move(parts_)};
  }

 private:
  struct Candidates {
    std::string key;
    std::vector<std::string> values;
    std::string where;
  };

  // Those that were typed, else those of the table.
  Result<std::vector<Candidates>> ReadCandidates() const {
    std::vector<Candidates> candidates;
    for (const std::string& text : changes_.tries) {
      const std::size_t equals = text.find('=');
      const std::string where = "--try " + text;
      const std::string key = text.substr(0, equals);
      const std::string values = equals == std::string::npos ? "" : text.substr(equals + 1);
      if (key.empty() || ListItems(values).empty())
        return InvalidInput(where + ": give a key and the values to try, key=a,b,c");
      if (std::ranges::count(candidates, key, &Candidates::key) > 0)
        return InvalidInput(fmt::format("{}: {} is tried already; give all its values at once", where, key));
      candidates.push_back({key, ListItems(values), where});
    }
    if (!candidates.empty()) return candidates;
    for (const auto& [key, values] : table_.Nested("candidates"))
      candidates.push_back({key, ListItems(values), table_.PlaceOf("candidates." + key)});
    if (candidates.empty()) {
      return InvalidInput(fmt::format(
          "{}: [tune.{}] has no candidates: write candidates.search.population = \"10, 20\" or the like",
          table_.where, table_.name));
    }
    return candidates;
  }

  Status ReadNumbers() {
    const auto repeats = ParseNumber<int>(repeats_);
    if (!repeats || *repeats < 1 || *repeats > kMostRepeats) {
      return InvalidInput(
          fmt::format("{} {}: give a whole number from 1 to {}", repeats_place_, repeats_, kMostRepeats));
    }
    tuning_.repeats = *repeats;
    if (!changes_.budget.empty()) {
      const auto budget = ParseNumber<std::uint64_t>(changes_.budget);
      if (!budget || *budget < 1 || *budget > kLargestBudget) {
        return InvalidInput(
            fmt::format("--budget {}: give the runs of each evolution, a whole number from 1 to {}",
                        changes_.budget, kLargestBudget));
      }
      tuning_.budget = *budget;
    }
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

  // The most generations of such an evolution that the budget pays for, as --set takes them.
  Result<std::string> GenerationsOfBudget(const std::vector<std::string>& sets,
                                          const std::string& where) const {
    const auto runs_of = [&](std::uint64_t generations) -> Result<std::uint64_t> {
      std::vector<std::string> all = sets;
      all.push_back(fmt::format("search.generations={}", generations));
      TRY(const Experiment experiment, LoadExperiment(tuning_.experiment, all, catalogue_));
      TRY(const auto search, MakeSearch(experiment));
      return search->Progress().evaluations_planned *
             static_cast<std::uint64_t>(experiment.search.replicates);
    };
    // Every generation after the first costs the same.
    TRY(const std::uint64_t first, runs_of(1));
    TRY(const std::uint64_t second, runs_of(2));
    if (tuning_.budget < first) {
      return InvalidInput(
          fmt::format("{}: --budget {} does not pay for the first generation, which takes {} runs", where,
                      tuning_.budget, first));
    }
    return fmt::format("search.generations={}", 1 + (tuning_.budget - first) / (second - first));
  }

  // The evolutions of one candidate, and the part that simulates their populations again.
  Status AddParts(const std::string& name, std::vector<std::string> sets, const std::string& where) {
    if (tuning_.budget > 0) {
      TRY(sets.emplace_back(), GenerationsOfBudget(sets, where));
    }
    const std::uint64_t first = kSeedsOfAPart * (parts_.size() / 2) + 1;
    const auto add = [&](const std::string& part, const std::string& group,
                         const std::vector<std::pair<std::string, std::string>>& keys) -> StudyFileTable& {
      StudyFileTable& table = parts_.emplace_back(StudyFileTable{"part", part, table_.where, {}});
      table.entries.push_back({"group", fmt::format("{}, {}", table_.name, group), table_.where});
      for (const auto& [key, value] : keys) table.entries.push_back({key, value, table_.where});
      return table;
    };
    const std::string seeds = fmt::format("{}..{}", first, first + tuning_.repeats - 1);
    StudyFileTable& evolutions =
        add(name, "evolutions", {{"kind", "evolve"}, {"experiment", tuning_.experiment}, {"seeds", seeds}});
    for (const std::string& set : sets) {
      const std::size_t equals = set.find('=');
      evolutions.entries.push_back({"set." + set.substr(0, equals), set.substr(equals + 1), table_.where});
    }
    add(AgainPart(name), "populations again",
        {{"kind", "evaluate"},
         {"from", name},
         {"seeds", fmt::format("{}", kFirstAgain + first)},
         {"replicates", "1"}});
    return Ok{};
  }

  Status AddParameter(const Experiment& baseline, const Candidates& tried) {
    const auto& [key, candidates, where] = tried;
    if (key == "seed" || key == "scenario" || key == "search.algorithm" || key == "name") {
      return InvalidInput(fmt::format("{}: {} is no parameter of a search", where, key));
    }
    if (tuning_.budget > 0 && key == "search.generations")
      return InvalidInput(where + ": with --budget the number of generations follows from the runs");
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
      TRY(AddParts(part, SetsWith(key, candidate), where));
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

  std::vector<std::string> SetsWith(const std::string& key, const std::string& value) const {
    std::vector<std::string> sets = sets_;
    sets.push_back(fmt::format("{}={}", key, value));
    return sets;
  }

  Result<Experiment> LoadWith(const std::string& key, const std::string& value) const {
    return LoadExperiment(tuning_.experiment, SetsWith(key, value), catalogue_);
  }

  const StudyFileTable& table_;
  const TuningChanges& changes_;
  const Catalogue& catalogue_;
  std::string repeats_;
  std::string repeats_place_;
  std::vector<std::string> sets_;
  Tuning tuning_;
  std::vector<StudyFileTable> parts_;
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
