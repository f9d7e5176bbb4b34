#include "cli/options/sweep.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/split.h"
#include "controllers/run_start.h"
#include "search/experiment/definition_table.h"
#include "search/experiment/schema.h"
#include "search/experiment/seed_list.h"
#include "search/search_setup.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostSearches = 1000;

struct Sweep {
  std::string key;
  std::vector<std::string> values;
};

// "a,b,c"; none of them may be empty.
std::optional<std::vector<std::string>> SplitList(std::string_view text) {
  std::vector<std::string> items = Split(text, ',');
  if (std::ranges::count(items, "") > 0) return std::nullopt;
  return items;
}

// The first that stands in the list twice: its searches would be the same.
template <typename Value>
std::optional<Value> FirstRepeated(const std::vector<Value>& values) {
  std::set<Value> seen;
  for (const Value& value : values) {
    if (!seen.insert(value).second) return value;
  }
  return std::nullopt;
}

Result<Sweep> ParseSweep(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string_view view = text;
  const auto values = equals == std::string::npos ? std::nullopt : SplitList(view.substr(equals + 1));
  if (!values || equals == 0)
    return InvalidInput(
        fmt::format("--sweep {}: give a key and its values, key=a,b,c; an empty text is written \"\"", text));
  const std::string key = text.substr(0, equals);
  if (key == "seed") return InvalidInput(fmt::format("--sweep {}: seeds are given with --seeds", text));
  if (const auto twice = FirstRepeated(*values))
    return InvalidInput(fmt::format("--sweep {}: {} is given twice", text, *twice));
  return Sweep{key, *values};
}

Result<std::vector<Sweep>> ParseSweeps(const std::vector<std::string>& texts) {
  std::vector<Sweep> sweeps;
  for (const std::string& text : texts) {
    TRY(Sweep sweep, ParseSweep(text));
    if (std::ranges::count(sweeps, sweep.key, &Sweep::key) > 0)
      return InvalidInput(
          fmt::format("--sweep {}: {} is swept already; give all its values at once", text, sweep.key));
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

// None when `text` is "".
Result<std::vector<std::uint64_t>> ParseSeeds(const std::string& text) {
  if (text.empty()) return std::vector<std::uint64_t>();
  const auto seeds = ParseSeedList(text, kMostSearches);
  if (!seeds)
    return InvalidInput(
        fmt::format("--seeds {}: give a range (1..20) or a list (1,5,9) of at most {} whole numbers", text,
                    kMostSearches));
  if (const auto twice = FirstRepeated(*seeds))
    return InvalidInput(fmt::format("--seeds {}: {} is given twice", text, *twice));
  return *seeds;
}

Status CheckNumber(const std::vector<Sweep>& sweeps, const std::vector<std::uint64_t>& seeds) {
  std::size_t searches = std::max<std::size_t>(seeds.size(), 1);
  for (const Sweep& sweep : sweeps) {
    searches *= sweep.values.size();
    if (searches > kMostSearches)
      return InvalidInput(fmt::format("--sweep and --seeds ask for more than {} searches", kMostSearches));
  }
  return Ok{};
}

// All combinations, the last sweep varying fastest.
std::vector<std::vector<ExtraSet>> Combinations(const std::vector<Sweep>& sweeps) {
  std::vector<std::vector<ExtraSet>> combinations = {{}};
  for (const Sweep& sweep : sweeps) {
    std::vector<std::vector<ExtraSet>> longer;
    for (const std::vector<ExtraSet>& combination : combinations) {
      for (const std::string& value : sweep.values) {
        longer.push_back(combination);
        longer.back().push_back({fmt::format("--sweep {}=", sweep.key), sweep.key, value});
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

std::vector<SearchPlan> WithSeeds(const SearchPlan& plan, const std::vector<std::uint64_t>& seeds) {
  if (seeds.empty()) return {plan};
  std::vector<SearchPlan> plans;
  for (const std::uint64_t seed : seeds) {
    SearchPlan& one = plans.emplace_back(plan);
    one.settings += fmt::format("{}seed {}", plan.settings.empty() ? "" : ", ", seed);
    one.experiment.seed = seed;
  }
  return plans;
}

// What was given on the command line for another search than these.
Status CheckSettings(const std::vector<ExtraSet>& settings, const std::vector<SearchPlan>& plans) {
  const auto read = [&](const std::string& key) {
    return std::ranges::any_of(
        plans, [&](const SearchPlan& plan) { return Reads(RowOf(plan.experiment).info, key); });
  };
  const SearchInfo& search = RowOf(plans.front().experiment).info;
  for (const auto& [option, key, value] : settings) {
    if (!key.starts_with("search.") || key == "search.algorithm" || read(key)) continue;
    std::string known;
    for (const Key& one : BuiltInKeys()) {
      if (!one.path.starts_with("search.") || !Reads(search, one.path)) continue;
      known += (known.empty() ? "" : ", ") + one.path;
      for (const SearchRow& row : Searches()) {
        if (row.info.length != one.path || row.length_option.empty()) continue;
        known += fmt::format(" ({} {} N)", row.command, row.length_option);
      }
    }
    return InvalidInput(fmt::format("{} {}: the search '{}' does not read {}; it reads {}", option, value,
                                    search.name, key, known));
  }
  return Ok{};
}

// Given cases are simulated as these settings say, and all others would only repeat the runs.
Status CheckDifferent(const std::vector<SearchPlan>& plans) {
  const auto settings_of = [](const SearchPlan& plan) {
    sim::RunSettings settings = plan.experiment;
    sim::RandomFaults& random = settings.disturbances.random_faults;
    if (random.count == 0) random = {};
    return settings;
  };
  const auto same = [&](const SearchPlan& one, const SearchPlan& other) {
    return one.experiment.seed == other.experiment.seed &&
           one.experiment.search.replicates == other.experiment.search.replicates &&
           settings_of(one) == settings_of(other);
  };
  for (std::size_t i = 1; i < plans.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!same(plans[j], plans[i])) continue;
      return InvalidInput(fmt::format(
          "'{}' and '{}' would be the same runs of the given cases: sweep what runs depend on, such as "
          "parameters, physics, noise and faults",
          plans[j].settings, plans[i].settings));
    }
  }
  return Ok{};
}

}  // namespace

Result<std::vector<SearchPlan>> PlanSearches(const ExperimentOptions& options,
                                             const std::vector<ExtraSet>& extra, const SweepOptions& sweep) {
  if (!sweep.seeds.empty() && !options.seed.empty())
    return InvalidInput(fmt::format("--seed {} and --seeds {}: give one of them", options.seed, sweep.seeds));
  TRY(const std::vector<Sweep> sweeps, ParseSweeps(sweep.sweeps));
  TRY(const std::vector<std::uint64_t> seeds, ParseSeeds(sweep.seeds));
  TRY(CheckNumber(sweeps, seeds));

  const bool chosen = std::ranges::count(extra, "search.algorithm", &ExtraSet::key) > 0;
  std::vector<SearchPlan> plans;
  for (const std::vector<ExtraSet>& combination : Combinations(sweeps)) {
    std::vector<ExtraSet> all = extra;
    SearchPlan plan;
    for (const ExtraSet& set : combination) {
      plan.settings += fmt::format("{}{}={}", plan.settings.empty() ? "" : ", ", set.key, set.value);
      all.push_back(set);
    }
    TRY(const Experiment experiment, LoadExperimentWith(options, all));
    if (!chosen && RowOf(experiment).given_cases())
      return InvalidInput(fmt::format("search.algorithm = {} needs a list of cases: use '{}'",
                                      experiment.search.algorithm, RowOf(experiment).command));
    if (!chosen && RowOf(experiment).streamed)
      return InvalidInput("search.algorithm = stream gets its cases line by line: use 'evaluate --stdin'");
    plan.experiment = experiment;
    // A seed that was drawn (--seed random) is that of them all.
    if (!plans.empty() && seeds.empty()) plan.experiment.seed = plans.front().experiment.seed;
    std::ranges::move(WithSeeds(plan, seeds), std::back_inserter(plans));
  }
  if (plans.size() > 1 && RowOf(plans.front().experiment).varies_settings)
    return InvalidInput("a campaign holds one fit: start one for each seed or setting");

  std::vector<ExtraSet> settings = extra;
  for (const std::string& set : options.sets)
    settings.push_back({"--set", set.substr(0, set.find('=')), set});
  for (const Sweep& one : sweeps)
    settings.push_back({"--sweep", one.key, fmt::format("{}={}", one.key, fmt::join(one.values, ","))});
  const bool given = RowOf(plans.front().experiment).given_cases();
  // A single experiment may say how something else is searched: given cases are simulated all the same.
  if (!given || plans.size() > 1) {
    TRY(CheckSettings(settings, plans));
  }
  if (given) {
    TRY(CheckDifferent(plans));
  }
  if (plans.size() == 1) plans.front().settings.clear();
  return plans;
}

void TellOfIdleSettings(CommandContext& context, const std::vector<SearchPlan>& searches) {
  std::map<std::string, bool> idle;  // by device
  for (const SearchPlan& plan : searches) {
    const Experiment& experiment = plan.experiment;
    // The devices of a plug-in's controller are known to its own process alone.
    if (experiment.disturbances.noise.empty() || !experiment.plugin.empty() || StartsProgram(experiment))
      continue;
    const auto start =
        controllers::StartOf(SpecOf(experiment, EmptyArena(experiment.arena), experiment.seed));
    if (!start) continue;
    for (const auto& [device, noise] : experiment.disturbances.noise) {
      const bool has = std::ranges::any_of(start->robots, [device = device](const sim::StartingRobot& robot) {
        return robot.devices.Has(device);
      });
      bool& still = idle.try_emplace(sim::KeyOf(device), true).first->second;
      still = still && !has;
    }
  }
  for (const auto& [device, still] : idle) {
    if (still)
      PrintMessage(context, fmt::format("noise.{0} changes nothing: no robot of {1} has the device {0}",
                                        device, searches.front().experiment.scenario));
  }
  std::set<std::string> cut;
  for (const SearchPlan& plan : searches)
    std::ranges::copy(WindowsBeyondTheRun(plan.experiment), std::inserter(cut, cut.end()));
  for (const std::string& window : cut) PrintMessage(context, window);
}

}  // namespace gauntlet
