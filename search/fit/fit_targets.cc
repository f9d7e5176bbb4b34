#include "search/fit/fit_targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/sample.h"
#include "base/check.h"
#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "controllers/registry.h"

namespace gauntlet {
namespace {

using Statistic = FitTarget::Statistic;
using Demand = FitTarget::Demand;

constexpr std::array<std::string_view, 6> kStatistics = {"mean",  "sd",           "quantile",
                                                         "share", "distribution", "every"};
constexpr std::array<std::string_view, 4> kDemands = {"value", "at_most", "at_least", "runs"};
// Beside the scenario's metrics.
constexpr std::string_view kFitness = "fitness";
constexpr std::string_view kFailure = controllers::kTotalFailure;

Error Wrong(const std::string& target, const std::string& what) {
  return InvalidInput(fmt::format("target '{}': {}", target, what));
}

std::vector<std::string> NamesOfRuns(const controllers::ScenarioInfo& scenario) {
  std::vector<std::string> names = {std::string(kFitness), std::string(kFailure)};
  for (const controllers::MetricInfo& metric : scenario.metrics) {
    const bool is_name = metric.name.find('*') == std::string::npos;
    if (is_name && metric.name != kFitness && metric.name != kFailure) names.push_back(metric.name);
  }
  return names;
}

// "key=value" of a target, by their keys; a formula goes on to the end.
Result<std::map<std::string, std::string>> FieldsOf(const std::string& text) {
  static constexpr std::string_view kFormula = "formula=";
  std::map<std::string, std::string> fields;
  std::string rest(Trimmed(text));
  while (!rest.empty()) {
    const std::size_t end = rest.starts_with(kFormula) ? rest.size() : std::min(rest.find(' '), rest.size());
    const std::string word = rest.substr(0, end);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) return Wrong(text, fmt::format("'{}' is no KEY=VALUE", word));
    if (!fields.emplace(word.substr(0, equals), word.substr(equals + 1)).second)
      return Wrong(text, fmt::format("{} stands twice", word.substr(0, equals)));
    rest = std::string(Trimmed(std::string_view(rest).substr(end)));
  }
  return fields;
}

class TargetParser {
 public:
  TargetParser(const std::string& text, std::map<std::string, std::string> fields,
               const controllers::ScenarioInfo& scenario)
      : text_(text), fields_(std::move(fields)), scenario_(scenario) {}

  Result<FitTarget> Parse() {
    TRY(target_.cases, ParseFitCases(Take("cases").value_or("random")));
    target_.metric = Take("metric").value_or("");
    target_.formula = Take("formula").value_or("");
    TRY(ParseStatistic());
    TRY(ParseDemand());
    TRY(CheckSource());
    if (fields_.empty()) return std::move(target_);
    return Wrong(text_, fmt::format("'{}' has no place here", fields_.begin()->first));
  }

 private:
  std::optional<std::string> Take(const std::string& key) {
    auto node = fields_.extract(key);
    if (node.empty()) return std::nullopt;
    return std::move(node.mapped());
  }

  Result<double> TakeNumber(const std::string& key, double low, double high) {
    if (!fields_.contains(key)) return Wrong(text_, fmt::format("{} is missing", key));
    const std::string word = *Take(key);
    const auto number = ParseNumber<double>(word);
    if (number && *number >= low && *number <= high) return *number;
    return Wrong(text_, fmt::format("{} = {}: a number from {} to {} is needed", key, word, low, high));
  }

  Status ParseStatistic() {
    std::string name = Take("statistic").value_or("mean");
    if (name == "median") {
      name = "quantile";
      if (!fields_.emplace("quantile", "0.5").second)
        return Wrong(text_, "quantile has no place beside median");
    }
    const auto known = std::ranges::find(kStatistics, name);
    if (known == kStatistics.end()) {
      constexpr std::array<std::string_view, 5> kOffered = {"mean", "sd", "median", "quantile", "share"};
      return Wrong(text_, UnknownName("statistic", name, kOffered));
    }
    target_.statistic = static_cast<Statistic>(known - kStatistics.begin());
    if (target_.statistic == Statistic::kQuantile) {
      TRY(target_.quantile, TakeNumber("quantile", 0.0, 1.0));
    }
    return Ok{};
  }

  Status ParseDemand() {
    constexpr double kMost = 1e9;
    if (target_.statistic == Statistic::kEvery) {
      target_.demand = Demand::kEvery;
      TRY(target_.n, TakeNumber("runs", 1.0, 100'000.0));
      target_.values = {1.0};
      return Ok{};
    }
    if (target_.statistic == Statistic::kDistribution) return ParseDistribution();
    std::vector<Demand> given;
    for (const Demand demand : {Demand::kEquals, Demand::kAtMost, Demand::kAtLeast}) {
      if (fields_.contains(std::string(kDemands[static_cast<std::size_t>(demand)]))) given.push_back(demand);
    }
    if (given.size() != 1) return Wrong(text_, "one of value, at_most and at_least is needed");
    target_.demand = given.front();
    const bool share = target_.statistic == Statistic::kShare;
    const bool positive = share || target_.statistic == Statistic::kSd;
    TRY(const double value, TakeNumber(std::string(kDemands[static_cast<std::size_t>(target_.demand)]),
                                       positive ? 0.0 : -1e300, share ? 1.0 : 1e300));
    target_.values = {value};
    if (target_.demand != Demand::kEquals && !fields_.contains("n")) return Ok{};
    TRY(target_.n, TakeNumber("n", 2.0, kMost));
    return Ok{};
  }

  Status ParseDistribution() {
    for (const std::string& word : Split(Take("blocks").value_or(""), ',')) {
      const auto number = ParseNumber<double>(word);
      if (!number || !std::isfinite(*number))
        return Wrong(text_, fmt::format("block '{}' is no number", word));
      target_.values.push_back(*number);
    }
    if (target_.values.size() != kBlocks) return Wrong(text_, fmt::format("{} blocks are needed", kBlocks));
    TRY(target_.n, TakeNumber("n", 2.0, 1e9));
    TRY(target_.spread, TakeNumber("spread", 0.0, 1e300));
    return Ok{};
  }

  Status CheckSource() {
    const bool of_formula = target_.statistic == Statistic::kShare || target_.statistic == Statistic::kEvery;
    const std::vector<std::string> names = NamesOfRuns(scenario_);
    if (of_formula) {
      if (!target_.metric.empty()) return Wrong(text_, "a share is that of a formula, not of a metric");
      if (target_.formula.empty()) return Wrong(text_, "a formula is needed, as in birds_left == 0");
      const auto formula = controllers::generic::Formula::Compile(target_.formula, names);
      return formula.ok() ? Status(Ok{}) : Wrong(text_, formula.error().message);
    }
    if (!target_.formula.empty()) return Wrong(text_, "a formula is for statistic = \"share\"");
    if (target_.metric.empty()) return Wrong(text_, "a metric is needed: " + NamesOf(names));
    if (std::ranges::find(names, target_.metric) != names.end()) return Ok{};
    if (controllers::FindMetric(scenario_, target_.metric) != nullptr) return Ok{};  // one of a family
    return Wrong(text_, fmt::format("{} does not report it: {}", scenario_.name,
                                    UnknownName("metric", target_.metric, names)));
  }

  const std::string& text_;
  std::map<std::string, std::string> fields_;
  const controllers::ScenarioInfo& scenario_;
  FitTarget target_;
};

}  // namespace

std::string FitCases::ToText() const {
  switch (kind) {
    case Kind::kEmpty:
      return "empty";
    case Kind::kRandom:
      return count == 0 ? "random" : fmt::format("random:{}", count);
    case Kind::kGiven:
      return fmt::format("given:{}-{}", first, last);
  }
  return "";
}

Result<FitCases> ParseFitCases(const std::string& text) {
  if (text == "empty") return FitCases{.kind = FitCases::Kind::kEmpty};
  if (text == "random") return FitCases{};
  const std::vector<std::string> parts = Split(text, ':');
  if (parts.size() == 2 && parts[0] == "random") {
    const auto count = ParseNumber<int>(parts[1]);
    if (count && *count >= 2 && *count <= 100'000) return FitCases{.count = *count};
    return InvalidInput(fmt::format("cases = {}: random:N takes N from 2 to 100000", text));
  }
  const std::vector<std::string> ends = parts.size() == 2 ? Split(parts[1], '-') : std::vector<std::string>();
  if (ends.size() == 2 && parts[0] == "given") {
    const auto first = ParseNumber<std::size_t>(ends[0]);
    const auto last = ParseNumber<std::size_t>(ends[1]);
    if (first && last && *first >= 1 && *first <= *last)
      return FitCases{.kind = FitCases::Kind::kGiven, .first = *first, .last = *last};
  }
  return InvalidInput(
      fmt::format("cases = {}: neither random, random:N, empty, a case file nor a campaign's "
                  "subset",
                  text));
}

std::string FitTarget::StatisticText() const {
  if (statistic == Statistic::kQuantile)
    return quantile == 0.5 ? "median" : fmt::format("quantile:{}", quantile);
  const std::string name(kStatistics[static_cast<std::size_t>(statistic)]);
  return formula.empty() ? name : fmt::format("{}:{}", name, formula);
}

std::string FitTarget::Title() const {
  const std::string of = metric.empty() ? formula : metric;
  const std::string name =
      statistic == Statistic::kQuantile && quantile != 0.5 ? fmt::format("{:g} % quantile", quantile * 100.0)
      : statistic == Statistic::kQuantile                  ? "median"
      : statistic == Statistic::kEvery                     ? "every run has"
                                       : std::string(kStatistics[static_cast<std::size_t>(statistic)]);
  return fmt::format("{} {}{}, {}", name, statistic == Statistic::kEvery ? "" : "of ", of, cases.ToText());
}

std::string FitTarget::Wanted() const {
  switch (demand) {
    case Demand::kEvery:
      return fmt::format("in {:g} of {:g}", n, n);
    case Demand::kAtMost:
      return fmt::format("at most {:g}", values[0]);
    case Demand::kAtLeast:
      return fmt::format("at least {:g}", values[0]);
    case Demand::kEquals:
      break;
  }
  if (statistic == Statistic::kDistribution)
    return fmt::format("as measured, mean {:.4g} (n = {:g})", analysis::Describe(values).mean, n);
  return fmt::format("{:g} (n = {:g})", values[0], n);
}

std::string FitTarget::ToText() const {
  std::string text = "cases=" + cases.ToText();
  const auto add = [&](std::string_view key, const auto& value) {
    text += fmt::format(" {}={}", key, value);
  };
  add("statistic", kStatistics[static_cast<std::size_t>(statistic)]);
  if (!metric.empty()) add("metric", metric);
  if (statistic == Statistic::kQuantile) add("quantile", quantile);
  if (statistic == Statistic::kDistribution) {
    add("blocks", fmt::format("{}", fmt::join(values, ",")));
    add("spread", spread);
  } else if (demand != Demand::kEvery) {
    add(kDemands[static_cast<std::size_t>(demand)], values[0]);
  }
  if (n > 0.0) add(demand == Demand::kEvery ? "runs" : "n", n);
  if (!formula.empty()) add("formula", formula);
  return text;
}

std::vector<double> BlockMeans(std::vector<double> values) {
  GAUNTLET_CHECK(!values.empty(), "no value");
  std::ranges::sort(values);
  // The quantile function: straight between the values at their places, and on beyond the outermost.
  const auto n = static_cast<double>(values.size());
  constexpr double kBeyond = 0.625;  // of a distance between two places
  const double first_step = values.size() > 1 ? values[1] - values[0] : 0.0;
  const double last_step = values.size() > 1 ? values.back() - values[values.size() - 2] : 0.0;
  std::vector<std::pair<double, double>> points = {{0.0, values.front() - kBeyond * first_step}};
  for (const double value : values)
    points.emplace_back((static_cast<double>(points.size()) - 0.375) / (n + 0.25), value);
  points.emplace_back(1.0, values.back() + kBeyond * last_step);
  std::vector<double> means(kBlocks, 0.0);
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto [begin, from] = points[i - 1];
    const auto [end, to] = points[i];
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const double low = std::max(begin, static_cast<double>(block) / kBlocks);
      const double high = std::min(end, static_cast<double>(block + 1) / kBlocks);
      if (low >= high) continue;
      const double share = ((low + high) / 2.0 - begin) / (end - begin);
      const double area = (high - low) * (from + share * (to - from));
      means[block] += kBlocks * area;
      sum += area;
    }
  }
  const double mean = analysis::Describe(values).mean;
  for (double& one : means) one += mean - sum;
  return means;
}

Result<std::vector<FitTarget>> ParseFitTargets(const std::string& text,
                                               const controllers::ScenarioInfo& scenario) {
  std::vector<FitTarget> targets;
  for (const std::string& one : Split(text, ';')) {
    TRY(auto fields, FieldsOf(one));
    TRY(FitTarget target, TargetParser(one, std::move(fields), scenario).Parse());
    targets.push_back(std::move(target));
  }
  return targets;
}

TargetReader::TargetReader(std::span<const FitTarget> targets, const controllers::ScenarioInfo& scenario)
    : names_(NamesOfRuns(scenario)) {
  for (const FitTarget& target : targets) {
    Source& source = sources_.emplace_back();
    source.metric = target.metric;
    source.info = controllers::FindMetric(scenario, target.metric);
    if (target.formula.empty()) continue;
    source.formula.push_back(controllers::generic::Formula::Compile(target.formula, names_).value());
  }
}

std::vector<double> TargetReader::Read(const RunOutcome& run) {
  const auto value_of = [&](std::string_view name) {
    if (name == kFitness) return run.fitness;
    if (name == kFailure) return run.total_failure ? 1.0 : 0.0;
    for (const auto& [metric, value] : run.metrics) {
      if (metric == name) return value;
    }
    return kNotMeasured;
  };
  std::vector<double> read;
  for (Source& source : sources_) {
    if (source.formula.empty()) {
      const double value = value_of(source.metric);
      const bool none = source.info != nullptr && source.info->none == value;
      read.push_back(none ? kNotMeasured : value);
      continue;
    }
    std::vector<double> values;
    for (const std::string& name : names_) values.push_back(value_of(name));
    const Result<double> holds = source.formula.front().Evaluate(values);
    read.push_back(holds.ok() ? (*holds != 0.0 ? 1.0 : 0.0) : kNotMeasured);
  }
  return read;
}

std::vector<double> StatisticOf(const FitTarget& target, std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.size() < 2) return {};
  switch (target.statistic) {
    case Statistic::kMean:
    case Statistic::kShare:
    case Statistic::kEvery:
      return {analysis::Describe(values).mean};
    case Statistic::kSd:
      return {analysis::Describe(values).sd.value()};
    case Statistic::kQuantile:
      return {analysis::Quantile(values, target.quantile)};
    case Statistic::kDistribution:
      return BlockMeans(std::move(values));
  }
  return {};
}

}  // namespace gauntlet
