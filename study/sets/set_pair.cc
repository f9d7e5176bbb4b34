#include "study/sets/set_pair.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"

namespace gauntlet {
namespace {

struct SharedCases {
  PairedValues values;
  std::size_t left_out = 0;
};

// The cases that both sets have, each as often as both have it.
SharedCases CasesOfBoth(const RunSet& first, const RunSet& second) {
  SharedCases shared;
  std::multimap<std::uint64_t, const CaseInSet*> of_second;
  for (const CaseInSet& one : second.cases) of_second.emplace(one.hash, &one);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> units;
  shared.values.single = true;
  for (const CaseInSet& one : first.cases) {
    const auto partner = of_second.find(one.hash);
    if (partner == of_second.end()) {
      ++shared.left_out;
      continue;
    }
    const CaseInSet& other = *partner->second;
    of_second.erase(partner);
    shared.values.Add({one.mean, other.mean},
                      units.try_emplace({one.unit, other.unit}, units.size()).first->second);
    shared.values.single = shared.values.single && one.runs == 1 && other.runs == 1;
    shared.values.runs_each[0] += static_cast<double>(one.runs);
    shared.values.runs_each[1] += static_cast<double>(other.runs);
  }
  shared.left_out += of_second.size();
  for (double& runs : shared.values.runs_each)
    runs /= std::max(1.0, static_cast<double>(shared.values.cases.size()));
  return shared;
}

// Whether the metric is 1 or 0 in each run.
bool IsYesNo(const RunSet& set, const std::string& metric) {
  if (set.origins.empty()) return false;
  if (metric == "total_failure") return true;
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(set.origins.front().experiment);
  const controllers::MetricInfo* info =
      scenario == nullptr ? nullptr : controllers::FindMetric(*scenario, metric);
  return info != nullptr && info->unit == "yes/no";
}

std::string PairsInWords(const SetPair& pair, bool yes_no, const std::string& first,
                         const std::string& second) {
  const PairedComparison& paired = *pair.paired;
  const std::string units = paired.relatives ? fmt::format(" of {} evolutions", paired.units) : std::string();
  std::string words = fmt::format(
      "Both sets are of the same {}{}, so they are compared case by case. {} less {} is {}; {} is larger in "
      "{}, "
      "smaller in {}; {}.",
      Counted(paired.cases, "case"), units, first, second, DifferenceInWords(paired, yes_no), first,
      FormatCount(paired.larger), FormatCount(paired.smaller), analysis::TestInWords(pair.p, pair.p_by));
  if (pair.left_out > 0)
    words += fmt::format(" {} of one set alone: left out.", Counted(pair.left_out, "case"));
  return words;
}

}  // namespace

Result<SetPair> HoldAgainst(const RunSet& first, const RunSet& second, const std::string& metric,
                            const std::string& first_name, const std::string& second_name, Pairing pairing) {
  const bool yes_no = IsYesNo(first, metric) && IsYesNo(second, metric);
  SetPair pair;
  TRY(pair.comparison, analysis::Compare(first.values, second.values, yes_no));
  SharedCases shared = CasesOfBoth(first, second);
  const std::size_t smaller = std::min(first.cases.size(), second.cases.size());
  if (pairing == Pairing::kDemanded && shared.values.cases.empty())
    return InvalidInput("--paired: no case is one of both sets, so nothing can be paired");
  const bool pairs = pairing == Pairing::kDemanded || (pairing == Pairing::kWhereShared && smaller > 0 &&
                                                       shared.values.cases.size() == smaller);
  if (!pairs) {
    pair.p = pair.comparison.p;
    pair.p_by = pair.comparison.p_by;
    pair.words = analysis::InWords(pair.comparison, first_name, second_name);
    return pair;
  }
  shared.values.yes_no = yes_no;
  pair.paired = ComparePairs(shared.values);
  pair.left_out = shared.left_out;
  pair.p = pair.paired->p;
  pair.p_by = pair.paired->method;
  pair.words = PairsInWords(pair, yes_no, first_name, second_name);
  return pair;
}

}  // namespace gauntlet
