#include "master/directory/search_length.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "base/check.h"
#include "search/experiment/experiment_file.h"
#include "search/search_setup.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

std::string KeyOf(const std::string& set) {
  return set.substr(0, set.find('='));
}

std::string_view LengthKeyOf(const SearchPlan& plan) {
  return RowOf(plan.experiment).info.length;
}

KeyValue LengthOf(const SearchPlan& plan) {
  const auto key = std::ranges::find(BuiltInKeys(), LengthKeyOf(plan), &Key::path);
  GAUNTLET_CHECK(key != BuiltInKeys().end(), std::string(LengthKeyOf(plan)));
  return key->get(plan.experiment);
}

// Whether `set` says how long searches go on, and nothing that makes them other searches.
Status CheckIsLength(const std::vector<SearchPlan>& plans, const std::string& set) {
  const std::string key = KeyOf(set);
  std::set<std::string_view> lengths;
  for (const SearchPlan& plan : plans) {
    if (!LengthKeyOf(plan).empty()) lengths.insert(LengthKeyOf(plan));
    const bool told_apart = (", " + plan.settings).find(", " + key + "=") != std::string::npos;
    if (LengthKeyOf(plan) != key || !told_apart) continue;
    return InvalidInput(
        fmt::format("--set {}: the searches of this campaign are told apart by {} ({}), so none can be made "
                    "longer: begin a new campaign",
                    set, key, plan.settings));
  }
  if (lengths.contains(key)) return Ok{};
  if (lengths.empty()) {
    return InvalidInput(fmt::format(
        "--set {}: this campaign ends with the last of its {}, and nothing makes it longer: begin "
        "a new one",
        set, RowOf(plans.front().experiment).title));
  }
  return InvalidInput(
      fmt::format("--set {}: of a campaign that exists only its length may change, {}; with another {} it "
                  "would no longer be the same search: begin a new campaign",
                  set, fmt::join(lengths, " or "), key));
}

}  // namespace

Result<std::vector<SearchPlan>> WithLength(const std::vector<SearchPlan>& plans,
                                           const std::vector<std::string>& sets) {
  for (const std::string& set : sets) {
    TRY(CheckIsLength(plans, set));
  }
  std::vector<SearchPlan> longer = plans;
  for (SearchPlan& plan : longer) {
    std::vector<std::string> own;
    std::ranges::copy_if(sets, std::back_inserter(own),
                         [&](const std::string& set) { return KeyOf(set) == LengthKeyOf(plan); });
    if (own.empty()) continue;
    const KeyValue before = LengthOf(plan);
    TRY(plan.experiment, ParseExperiment(WriteExperiment(plan.experiment, {}, BuiltInCatalogue()),
                                         "experiment.toml", own, BuiltInCatalogue()));
    if (!(LengthOf(plan) < before)) continue;
    return InvalidInput(fmt::format("--set {}: the campaign has {} = {}, and can be made longer only",
                                    own.back(), LengthKeyOf(plan), ToToml(before)));
  }
  return longer;
}

bool AreSameSearches(const std::vector<SearchPlan>& some, const std::vector<SearchPlan>& others) {
  const auto course = [](const SearchPlan& plan) { return SearchIdentity(SetupOf(plan.experiment)); };
  const auto same = [&](const SearchPlan& one, const SearchPlan& other) {
    return one.settings == other.settings && course(one) == course(other);
  };
  return std::ranges::equal(some, others, same) && DescribeLengths(some, others).empty();
}

std::string DescribeLengths(const std::vector<SearchPlan>& before, const std::vector<SearchPlan>& after) {
  std::set<std::string> changes;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (LengthKeyOf(before[i]).empty() || LengthOf(before[i]) == LengthOf(after[i])) continue;
    changes.insert(fmt::format("{} from {} to {}", LengthKeyOf(before[i]), ToToml(LengthOf(before[i])),
                               ToToml(LengthOf(after[i]))));
  }
  return fmt::format("{}", fmt::join(changes, ", "));
}

}  // namespace gauntlet
