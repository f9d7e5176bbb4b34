#include "cli/output/archive_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "base/shell_quoted.h"
#include "cli/output/table.h"
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
  std::vector<std::string> head = {up.metric};
  for (int x = 0; x < across.parts; ++x) head.push_back(">" + RangeText(across, x));
  Table table(head);
  for (int y = up.parts - 1; y >= 0; --y) {
    std::vector<std::string> row = {RangeText(up, y)};
    for (int x = 0; x < across.parts; ++x) {
      const auto here = std::ranges::find(archive.failures, std::vector<int>{x, y}, &ArchivedFailure::cell);
      row.push_back(
          here == archive.failures.end() ? "." : fmt::format("{}", MemberOf(summary, *here).genome.size()));
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

}  // namespace

std::string ArchiveText(const CampaignSummary& summary, const HintContext& context) {
  const ArchiveView& archive = summary.archive;
  if (archive.axes.empty()) return {};
  if (archive.failures.empty()) {
    return NothingFound(summary);
  }
  std::vector<std::string> head = {">test case", ">obstacles", ">length [m]", ">failed"};
  for (const CellAxis& axis : archive.axes) head.push_back(">" + axis.metric);
  head.insert(head.end(), {">run", ""});
  Table table(head);
  for (const ArchivedFailure& failure : BySize(summary)) {
    const PopulationMember& member = MemberOf(summary, failure);
    const LayoutSize size = SizeOf(member.genome);
    std::vector<std::string> row = {fmt::format("{}", failure.individual), fmt::format("{}", size.obstacles),
                                    fmt::format("{:.1f}", size.length),
                                    fmt::format("{} of {}", failure.failures, failure.runs)};
    for (const double value : failure.middle) row.push_back(fmt::format("{:.2f}", value));
    const RunId run = member.runs.empty() ? 0 : member.runs.front();
    row.push_back(fmt::format("{}", run));
    row.push_back(fmt::format("{} replay {} {} --svg case-{}.svg", context.program,
                              PastedPath(context.directory), run, failure.individual));
    table.AddRow(row);
  }
  const std::string map = archive.axes.size() == 2 ? Map(summary) : "";
  return map +
         fmt::format("\n{} of {} cells hold a failure; the smallest of each, fewest obstacles first\n",
                     archive.failures.size(), CellsOf(archive)) +
         table.ToText() +
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
  Json elites = Json::array();
  for (const ArchivedFailure& failure : archive.failures) {
    const PopulationMember& member = MemberOf(summary, failure);
    const auto interval =
        analysis::WilsonInterval(static_cast<std::uint32_t>(failure.failures),
                                 static_cast<std::uint32_t>(failure.runs), analysis::kConfidence);
    elites.push_back({{"cell", failure.cell},
                      {"individual", failure.individual},
                      {"obstacles", member.genome.size()},
                      {"length", SizeOf(member.genome).length},
                      {"k", failure.failures},
                      {"n", failure.runs},
                      {"interval", {interval.low, interval.high}},
                      {"middle", failure.middle},
                      {"run", member.runs.empty() ? Json() : Json(member.runs.front())}});
  }
  return {{"descriptors", std::move(descriptors)},
          {"cells", CellsOf(archive)},
          {"filled", archive.failures.size()},
          {"elites", std::move(elites)}};
}

}  // namespace gauntlet
