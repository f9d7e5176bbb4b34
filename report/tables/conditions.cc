#include "report/tables/conditions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "base/split.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

double ShareOf(std::uint64_t failing, std::uint64_t runs) {
  return static_cast<double>(failing) / static_cast<double>(runs);
}

// Whether the units of a condition are the cases of its only search.
bool OfCases(const Condition& condition, const CampaignSummary& summary) {
  const SearchRow* row = FindSearch(summary.searches[condition.searches.front()].search);
  return condition.searches.size() == 1 && row != nullptr && row->individuals == Individuals::kCases;
}

// The shares of failing runs of a condition's units.
std::vector<double> SharesOf(const Condition& condition, const CampaignSummary& summary) {
  std::vector<double> shares;
  const SearchSummary& first = summary.searches[condition.searches.front()];
  if (OfCases(condition, summary)) {
    for (const PopulationMember& one : first.population) {
      if (!one.runs.empty()) shares.push_back(ShareOf(one.failing_runs, one.runs.size()));
    }
    return shares;
  }
  for (const std::size_t search : condition.searches) {
    const SearchSummary& one = summary.searches[search];
    if (one.runs_done > 0) shares.push_back(ShareOf(one.failing_runs, one.runs_done));
  }
  return shares;
}

void Judge(const CampaignSummary& summary, Condition& condition) {
  for (const std::size_t search : condition.searches) {
    condition.runs += summary.searches[search].runs_done;
    condition.failing_runs += summary.searches[search].failing_runs;
  }
  const std::vector<double> shares = SharesOf(condition, summary);
  condition.share = std::numeric_limits<double>::quiet_NaN();
  if (shares.empty()) return;
  double sum = 0.0;
  for (const double share : shares) sum += share;
  condition.share = sum / static_cast<double>(shares.size());
  if (shares.size() < 2 && !OfCases(condition, summary)) return;
  if (shares.size() < 2) {
    condition.interval =
        analysis::WilsonInterval(static_cast<std::uint32_t>(condition.failing_runs),
                                 static_cast<std::uint32_t>(condition.runs), analysis::kConfidence);
    return;
  }
  const double each = static_cast<double>(condition.runs) / static_cast<double>(shares.size());
  condition.interval = analysis::MeanShareInterval(shares, each, analysis::kConfidence);
}

std::string ShareAndSettings(const Condition& condition) {
  return fmt::format("{:.1f} % ({})", 100.0 * condition.share, condition.settings);
}

}  // namespace

std::string ConditionOf(const std::string& settings) {
  std::string name;
  for (const std::string& part : Split(settings, ',')) {
    std::string_view one = Trimmed(part);
    if (one.empty() || one.starts_with("seed ")) continue;
    one = one.substr(0, one.rfind(":search:"));
    name += fmt::format("{}{}", name.empty() ? "" : ", ", one);
  }
  return name;
}

std::vector<Condition> ConditionsOf(const CampaignSummary& summary) {
  std::vector<Condition> conditions;
  for (std::size_t i = 0; i < summary.searches.size(); ++i) {
    const std::string name = ConditionOf(summary.searches[i].settings);
    auto known = std::ranges::find(conditions, name, &Condition::settings);
    if (known == conditions.end()) known = conditions.insert(conditions.end(), Condition{name, {}});
    known->searches.push_back(i);
  }
  for (Condition& one : conditions) Judge(summary, one);
  return conditions;
}

Table ConditionsTable(const std::vector<Condition>& conditions) {
  const bool several =
      std::ranges::any_of(conditions, [](const Condition& one) { return one.searches.size() > 1; });
  Table table({{"condition", "settings"},
               several ? Column(">searches", "searches") : ForPrograms("searches"),
               {">failing runs", "k n"},
               {">share", "share"},
               {"95 %", "interval"}});
  for (const Condition& one : conditions) {
    table.AddRow({one.settings, one.searches.size(), OutOfCell(one.failing_runs, one.runs),
                  Cell(std::isnan(one.share) ? "-" : fmt::format("{:.1f} %", 100.0 * one.share),
                       NumberValue(one.share)),
                  one.interval ? PercentCell(*one.interval) : Cell()});
  }
  return table;
}

std::string RangeOf(const std::vector<Condition>& conditions) {
  std::vector<const Condition*> known;
  for (const Condition& one : conditions) {
    if (!std::isnan(one.share)) known.push_back(&one);
  }
  if (known.empty()) return "";
  const auto [least, most] =
      std::ranges::minmax_element(known, {}, [](const auto* one) { return one->share; });
  return fmt::format("from {} to {}", ShareAndSettings(**least), ShareAndSettings(**most));
}

}  // namespace gauntlet
