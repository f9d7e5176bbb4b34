#include "cli/output/archive_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "analysis/tables/table.h"
#include "base/shell_quoted.h"
#include "report/tables/archive_cells.h"
#include "search/archive/failure_archive.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

// The second axis upwards, the first one to the right.
std::string Map(const CampaignSummary& summary) {
  const ArchiveView& archive = summary.archive;
  const CellAxis& across = archive.axes[0];
  const CellAxis& up = archive.axes[1];
  std::vector<Column> columns = {""};
  for (int x = 0; x < across.parts; ++x) columns.emplace_back(">" + RangeText(across, x));
  Table table(columns);
  for (int y = up.parts - 1; y >= 0; --y) {
    std::vector<Cell> row = {RangeText(up, y)};
    for (int x = 0; x < across.parts; ++x) {
      const auto here = std::ranges::find(archive.failures, std::vector<int>{x, y}, &ArchivedFailure::cell);
      row.push_back(here == archive.failures.end() ? Cell(".") : MemberOf(summary, *here).genome.size());
    }
    table.AddRow(row);
  }
  return fmt::format("\nThe fewest obstacles that break the swarm, by {} (to the right) and {} (upwards)\n{}",
                     across.metric, up.metric, table.ToText());
}

// What was tried in vain.
std::string NothingFound(const CampaignSummary& summary) {
  const std::uint64_t failed = summary.failing.empty() ? summary.total_failures : summary.failing_runs;
  std::string text = fmt::format(
      "\nNothing fails reliably: none of {} test cases failed in 3 of 3 or 4 of 5 runs. {} of {} runs "
      "failed.",
      FormatCount(summary.distinct_individuals), FormatCount(failed), FormatCount(summary.runs_done));
  std::string separator = " The runs went to";
  const auto tried = [&](const char* statistic, const char* what) {
    const auto found =
        std::ranges::find(summary.statistics, statistic, &std::pair<std::string, double>::first);
    if (found == summary.statistics.end() || found->second == 0.0) return;
    text +=
        fmt::format("{} {} ({})", separator, what, FormatCount(static_cast<std::uint64_t>(found->second)));
    separator = ",";
  };
  tried("random_runs", "random cases");
  tried("alone_runs", "single obstacles in the way");
  tried("nearest_runs", "parts of cases that had failed once");
  return text +
         ".\nMore runs (`gauntlet resume DIR --set search.runs=N`) or more obstacles (genome.genes) may find "
         "something.\n";
}

// A row for each of these failures; `replay`: how its command begins.
Table FailuresTable(const CampaignSummary& summary, const std::vector<ArchivedFailure>& failures,
                    const std::string& replay = "") {
  std::vector<Column> columns = {ForPrograms("cell"),         {">test case", "individual"},
                                 {">obstacles", "obstacles"}, {">length [m]", "length"},
                                 {">failed", "k n"},          ForPrograms("interval"),
                                 ForPrograms("middle")};
  for (const CellAxis& axis : summary.archive.axes) columns.emplace_back(">" + axis.metric);
  columns.insert(columns.end(), {{">run", "run"}, {""}});
  Table table(columns);
  for (const ArchivedFailure& failure : failures) {
    const PopulationMember& member = MemberOf(summary, failure);
    const LayoutSize size = SizeOf(member.genome);
    std::vector<Cell> row = {JsonCell(failure.cell),
                             failure.individual,
                             size.obstacles,
                             DecimalCell(size.length, 1),
                             OutOfCell(failure.failures, failure.runs),
                             PercentCell(analysis::WilsonInterval(
                                 static_cast<std::uint32_t>(failure.failures),
                                 static_cast<std::uint32_t>(failure.runs), analysis::kConfidence)),
                             JsonCell(failure.middle)};
    for (const double value : failure.middle) row.push_back(DecimalCell(value, 2));
    const RunId run = member.runs.empty() ? 0 : member.runs.front();
    row.push_back(run == 0 ? Cell() : run);
    row.emplace_back(fmt::format("{} {} --svg case-{}.svg", replay, run, failure.individual));
    table.AddRow(row);
  }
  return table;
}

}  // namespace

std::string ArchiveText(const CampaignSummary& summary, const HintContext& context) {
  const ArchiveView& archive = summary.archive;
  if (archive.axes.empty()) return {};
  if (archive.failures.empty()) {
    return NothingFound(summary);
  }
  const std::string map = archive.axes.size() == 2 ? Map(summary) : "";
  return map +
         fmt::format("\n{} of {} cells hold a failure; the smallest of each, fewest obstacles first\n",
                     archive.failures.size(), CellsOf(archive)) +
         FailuresTable(summary, BySize(summary),
                       fmt::format("{} replay {}", context.program, PastedPath(context.directory)))
             .ToText() +
         "  The runs that failed took part in choosing these cases; `gauntlet confirm` simulates them "
         "anew.\n";
}

Json ArchiveJson(const CampaignSummary& summary) {
  const ArchiveView& archive = summary.archive;
  if (archive.axes.empty()) return {};
  Json descriptors = Json::array();
  for (const CellAxis& axis : archive.axes) {
    descriptors.push_back(
        {{"metric", axis.metric}, {"min", axis.min}, {"max", axis.max}, {"parts", axis.parts}});
  }
  return {{"descriptors", std::move(descriptors)},
          {"cells", CellsOf(archive)},
          {"filled", archive.failures.size()},
          {"elites", FailuresTable(summary, archive.failures).ToJson()}};
}

}  // namespace gauntlet
