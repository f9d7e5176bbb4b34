#include "report/tables/exported_tables.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "master/dispatch/pool/worker_program.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "report/tables/run_table.h"
#include "report/tables/search_columns.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet {
namespace {

const std::vector<DataColumn> kCaseColumns = {
    {"individual", "", "number of the test case within its search"},
    {"birth_generation", "", "generation in which it was born, from 1"},
    {"parents", "", "numbers of its parents, separated by spaces"},
    {"name", "", "name of a given case, which is that of its file"},
    {"obstacle", "", "number of the obstacle within the case, from 1; empty in a case without obstacles"},
    {"x", "m", "of the obstacle's centre, from the middle of the arena"},
    {"y", "m", "of the obstacle's centre"},
    {"length", "m", ""},
    {"width", "m", ""},
    {"orientation_deg", "degrees", "counter-clockwise"},
    {"speed", "m/s", "of a moving obstacle"},
    {"path", "m", "of a moving obstacle: x and y of each point of its path, separated by spaces"},
    {"light", "", "colour of the lamps that it carries"}};

const std::vector<DataColumn> kTrajectoryColumns = {
    {"run", "", "number of the run within the campaign: `id` of the runs"},
    {"robot", "", "number of the robot, from 0"},
    {"time", "s", "simulated time, every 5 s"},
    {"x", "m", "position, from the middle of the arena"},
    {"y", "m", "position"}};

const std::vector<DataColumn> kEventColumns = {{"time", "", "UTC, ISO 8601"},
                                               {"kind", "", "what happened, in one word"},
                                               {"text", "", "what happened, in a sentence"}};

// Visits the runs that were asked for, in logical order, until `visit` gives an error, which is returned.
Status ForEachChosen(const StoredCampaign& campaign, const std::set<RunId>& chosen, const RunVisitor& visit) {
  SqliteStore& store = *campaign.view.store;
  for (const RunId id : chosen) {
    TRY(const auto run, store.LoadRun(id));
    if (!run.has_value())
      return Error{ErrorKind::kNotFound,
                   fmt::format("there is no run {} in this campaign", proto::RunText(id))};
    TRY(visit(*run));
  }
  if (!chosen.empty()) return Ok{};
  for (SearchId search = 1; search <= campaign.plans.size(); ++search) {
    TRY(store.ForEachRun(search, 0, visit));
  }
  return Ok{};
}

Status WriteRuns(const StoredCampaign& campaign, const std::set<RunId>& chosen, const RunTable& runs,
                 DataTable& table) {
  return ForEachChosen(campaign, chosen, [&](const StoredRun& run) -> Status {
    TRY(const auto row, runs.Row(run));
    return table.AddRow(row);
  });
}

std::vector<Value> ObstacleCells(const sim::ObstacleGene& gene, std::size_t number) {
  std::string path;
  for (const sim::Vec2& point : gene.path)
    path += fmt::format("{}{} {}", path.empty() ? "" : " ", point.x(), point.y());
  return {std::uint64_t{number},
          gene.x,
          gene.y,
          gene.length,
          gene.width,
          gene.orientation_deg,
          gene.Moves() ? Value(gene.speed) : Value(),
          gene.Moves() ? Value(path) : Value(),
          gene.Lit() ? Value(std::string(sim::NameOf(gene.light))) : Value()};
}

Status WriteCases(const StoredCampaign& campaign, const SearchColumns& searches, DataTable& table) {
  for (SearchId search = 1; search <= campaign.plans.size(); ++search) {
    TRY(const auto individuals, campaign.view.store->LoadIndividuals(search));
    for (const Individual& individual : individuals) {
      std::vector<Value> of_case = searches.CellsOf(search);
      of_case.insert(of_case.end(), {individual.id, std::uint64_t{individual.birth_generation},
                                     TextValue(fmt::format("{}", fmt::join(individual.parents, " "))),
                                     TextValue(individual.test_case.name)});
      const sim::Genome& obstacles = individual.test_case.obstacles;
      for (std::size_t i = 0; i < std::max<std::size_t>(obstacles.size(), 1); ++i) {
        std::vector<Value> row = of_case;
        if (i < obstacles.size()) {
          const std::vector<Value> obstacle = ObstacleCells(obstacles[i], i + 1);
          row.insert(row.end(), obstacle.begin(), obstacle.end());
        }
        row.resize(searches.columns().size() + kCaseColumns.size());
        TRY(table.AddRow(row));
      }
    }
  }
  return Ok{};
}

// The run's result with the robots' trajectories.
Result<sim::RunResult> WithWays(const StoredRun& run, std::uint64_t& simulated) {
  Result<sim::RunResult> stored = proto::DecodeStoredResult(run.result);
  if (!stored || stored->verdict != sim::Verdict::kCompleted) return stored;
  if (!stored->robots.empty() && !stored->robots.front().waypoints.empty()) return stored;
  TRY(const auto spec, proto::DecodeRunSpec(run.spec));
  TRY(auto again, SimulateInRunner(spec));
  if (again.hash != run.hash)
    return Error{ErrorKind::kCorrupt, "it does not end as it did; `gauntlet replay` says what differs"};
  ++simulated;
  return again;
}

Status WriteTrajectories(const StoredCampaign& campaign, const std::set<RunId>& chosen, DataTable& table,
                         std::uint64_t& simulated) {
  return ForEachChosen(campaign, chosen, [&](const StoredRun& run) -> Status {
    const Result<sim::RunResult> result = WithWays(run, simulated);
    if (!result)
      return Error{result.error().kind,
                   fmt::format("run {}: {}", proto::RunText(run.id), result.error().message)};
    for (std::size_t robot = 0; robot < result->robots.size(); ++robot) {
      const std::vector<sim::Vec2>& way = result->robots[robot].waypoints;
      for (std::size_t i = 0; i < way.size(); ++i) {
        const double time = static_cast<double>(i * sim::kSummaryTicks) / sim::kTicksPerSecond;
        TRY(table.AddRow({run.id, std::uint64_t{robot}, time, way[i].x(), way[i].y()}));
      }
    }
    return Ok{};
  });
}

Status WriteEvents(const StoredCampaign& campaign, DataTable& table) {
  TRY(const auto events, campaign.view.store->LoadEvents());
  for (const StoredEvent& event : events) {
    const std::string time =
        fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(event.unix_ms / 1000), event.unix_ms % 1000);
    TRY(table.AddRow({time, event.kind, event.text}));
  }
  return Ok{};
}

std::vector<DataColumn> Joined(std::vector<DataColumn> first, const std::vector<DataColumn>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

Result<ExportReport> WriteTable(const StoredCampaign& campaign, const ExportOptions& options,
                                const std::string& head, const Sink& sink) {
  ExportReport report;
  const auto write = [&](const char* name, const std::vector<DataColumn>& columns,
                         const std::function<Status(DataTable&)>& rows) -> Result<ExportReport> {
    DataTable table(options.format, columns, sink, head, name);
    TRY(rows(table));
    TRY(table.Finish());
    report.rows = table.rows();
    return report;
  };
  switch (options.what) {
    case Exported::kRuns: {
      TRY(const auto runs, RunTable::Make(campaign.plans, *campaign.view.store));
      return write("runs", runs.columns(),
                   [&](DataTable& table) { return WriteRuns(campaign, options.runs, runs, table); });
    }
    case Exported::kCases: {
      const SearchColumns searches(campaign.plans);
      return write("cases", Joined(searches.columns(), kCaseColumns),
                   [&](DataTable& table) { return WriteCases(campaign, searches, table); });
    }
    case Exported::kTrajectories:
      return write("trajectories", kTrajectoryColumns, [&](DataTable& table) {
        return WriteTrajectories(campaign, options.runs, table, report.simulated);
      });
    case Exported::kEvents:
      break;
  }
  return write("events", kEventColumns, [&](DataTable& table) { return WriteEvents(campaign, table); });
}

std::vector<DataColumn> CommonColumns(Exported what) {
  switch (what) {
    case Exported::kRuns: {
      const RunColumns runs = CommonRunColumns();
      return Joined(
          Joined(runs.before_metrics,
                 {{"...", "", "the scenario's metrics by their names: `gauntlet list scenarios NAME`"}}),
          runs.after_metrics);
    }
    case Exported::kCases:
      return Joined(CommonSearchColumns(), kCaseColumns);
    case Exported::kTrajectories:
      return kTrajectoryColumns;
    case Exported::kEvents:
      break;
  }
  return kEventColumns;
}

}  // namespace gauntlet
