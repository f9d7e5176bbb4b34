#include "master/cli/sweep.h"

#include <algorithm>
#include <optional>
#include <ranges>

#include <fmt/format.h>

#include "base/parse_number.h"

namespace gauntlet::master {
namespace {

constexpr std::size_t kMostSearches = 1000;

struct Sweep {
  std::string key;
  std::vector<std::string> values;
};

// "a,b,c"; none of them may be empty.
std::optional<std::vector<std::string>> SplitList(std::string_view text) {
  std::vector<std::string> items;
  for (const auto item : std::views::split(text, ',')) items.emplace_back(item.begin(), item.end());
  if (items.empty() || std::ranges::count(items, "") > 0) return std::nullopt;
  return items;
}

Result<Sweep> ParseSweep(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string_view view = text;
  const auto values = equals == std::string::npos ? std::nullopt : SplitList(view.substr(equals + 1));
  if (!values || equals == 0)
    return InvalidInput(fmt::format("--sweep {}: give a key and its values, key=a,b,c", text));
  const std::string key = text.substr(0, equals);
  if (key == "seed") return InvalidInput(fmt::format("--sweep {}: seeds are given with --seeds", text));
  return Sweep{key, *values};
}

// "1..20" or "1,5,9".
std::optional<std::vector<std::uint64_t>> SeedsOf(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  if (const std::size_t dots = text.find(".."); dots != std::string::npos) {
    const auto first = ParseNumber<std::uint64_t>(text.substr(0, dots));
    const auto last = ParseNumber<std::uint64_t>(text.substr(dots + 2));
    if (!first || !last || *first > *last || *last - *first >= kMostSearches) return std::nullopt;
    for (std::uint64_t i = 0; i <= *last - *first; ++i) seeds.push_back(*first + i);
    return seeds;
  }
  const auto items = SplitList(text);
  if (!items || items->size() > kMostSearches) return std::nullopt;
  for (const std::string& item : *items) {
    const auto seed = ParseNumber<std::uint64_t>(item);
    if (!seed) return std::nullopt;
    seeds.push_back(*seed);
  }
  return seeds;
}

// All combinations, the last sweep varying fastest.
std::vector<std::vector<ExtraSet>> Combinations(const std::vector<Sweep>& sweeps) {
  std::vector<std::vector<ExtraSet>> combinations = {{}};
  for (const Sweep& sweep : sweeps) {
    std::vector<std::vector<ExtraSet>> longer;
    for (const std::vector<ExtraSet>& combination : combinations) {
      for (const std::string& value : sweep.values) {
        longer.push_back(combination);
        longer.back().push_back({"--sweep " + sweep.key, sweep.key, value});
      }
    }
    combinations = std::move(longer);
  }
  return combinations;
}

}  // namespace

Result<std::vector<SearchPlan>> PlanSearches(const ExperimentOptions& options, const SizeOptions& size,
                                             const std::vector<std::string>& sweeps,
                                             const std::string& seeds) {
  if (!seeds.empty() && !options.seed.empty())
    return InvalidInput(fmt::format("--seed {} and --seeds {}: give one of them", options.seed, seeds));
  std::vector<Sweep> parsed;
  std::size_t searches = 1;
  for (const std::string& text : sweeps) {
    Result<Sweep> sweep = ParseSweep(text);
    if (!sweep) return sweep.error();
    searches *= sweep->values.size();
    parsed.push_back(*std::move(sweep));
    if (searches > kMostSearches) break;
  }
  std::vector<std::uint64_t> numbers;
  if (!seeds.empty()) {
    const auto given = SeedsOf(seeds);
    if (!given)
      return InvalidInput(
          fmt::format("--seeds {}: give a range (1..20) or a list (1,5,9) of at most {} whole numbers", seeds,
                      kMostSearches));
    numbers = *given;
    searches *= numbers.size();
  }
  if (searches > kMostSearches)
    return InvalidInput(fmt::format("--sweep and --seeds ask for more than {} searches", kMostSearches));

  std::vector<SearchPlan> plans;
  for (const std::vector<ExtraSet>& combination : Combinations(parsed)) {
    std::vector<ExtraSet> extra = SetsOf(size);
    std::string settings;
    for (const ExtraSet& set : combination) {
      settings += fmt::format("{}{}={}", settings.empty() ? "" : ", ", set.key, set.value);
      extra.push_back(set);
    }
    const Result<Experiment> experiment = LoadExperimentWith(options, extra);
    if (!experiment) return experiment.error();
    if (numbers.empty()) plans.push_back({settings, *experiment});
    for (const std::uint64_t seed : numbers) {
      SearchPlan plan{fmt::format("{}{}seed {}", settings, settings.empty() ? "" : ", ", seed), *experiment};
      plan.experiment.seed = seed;
      plans.push_back(std::move(plan));
    }
  }
  if (plans.size() == 1) plans.front().settings.clear();
  return plans;
}

}  // namespace gauntlet::master
