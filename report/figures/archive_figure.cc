#include "report/figures/archive_figure.h"

#include <fmt/format.h>

#include "analysis/tables/table.h"
#include "base/number_text.h"
#include "controllers/registry.h"
#include "report/tables/summary_tables.h"
#include "search/archive/failure_archive.h"
#include "search/search_setup.h"

namespace gauntlet {
namespace {

constexpr const char* kTitle = "The fewest obstacles that break the swarm";

analysis::LayoutGrid GridOf(const SearchSummary& summary, const Experiment& experiment) {
  const ArchiveView& archive = summary.archive;
  analysis::LayoutGrid grid{
      .title = kTitle,
      .outcome = fmt::format(
          "{} of {} cells hold a failure that repeats; below each, in how many of its runs it came",
          archive.failures.size(), CellsOf(archive)),
      .across_name = archive.axes[0].metric,
      .up_name = archive.axes[1].metric,
      .columns = {},
      .rows = {},
      .arena = EmptyArena(experiment.arena),
      .layouts = {}};
  for (int part = 0; part < archive.axes[0].parts; ++part) {
    grid.columns.push_back(RangeText(archive.axes[0], part));
  }
  for (int part = 0; part < archive.axes[1].parts; ++part) {
    grid.rows.push_back(RangeText(archive.axes[1], part));
  }
  const bool places = controllers::DeclaredScenario(experiment).failures.ArePlaces(archive.axes);
  for (const ArchivedFailure& failure : archive.failures) {
    analysis::GridLayout& layout = grid.layouts.emplace_back();
    layout.column = static_cast<std::size_t>(failure.cell[0]);
    layout.row = static_cast<std::size_t>(failure.cell[1]);
    layout.obstacles = MemberOf(summary, failure).genome;
    layout.caption = fmt::format("{}: {} of {}", Counted(layout.obstacles.size(), "obstacle"),
                                 failure.failures, failure.runs);
    if (places) layout.place = sim::Vec2(failure.middle[0], failure.middle[1]);
  }
  return grid;
}

std::string CsvOf(const SearchSummary& summary) {
  const ArchiveView& archive = summary.archive;
  Table table({"column", "row", "test case", "obstacles", "length_m", "failed", "runs",
               archive.axes[0].metric, archive.axes[1].metric});
  for (const ArchivedFailure& failure : archive.failures) {
    const LayoutSize size = SizeOf(MemberOf(summary, failure).genome);
    table.AddRow({failure.cell[0], failure.cell[1], failure.individual, size.obstacles, size.length,
                  failure.failures, failure.runs, failure.middle[0], failure.middle[1]});
  }
  return table.ToCsv();
}

}  // namespace

std::vector<NamedFigure> ArchiveFigures(const CampaignFacts& facts) {
  if (facts.summary.OnlySearch() == nullptr) return {};
  const SearchSummary& summary = *facts.summary.OnlySearch();
  if (summary.archive.axes.size() != 2 || summary.archive.failures.empty()) return {};
  const Experiment experiment = facts.plans.front().experiment;
  const std::string reading = fmt::format(
      "A cell for each way in which the swarm breaks, by two metrics of the runs; in it the arena with the "
      "{}, and in how many of its runs so far. A red spot is the place where the swarm broke, where the "
      "metrics are a place. These runs took part in choosing the layouts: 'gauntlet confirm --elites' "
      "simulates them with fresh seeds.",
      summary.archive.toughest ? "toughest layout that did it"
                               : "smallest layout that did it in 3 of 3 or 4 of 5 runs");
  return {{"archive", kTitle, reading, [=] { return analysis::DrawLayoutGrid(GridOf(summary, experiment)); },
           [=] { return CsvOf(summary); }}};
}

}  // namespace gauntlet
