#include "report/figures/set_comparison.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "analysis/figures/box_figure.h"
#include "analysis/statistics/multiple_tests.h"
#include "analysis/tables/table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostInAllPairs = 4;

Result<ComparedPair> Compared(const std::vector<RunSet>& sets, std::size_t first, std::size_t second) {
  TRY(auto held,
      HoldAgainst(sets[first], sets[second], "fitness", sets[first].values.name, sets[second].values.name));
  return ComparedPair{.first = first,
                      .second = second,
                      .held = std::move(held),
                      .p_adjusted = {},
                      .differences = WhatDiffers(sets[first], sets[second])};
}

Result<SetComparison> ComparisonOf(const std::string& scenario, std::vector<RunSet> sets) {
  SetComparison comparison{scenario, std::move(sets), {}};
  const std::size_t count = comparison.sets.size();
  for (std::size_t first = 0; first < (count <= kMostInAllPairs ? count : 1); ++first) {
    for (std::size_t second = first + 1; second < count; ++second) {
      TRY(auto pair, Compared(comparison.sets, first, second));
      comparison.pairs.push_back(std::move(pair));
    }
  }
  std::vector<double> p;
  for (const ComparedPair& pair : comparison.pairs) {
    if (pair.held.p) p.push_back(*pair.held.p);
  }
  const std::vector<double> adjusted = analysis::HolmAdjusted(p);
  auto next = adjusted.begin();
  for (ComparedPair& pair : comparison.pairs) {
    if (pair.held.p) pair.p_adjusted = *next++;
  }
  return comparison;
}

}  // namespace

std::string DrawSets(const std::string& title, const std::string& outcome, const std::string& metric,
                     const std::vector<analysis::ComparedSet>& sets) {
  analysis::BoxFigure figure{.title = title,
                             .outcome = outcome,
                             .axis_name = metric == "fitness" ? "fitness (lower = tougher)" : metric,
                             .boxes = {}};
  for (const analysis::ComparedSet& set : sets) {
    std::vector<double> values;
    for (const auto& cluster : set.clusters) values.insert(values.end(), cluster.begin(), cluster.end());
    figure.boxes.push_back(
        {set.name, analysis::MakeBoxPlot(values), analysis::Describe(values).mean, values.size()});
  }
  return analysis::DrawBoxes(figure);
}

std::string SetsCsv(const std::string& metric, const std::vector<analysis::ComparedSet>& sets) {
  Table table({"set", "unit", metric});
  for (const analysis::ComparedSet& set : sets) {
    for (std::size_t unit = 0; unit < set.clusters.size(); ++unit) {
      for (const double value : set.clusters[unit]) table.AddRow({set.name, unit + 1, value});
    }
  }
  return table.ToCsv();
}

std::string TitleOf(const SetComparison& comparison) {
  const std::vector<RunSet>& sets = comparison.sets;
  return sets.size() == 2 ? fmt::format("{} against {}", sets[0].values.name, sets[1].values.name)
                          : fmt::format("{} and {} other sets of runs", sets[0].values.name, sets.size() - 1);
}

NamedFigure FigureOf(const SetComparison& comparison) {
  const std::string title = TitleOf(comparison);
  std::vector<analysis::ComparedSet> values;
  for (const RunSet& set : comparison.sets) values.push_back(set.values);
  return {"comparison", title, std::string(kReadingOfBoxes),
          [=] { return DrawSets(title, "", "fitness", values); }, [=] { return SetsCsv("fitness", values); }};
}

Result<SetComparisons> CompareSets(const std::vector<std::string>& names) {
  SetComparisons all;
  using NameAndPlugin = std::pair<std::string, std::string>;
  std::map<NameAndPlugin, std::vector<RunSet>> by_scenario;
  for (const std::string& name : names) {
    TRY(auto set, ReadRunSet(name, "fitness"));
    for (const std::string& note : set.notes) all.notes.push_back(note);
    if (set.values.clusters.empty()) {
      all.notes.push_back(fmt::format("{} has no run with a fitness: it is not compared", name));
      continue;
    }
    const Experiment experiment = set.origins.empty() ? Experiment() : set.origins.front().experiment;
    by_scenario[{experiment.scenario, experiment.scenario_plugin}].push_back(std::move(set));
  }
  for (auto& [name_and_plugin, sets] : by_scenario) {
    const std::string& scenario = name_and_plugin.first;
    if (sets.size() < 2) {
      if (names.size() > 1) {
        all.notes.push_back(fmt::format("{} stands alone: no other set is of the scenario {}",
                                        sets.front().values.name, scenario));
      }
      continue;
    }
    TRY(auto comparison, ComparisonOf(scenario, std::move(sets)));
    all.comparisons.push_back(std::move(comparison));
  }
  return all;
}

}  // namespace gauntlet
