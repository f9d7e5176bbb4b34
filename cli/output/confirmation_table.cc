#include "cli/output/confirmation_table.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "proto/run_failure.h"

namespace gauntlet {
namespace {

// "run 8, minimised to 2 obstacles, fails in 24 of 30 runs".
std::string DescribeSmallest(const SmallestLayout& smallest) {
  const std::size_t obstacles = smallest.document.test_case.obstacles.size();
  const proto::CaseFailures& verified = smallest.document.lineage->verified;
  return fmt::format("run {}, minimised to {} obstacle{}, fails in {} of {} runs", smallest.run, obstacles,
                     obstacles == 1 ? "" : "s", verified.failures, verified.runs);
}

nlohmann::ordered_json SmallestJson(const SmallestLayout* smallest) {
  if (smallest == nullptr) return {};
  const proto::CaseFailures& verified = smallest->document.lineage->verified;
  return {{"case", fmt::format("run {}", smallest->run)},
          {"obstacles", smallest->document.test_case.obstacles.size()},
          {"k", verified.failures},
          {"n", verified.runs},
          {"file", smallest->file}};
}

}  // namespace

std::string DistinctFailuresText(const CampaignAnswers& answers, const std::string& program,
                                 std::size_t most) {
  const std::vector<Confirmation>& confirmations = answers.confirmations;
  if (confirmations.empty()) return {};
  const std::vector<DistinctFailure> failures = DistinctFailures(confirmations, answers.smallest_layouts);
  const auto confirmed = std::ranges::count(failures, true, &DistinctFailure::confirmed);
  std::string text =
      fmt::format("\n{} distinct failure{} ({} confirmed) in {} cases with fresh seeds\n", failures.size(),
                  failures.size() == 1 ? "" : "s", confirmed, confirmations.size());
  Table table({">", "toughest", ">fails", ">cases", "what happens", ">smallest", "to see it"});
  for (std::size_t i = 0; i < std::min(most, failures.size()); ++i) {
    const Confirmation& toughest = *failures[i].cases.front();
    table.AddRow({fmt::format("{}", i + 1), Printable(toughest.name),
                  fmt::format("{} of {}", toughest.tally.failures, toughest.tally.runs()),
                  fmt::format("{}", failures[i].cases.size()), failures[i].what,
                  failures[i].smallest == nullptr
                      ? "-"
                      : fmt::format("{}", failures[i].smallest->document.test_case.obstacles.size()),
                  fmt::format("{} replay {} {} --svg failure-{}.svg", program,
                              PastedPath(toughest.example->campaign), toughest.example->run, i + 1)});
  }
  text += table.ToText();
  for (const DistinctFailure& failure : std::span(failures).first(std::min(most, failures.size()))) {
    if (failure.smallest != nullptr)
      text +=
          fmt::format("  {}: {}\n", DescribeSmallest(*failure.smallest), PastedPath(failure.smallest->file));
  }
  if (failures.size() > most) text += fmt::format("  and {} more; see show --json\n", failures.size() - most);
  return text;
}

nlohmann::ordered_json DistinctFailuresJson(const CampaignAnswers& answers) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DistinctFailure& failure : DistinctFailures(answers.confirmations, answers.smallest_layouts)) {
    nlohmann::ordered_json cases = nlohmann::ordered_json::array();
    for (const Confirmation* one : failure.cases) cases.push_back(one->name);
    const Confirmation& toughest = *failure.cases.front();
    list.push_back({{"what", failure.what},
                    {"confirmed", failure.confirmed},
                    {"k", toughest.tally.failures},
                    {"n", toughest.tally.runs()},
                    {"interval", {toughest.interval.low, toughest.interval.high}},
                    {"cases", std::move(cases)},
                    {"example", {{"campaign", toughest.example->campaign}, {"run", toughest.example->run}}},
                    {"smallest", SmallestJson(failure.smallest)}});
  }
  return list;
}

}  // namespace gauntlet
