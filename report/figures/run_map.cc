#include "report/figures/run_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "analysis/figures/value_axis.h"
#include "base/number_text.h"
#include "controllers/registry.h"
#include "sim/geometry/trigonometry.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

constexpr int kMostBins = 8;  // of a descriptor, and one where they begin at a round number

// Puts runs into the cells of a map, and remembers the toughest of each.
class Filling {
 public:
  Filling(const CampaignFacts& facts, RunMap& map) : map_(map) {
    map.cells.assign(map.rows.size(), std::vector<analysis::HeatCell>(map.columns.size()));
    map.toughest.assign(map.rows.size(), std::vector<RunId>(map.columns.size()));
    for (const CaseFacts& one : facts.cases) mean_[{one.search, one.individual}] = one.fitness.mean();
  }

  void Add(const RunFacts& run, std::size_t row, std::size_t column) {
    ++map_.cells[row][column].count;
    const std::tuple<double, double, RunId> rank{run.fitness, mean_[{run.search, run.individual}], run.id};
    RunId& toughest = map_.toughest[row][column];
    const auto [best, first] = best_.try_emplace(&toughest, rank);
    if (!first && best->second <= rank) return;
    best->second = rank;
    toughest = run.id;
  }

 private:
  RunMap& map_;
  std::map<std::pair<SearchId, IndividualId>, double> mean_;
  std::map<const RunId*, std::tuple<double, double, RunId>> best_;
};

std::size_t PlaceOf(std::vector<std::string>& names, const std::string& name) {
  const auto place = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  if (place == names.size()) names.push_back(name);
  return place;
}

RunMap FailureMap(const CampaignFacts& facts, const controllers::ScenarioInfo& scenario) {
  RunMap map;
  map.name = "failure-types";
  map.title = "Types of total failure";
  map.across_name = scenario.failure_types.columns;
  map.down_name = scenario.failure_types.rows;
  std::map<int, std::pair<std::size_t, std::size_t>> places;
  for (const controllers::FailureType& type : scenario.failure_types.types) {
    // Types without an order stand one below the other.
    const std::size_t row = PlaceOf(map.rows, std::string(type.row.empty() ? type.name : type.row));
    const std::size_t column = PlaceOf(map.columns, std::string(type.column.empty() ? "runs" : type.column));
    places[type.type] = {row, column};
  }
  Filling filling(facts, map);
  for (const controllers::FailureType& type : scenario.failure_types.types) {
    const auto [row, column] = places[type.type];
    map.cells[row][column].meaning = type.name;
  }
  std::uint64_t untyped = 0;
  std::uint64_t typed = 0;
  for (const RunFacts& run : facts.runs) {
    if (!run.total_failure) continue;
    const auto place = places.find(run.failure_type);
    if (place == places.end()) {
      ++untyped;
      continue;
    }
    ++typed;
    filling.Add(run, place->second.first, place->second.second);
  }
  const auto seen = std::ranges::count_if(places, [&](const auto& place) {
    return map.cells[place.second.first][place.second.second].count > 0;
  });
  map.outcome = fmt::format("{} of {} types came up, in {} runs", seen, places.size(), FormatCount(typed));
  if (untyped > 0) {
    map.outcome +=
        fmt::format("; {} more total failures {}", FormatCount(untyped), scenario.failure_types.untyped);
  }
  map.reading =
      "Each field counts the runs in which the whole swarm failed in that way: the darker, the more. An "
      "empty "
      "field is a way of failing that never came up.";
  return map;
}

// A descriptor cut into ranges.
class Bins {
 public:
  Bins(const controllers::MetricInfo& info, const std::vector<RunFacts>& runs, std::size_t number)
      : number_(number), degrees_(info.unit == "rad") {
    low_ = std::numeric_limits<double>::infinity();
    double high = -low_;
    bool whole = true;
    for (const RunFacts& run : runs) {
      const double value = ValueOf(run);
      if (!std::isfinite(value)) continue;
      low_ = std::min(low_, value);
      high = std::max(high, value);
      whole = whole && value == std::round(value);
    }
    if (!(low_ <= high)) return;
    width_ = high > low_ ? analysis::RoundStep(high - low_, kMostBins) : 1.0;
    if (whole) width_ = std::max(width_, 1.0);
    low_ = std::floor(low_ / width_) * width_;
    const std::string unit = degrees_ ? "degrees" : info.unit;
    name_ = unit.empty() ? std::string(info.name) : fmt::format("{}, {}", info.name, unit);
    const auto bins = static_cast<std::size_t>(std::floor((high - low_) / width_)) + 1;
    for (std::size_t i = 0; i < bins; ++i) {
      const double begin = low_ + width_ * static_cast<double>(i);
      const double end = whole ? begin + width_ - 1 : begin + width_;
      names_.push_back(begin == end ? fmt::format("{:.4g}", begin)
                                    : fmt::format("{:.4g}{}{:.4g}", begin, low_ < 0.0 ? " to " : "-", end));
    }
  }

  bool empty() const { return names_.empty(); }
  const std::string& name() const { return name_; }
  const std::vector<std::string>& names() const { return names_; }
  // The number of bins when the run has no value.
  std::size_t BinOf(const RunFacts& run) const {
    const double value = ValueOf(run);
    if (!std::isfinite(value)) return names_.size();
    return std::min(static_cast<std::size_t>((value - low_) / width_), names_.size() - 1);
  }

 private:
  double ValueOf(const RunFacts& run) const {
    return run.descriptors[number_] / (degrees_ ? sim::kDegree : 1.0);
  }

  std::size_t number_;
  bool degrees_;
  double low_ = 0.0;
  double width_ = 0.0;
  std::string name_;
  std::vector<std::string> names_;
};

std::vector<Bins> BinsOf(const CampaignFacts& facts, const controllers::ScenarioInfo& scenario) {
  std::vector<Bins> bins;
  std::size_t number = 0;
  for (const controllers::MetricInfo& metric : scenario.metrics) {
    if (!metric.descriptor || bins.size() == 2) continue;
    bins.emplace_back(metric, facts.runs, number++);
    if (bins.back().empty()) return {};
  }
  return bins;
}

RunMap BehaviourMap(const CampaignFacts& facts, const std::vector<Bins>& bins) {
  const Bins& across = bins.front();
  const Bins* down = bins.size() > 1 ? &bins[1] : nullptr;
  RunMap map;
  map.name = "behaviour";
  map.title = "How the swarms behaved";
  map.across_name = across.name();
  map.down_name = down == nullptr ? "" : down->name();
  map.columns = across.names();
  map.rows = down == nullptr ? std::vector<std::string>{"runs"} : down->names();
  std::ranges::reverse(map.rows);  // upwards, as in an arena that is seen from above
  Filling filling(facts, map);
  std::uint64_t counted = 0;
  for (const RunFacts& run : facts.runs) {
    const std::size_t column = across.BinOf(run);
    const std::size_t row = down == nullptr ? 0 : down->BinOf(run);
    if (column == map.columns.size() || row == map.rows.size()) continue;
    ++counted;
    filling.Add(run, map.rows.size() - 1 - row, column);
  }
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    for (std::size_t column = 0; column < map.columns.size(); ++column) {
      map.cells[row][column].meaning = fmt::format("{}: {}", map.across_name, map.columns[column]);
      if (down != nullptr)
        map.cells[row][column].meaning += fmt::format("; {}: {}", map.down_name, map.rows[row]);
    }
  }
  map.outcome =
      fmt::format("{} of {} runs have these values", FormatCount(counted), FormatCount(facts.runs.size()));
  map.reading =
      "Each field counts the runs whose behaviour lies in these ranges, failed or not: the darker, the more. "
      "Values grow to the right and upwards.";
  return map;
}

}  // namespace

std::vector<RunMap> MapsOf(const CampaignFacts& facts) {
  const Experiment& first = facts.plans.front().experiment;
  if (!CheckOneSetting(facts.plans, facts.directory)) return {};
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(first);
  const bool one_scenario = std::ranges::all_of(facts.plans, [&](const SearchPlan& plan) {
    return plan.experiment.scenario == first.scenario &&
           plan.experiment.scenario_plugin == first.scenario_plugin;
  });
  if (!one_scenario) return {};
  std::vector<RunMap> maps;
  if (!scenario.failure_types.types.empty()) maps.push_back(FailureMap(facts, scenario));
  if (const std::vector<Bins> bins = BinsOf(facts, scenario); !bins.empty())
    maps.push_back(BehaviourMap(facts, bins));
  std::erase_if(maps, [](const RunMap& map) { return map.Largest() == 0; });
  return maps;
}

}  // namespace gauntlet
