#include "report/tables/distinct_failures.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

Json SmallestJson(const SmallestLayout& smallest) {
  const proto::CaseFailures& verified = smallest.document.lineage->verified;
  return {{"case", fmt::format("run {}", proto::RunText(smallest.run))},
          {"obstacles", smallest.document.test_case.obstacles.size()},
          {"k", verified.failures},
          {"n", verified.runs},
          {"file", smallest.file}};
}

Section TellGrouping(const FailureGrouping& grouping, int told, std::size_t most, const std::string& program,
                     const std::function<std::string(RunId)>& link) {
  if (!grouping.overall)
    return {.title = fmt::format("{} is not known of these failures", grouping.title),
            .sentences = {grouping.unknown}};
  const std::string agreement =
      grouping.agreement
          ? fmt::format(
                "Failed runs of one case agree in it by {:.2f} (kappa: 0 = no more often than runs of "
                "different cases, 1 = always)",
                std::max(0.0, *grouping.agreement))
          : "How well it repeats is not known: there is one case, or all failed runs are alike in it";
  if (!grouping.Used())
    return {.title = fmt::format("{} does not tell these failures apart", grouping.title),
            .sentences = {fmt::format("{}, which takes {} at least.", agreement, kLeastAgreement),
                          fmt::format("Most frequent: {}, in {} of {} failed runs.", grouping.overall->value,
                                      grouping.overall->runs, grouping.overall->of)}};
  std::vector<const DistinctFailure*> groups;
  for (const DistinctFailure& one : grouping.groups) groups.push_back(&one);
  Section section{.title = fmt::format("{} by {}, in {} with {} failed runs or more",
                                       Counted(groups.size(), "distinct failure"), grouping.phrase,
                                       Counted(static_cast<std::uint64_t>(told), "case"), kRunsForGroup),
                  .table = DistinctFailuresTable(groups, program, link).First(most)};
  if (groups.size() > most)
    section.sentences.push_back(fmt::format("and {} more; see show --json", groups.size() - most));
  if (grouping.mixed > 0)
    section.sentences.push_back(
        fmt::format("Mixed, and not counted: {} whose failed runs do not mostly agree.",
                    Counted(static_cast<std::uint64_t>(grouping.mixed), "case")));
  section.sentences.push_back(agreement + ".");
  return section;
}

// Of which it cannot be told what failure they are.
Section TellTooFew(const CampaignAnswers& answers, const DistinctFailures& distinct, std::size_t most) {
  if (distinct.too_few == 0) return {};
  Section section{
      .title = fmt::format("{} of {} too few failed runs to say which failure {} is", distinct.too_few,
                           Counted(static_cast<std::uint64_t>(distinct.failing), "case") +
                               " that failed again " + (distinct.failing == 1 ? "has" : "have"),
                           distinct.too_few == 1 ? "it" : "each"),
      .sentences = {fmt::format("It takes {}. `gauntlet confirm` with --replicates 20, or with more "
                                "where they seldom fail, simulates more of them.",
                                kRunsForGroup)}};
  if (distinct.too_few < distinct.failing) return section;
  std::vector<Confirmation> toughest = answers.confirmations;
  std::erase_if(toughest, [](const Confirmation& one) { return one.failed.empty(); });
  std::ranges::stable_sort(toughest, std::greater(), Toughness);
  section.table = ConfirmationsTable(toughest).First(most);
  if (toughest.size() > most)
    section.sentences.push_back(fmt::format("and {} more; see show --json", toughest.size() - most));
  return section;
}

}  // namespace

Table DistinctFailuresTable(const std::vector<const DistinctFailure*>& failures, const std::string& program,
                            const std::function<std::string(RunId)>& link) {
  const auto linked = [&](Cell cell, RunId run) { return LinkCell(std::move(cell), link ? link(run) : ""); };
  Table table({{">"},
               ForPrograms("feature"),
               {"failure", "name"},
               {">cases", "cases"},
               {">share", "share"},
               {">of their failed runs", "confidence"},
               {"toughest"},
               ForPrograms("run"),
               {">fails", "k n"},
               OnPages(">probability (95 %)", "interval"),
               {">smallest", "smallest"},
               OnPages("confirmed", "confirmed"),
               ForPrograms("example"),
               OnTerminals("to see it")});
  for (const DistinctFailure* failure : failures) {
    const Confirmation& toughest = *failure->cases.front();
    const SmallestLayout* smallest = failure->smallest;
    Json cases = Json::array();
    for (const Confirmation* one : failure->cases) cases.push_back(one->name);
    const Cell left = smallest == nullptr
                          ? Cell()
                          : linked(JsonCell(SmallestJson(*smallest),
                                            fmt::format("{}", smallest->document.test_case.obstacles.size())),
                                   smallest->run);
    const double confidence = static_cast<double>(failure->agreeing_runs) / failure->failed_runs;
    table.AddRow({table.size() + 1, failure->feature, failure->name,
                  JsonCell(std::move(cases), fmt::format("{}", failure->cases.size())),
                  Cell(fmt::format("{:.0f} %", 100.0 * failure->share), failure->share),
                  Cell(fmt::format("{} of {}", failure->agreeing_runs, failure->failed_runs), confidence),
                  linked(toughest.name, toughest.run), toughest.run > 0 ? Cell(toughest.run) : Cell(),
                  OutOfCell(toughest.tally.failures, toughest.tally.runs()), PercentCell(toughest.interval),
                  left, failure->Confirmed(),
                  JsonCell({{"campaign", toughest.campaign}, {"run", failure->typical->id}}),
                  fmt::format("{} replay {} {} --svg {}-{}.svg", program, PastedPath(toughest.campaign),
                              failure->typical->id, failure->feature, table.size() + 1)});
  }
  return table;
}

Table FailureGroupingsTable(const DistinctFailures& distinct) {
  Table table({ForPrograms("feature"), ForPrograms("agreement"), ForPrograms("used"), ForPrograms("distinct"),
               ForPrograms("mixed")});
  for (const FailureGrouping& one : distinct.groupings)
    table.AddRow({one.feature, one.agreement ? Cell(*one.agreement) : Cell(), one.Used(), one.groups.size(),
                  one.mixed});
  return table;
}

std::vector<Section> TellDistinctFailures(const CampaignAnswers& answers, std::size_t most,
                                          const std::string& program,
                                          const std::function<std::string(RunId)>& link) {
  if (answers.confirmations.empty()) return {};
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  if (distinct.failing == 0)
    return {{.title = fmt::format("No distinct failure: with fresh seeds no run of {} failed",
                                  Counted(answers.confirmations.size(), "case"))}};
  std::vector<Section> sections;
  if (const int told = distinct.failing - distinct.too_few; told > 0) {
    for (const FailureGrouping& one : distinct.groupings)
      sections.push_back(TellGrouping(one, told, most, program, link));
  }
  if (Section few = TellTooFew(answers, distinct, most); !few.title.empty())
    sections.push_back(std::move(few));
  return sections;
}

}  // namespace gauntlet
