#include "report/tables/distinct_failures.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/shell_quoted.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

Json SmallestJson(const SmallestLayout& smallest) {
  const proto::CaseFailures& verified = smallest.document.lineage->verified;
  return {{"case", fmt::format("run {}", smallest.run)},
          {"obstacles", smallest.document.test_case.obstacles.size()},
          {"k", verified.failures},
          {"n", verified.runs},
          {"file", smallest.file}};
}

}  // namespace

Table DistinctFailuresTable(const std::vector<DistinctFailure>& failures, const std::string& program,
                            const std::function<std::string(RunId)>& link) {
  const auto linked = [&](Cell cell, RunId run) { return LinkCell(std::move(cell), link ? link(run) : ""); };
  Table table({{">"},
               {"toughest"},
               {">fails", "k n"},
               OnPages(">probability (95 %)", "interval"),
               {">cases", "cases"},
               {"what happens", "what"},
               {">smallest", "smallest"},
               OnPages("confirmed", "confirmed"),
               ForPrograms("example"),
               OnTerminals("to see it")});
  for (const DistinctFailure& failure : failures) {
    const Confirmation& toughest = *failure.cases.front();
    const Confirmation::Example& example = *toughest.example;
    const SmallestLayout* smallest = failure.smallest;
    Json cases = Json::array();
    for (const Confirmation* one : failure.cases) cases.push_back(one->name);
    const Cell left = smallest == nullptr
                          ? Cell()
                          : linked(JsonCell(SmallestJson(*smallest),
                                            fmt::format("{}", smallest->document.test_case.obstacles.size())),
                                   smallest->run);
    table.AddRow({table.size() + 1, linked(toughest.name, toughest.run),
                  OutOfCell(toughest.tally.failures, toughest.tally.runs()), PercentCell(toughest.interval),
                  JsonCell(std::move(cases), fmt::format("{}", failure.cases.size())), failure.what, left,
                  failure.confirmed, JsonCell({{"campaign", example.campaign}, {"run", example.run}}),
                  fmt::format("{} replay {} {} --svg failure-{}.svg", program, PastedPath(example.campaign),
                              example.run, table.size() + 1)});
  }
  return table;
}

Section TellDistinctFailures(const CampaignAnswers& answers, std::size_t most, const std::string& program,
                             const std::function<std::string(RunId)>& link) {
  if (answers.confirmations.empty()) return {};
  const auto failures = DistinctFailures(answers.confirmations, answers.smallest_layouts);
  const auto confirmed = std::ranges::count(failures, true, &DistinctFailure::confirmed);
  const std::size_t cases = answers.confirmations.size();
  if (failures.empty())
    return {.title = fmt::format("No distinct failure: none of {} cases failed with fresh seeds", cases)};
  Section section{.title = fmt::format("{} distinct failure{} ({} confirmed) in {} cases with fresh seeds",
                                       failures.size(), failures.size() == 1 ? "" : "s", confirmed, cases),
                  .table = DistinctFailuresTable(failures, program, link).First(most)};
  if (failures.size() > most)
    section.sentences.push_back(fmt::format("and {} more; see show --json", failures.size() - most));
  return section;
}

}  // namespace gauntlet
