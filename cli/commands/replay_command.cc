// gauntlet replay: one stored run again, checked against its hash, and drawn.
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "analysis/figures/run/run_figure.h"
#include "analysis/figures/run/trajectory_csv.h"
#include "analysis/tables/table.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "cli/output/summary.h"
#include "cli/run_campaign.h"
#include "master/campaign/verdict_text.h"
#include "proto/run_text.h"
#include "report/figures/replayed_figure.h"
#include "sim/robot/disturbances.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

struct ReplayOptions {
  std::string directory;
  std::string run;
  std::string svg;
  std::string timeline;
  std::string csv;
  std::string scratch;
  bool json = false;
};

bool SameFile(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::absolute(a, error).lexically_normal() == fs::absolute(b, error).lexically_normal();
}

// Two outputs in one file would leave only the later one.
Status CheckOwnFiles(const ReplayOptions& options) {
  const std::pair<const char*, const std::string&> files[] = {
      {"--svg", options.svg}, {"--timeline", options.timeline}, {"--csv", options.csv}};
  for (std::size_t i = 0; i < std::size(files); ++i) {
    for (std::size_t j = i + 1; j < std::size(files); ++j) {
      if (files[i].second.empty() || files[j].second.empty()) continue;
      if (!SameFile(files[i].second, files[j].second)) continue;
      return InvalidInput(fmt::format("{} and {} are both {}: give each its own file", files[i].first,
                                      files[j].first, files[i].second));
    }
  }
  return Ok{};
}

std::string Text(const CampaignReplay& replay, const analysis::RunFigure& figure) {
  const ReplayReport& report = replay.report;
  const bool same = report.differences.empty();
  Table table({"", ""});
  table.AddRow(
      {"test case", fmt::format("{} (generation {})", report.stored.individual, report.stored.generation)});
  if (const std::string& name = report.spec.test_case.name; !name.empty()) {
    table.AddRow({"its name", Printable(name)});
  }
  table.AddRow({"seed", fmt::format("{}", report.spec.seed)});
  for (const auto& [key, value] : sim::DisturbanceTexts(report.spec.disturbances)) table.AddRow({key, value});
  table.AddRow({"outcome", analysis::DescribeOutcome(figure)});
  if (report.replayed.verdict == sim::Verdict::kCompleted) {
    table.AddRow({"fitness", fmt::format("{:.6f}", report.replayed.fitness)});
    for (const auto& [name, text] : figure.metrics) table.AddRow({name, text});
  } else {
    table.AddRow({"verdict", std::string(NameOf(report.replayed.verdict))});
  }
  if (!report.replayed.failure.label.empty()) {
    table.AddRow(
        {"failure type", fmt::format("{}: {}", report.replayed.failure.type, report.replayed.failure.label)});
  }
  table.AddRow({"stored hash", fmt::format("{:016x}", report.stored_result.hash)});
  table.AddRow(
      {"new hash", fmt::format("{:016x}{}", report.replayed.hash, same ? "  (the same)" : "  (DIFFERENT)")});
  std::string text = fmt::format("{}, run {}: {}\n\n", replay.experiment.name,
                                 proto::RunText(report.stored.id), same ? "reproduced" : "NOT REPRODUCED") +
                     table.ToText();
  if (!same) {
    text += "\nWhat differs\n";
    for (const std::string& difference : report.differences) text += "  " + difference + "\n";
  }
  return text;
}

// kExitNegative when the run is not reproduced or does not read back.
Result<ExitCode> RunReplay(CommandContext& context, const ReplayOptions& options) {
  TRY(const std::uint64_t run, ParseRunId(options.run));
  TRY(CheckOwnFiles(options));
  TRY(const CampaignReplay replay, context.campaigns.Replay(options.directory, run, options.scratch));
  PrintAsOf(context, options.directory, replay.as_of);
  if (!replay.report.damage.empty()) {  // what does not read back did not reproduce
    PrintMessage(context, replay.report.damage);
    return kExitNegative;
  }
  const analysis::RunFigure figure = FigureOf(replay.experiment.name, replay.report);
  if (!options.timeline.empty() && !analysis::HasTimeline(figure)) {
    return InvalidInput(
        fmt::format("--timeline: runs of {} do not say what their robots did when", figure.spec.scenario));
  }
  const std::pair<const std::string&, std::function<std::string()>> outputs[] = {
      {options.svg, [&] { return analysis::DrawRun(figure); }},
      {options.timeline, [&] { return analysis::DrawTimeline(figure); }},
      {options.csv, [&] { return analysis::WriteTrajectoryCsv(figure.result.trajectory); }}};
  for (const auto& [path, content] : outputs) {
    if (path.empty()) continue;
    TRY(WriteOutputFile(path, content()));
    PrintMessage(context, fmt::format("wrote {}", path));
  }
  context.out << (options.json ? ReplayJson(replay.report) : Text(replay, figure)) << std::flush;
  if (replay.report.differences.empty()) return kExitDone;
  const bool may_differ =
      replay.reproducible == Reproducible::kUnknown || replay.reproducible == Reproducible::kNo;
  PrintMessage(context,
               fmt::format("run {} of {} was not reproduced{}: {}", proto::RunText(run), options.directory,
                           may_differ ? ", and its program is not known to be reproducible" : "",
                           replay.report.differences.front()));
  return kExitNegative;
}

}  // namespace

void AddReplay(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("replay", "simulate one stored run again, check its hash and draw it", RunReplay);
  AddDirectory(command, options.directory);
  command
      .add_option(
          "RUN_ID", options.run,
          "number of the run, as 'show' prints it: RUN, or SEARCH:RUN where there are several searches")
      ->required();
  AddValue(command, "--svg", "F", options.svg,
           "draw the arena, the trajectory of every robot, and where the swarm split");
  AddValue(command, "--timeline", "F", options.timeline,
           "draw the state of every robot over time (foraging, task-partitioning)");
  AddValue(command, "--csv", "F", options.csv, "write the pose of every robot in every tick");
  AddValue(command, "--scratch", "DIR", options.scratch,
           "working directory for the run of a plug-in; keeps what the run writes, and in output.txt what it "
           "prints");
  command.add_flag("--json", options.json, "print the result as one JSON document");
  command.footer(
      R"(The same run must give the same bits. The exit code is 0 when the new hash equals the stored one, and 1 when it
does not; then the differences are printed.

Example:
  gauntlet replay campaigns/flocking-20260131T120000Z 812 --svg run-812.svg --csv run-812.csv)");
}

}  // namespace gauntlet
