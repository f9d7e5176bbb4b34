#include "study/questions/distinct_failures.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

namespace gauntlet {
namespace {

using Feature = std::string FailureFeatures::*;

// Of what is left of the case; null when it was not minimised.
const SmallestLayout* LayoutOf(const Confirmation& one, const std::vector<SmallestLayout>& layouts) {
  const auto layout = std::ranges::find(layouts, one.run, &SmallestLayout::run);
  return one.run == 0 || layout == layouts.end() ? nullptr : &*layout;
}

const SmallestLayout* Smaller(const SmallestLayout* one, const SmallestLayout* other) {
  if (one == nullptr || other == nullptr) return one == nullptr ? other : one;
  const auto obstacles = [](const SmallestLayout* layout) {
    return layout->document.test_case.obstacles.size();
  };
  return obstacles(other) < obstacles(one) ? other : one;
}

std::vector<std::string> ValuesOf(const Confirmation& one, Feature feature) {
  std::vector<std::string> values;
  for (const FailedRun& run : one.failed) values.push_back(run.features.*feature);
  return values;
}

void AddTo(FailureGrouping& grouping, const Confirmation& one, const LeadingFeature& leading, Feature feature,
           const SmallestLayout* layout) {
  std::vector<DistinctFailure>& groups = grouping.groups;
  auto group = std::ranges::find(groups, leading.value, &DistinctFailure::name);
  if (group == groups.end()) {
    group = groups.insert(groups.end(), {.feature = grouping.feature, .name = leading.value, .cases = {}});
    group->typical = &*std::ranges::find(one.failed, leading.value,
                                         [feature](const FailedRun& run) { return run.features.*feature; });
  }
  group->cases.push_back(&one);
  group->agreeing_runs += leading.runs;
  group->failed_runs += leading.of;
  group->smallest = Smaller(group->smallest, layout);
}

// `toughest_first`: the cases of which a run failed.
FailureGrouping Grouped(FailureGrouping grouping, Feature feature,
                        std::span<const Confirmation* const> toughest_first,
                        const std::vector<SmallestLayout>& layouts) {
  std::vector<std::vector<std::string>> values;
  for (const Confirmation* one : toughest_first) values.push_back(ValuesOf(*one, feature));
  grouping.agreement = AgreementWithin(values);
  std::vector<std::string> all;
  for (const std::vector<std::string>& some : values) all.insert(all.end(), some.begin(), some.end());
  grouping.overall = LeadingOf(all);
  if (!grouping.Used()) return grouping;
  int told = 0;
  for (std::size_t i = 0; i < toughest_first.size(); ++i) {
    const auto leading = LeadingOf(values[i]);
    if (!leading || leading->of < static_cast<int>(kRunsForGroup)) continue;
    ++told;
    if (leading->leads) {
      AddTo(grouping, *toughest_first[i], *leading, feature, LayoutOf(*toughest_first[i], layouts));
    } else {
      ++grouping.mixed;
    }
  }
  for (DistinctFailure& group : grouping.groups) group.share = static_cast<double>(group.cases.size()) / told;
  std::ranges::stable_sort(grouping.groups, std::greater(), [](const DistinctFailure& one) {
    return std::pair(Toughness(*one.cases.front()), one.cases.size());
  });
  return grouping;
}

}  // namespace

bool DistinctFailure::Confirmed() const {
  return std::ranges::any_of(cases,
                             [](const Confirmation* one) { return one->verdict == FailureVerdict::kFail; });
}

std::vector<const DistinctFailure*> DistinctFailures::All() const {
  std::vector<const DistinctFailure*> all;
  for (const FailureGrouping& grouping : groupings) {
    for (const DistinctFailure& one : grouping.groups) all.push_back(&one);
  }
  return all;
}

DistinctFailures DistinctFailuresOf(const std::vector<Confirmation>& confirmations,
                                    const std::vector<SmallestLayout>& layouts) {
  DistinctFailures distinct;
  std::vector<const Confirmation*> failing;
  for (const Confirmation& one : confirmations) {
    if (one.failed.empty()) continue;
    failing.push_back(&one);
    if (one.failed.size() < kRunsForGroup) ++distinct.too_few;
  }
  distinct.failing = static_cast<int>(failing.size());
  std::ranges::stable_sort(failing, std::greater(), [](const auto* one) { return Toughness(*one); });
  const FailureGrouping by_mechanism = {
      .feature = "mechanism",
      .title = "What happens",
      .phrase = "what happens",
      .unknown = "No trajectory of a failed run was kept, and the scenario declares nothing else.",
      .agreement = {}};
  const FailureGrouping by_place = {.feature = "place",
                                    .title = "Where it happens",
                                    .phrase = "place",
                                    .unknown = "The scenario declares no place that its runs fail at.",
                                    .agreement = {}};
  distinct.groupings = {Grouped(by_mechanism, &FailureFeatures::mechanism, failing, layouts),
                        Grouped(by_place, &FailureFeatures::place, failing, layouts)};
  return distinct;
}

}  // namespace gauntlet
