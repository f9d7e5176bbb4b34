// gauntlet study: searches, re-simulations and comparisons that belong together, by one command.
#include <algorithm>
#include <ctime>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "master/cli/commands.h"
#include "master/cli/output_file.h"
#include "master/cli/run_campaign.h"
#include "master/cli/study_output.h"
#include "master/cli/study_run.h"
#include "master/cli/table.h"
#include "master/cli/tuning_output.h"
#include "master/report/forecast.h"
#include "master/study/study_report.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

namespace fs = std::filesystem;

struct StudyOptions {
  std::string study;
  std::string directory;
  std::string markdown;
  bool dry_run = false;
  RunningOptions running;
};

// Makes the stage's campaign under another name first, so that one with this name is whole.
Status MakeStage(CommandContext& context, const Study& study, const std::string& dir, StudyStage stage) {
  const Result<std::vector<SearchPlan>> plans =
      stage == StudyStage::kSearches ? PlanSearchStage(study) : PlanEvaluationStage(study, dir);
  if (!plans) return plans.error();
  const std::string unfinished = UnfinishedCampaignOf(dir, stage);
  std::error_code error;
  fs::remove_all(unfinished, error);
  if (Status prepared = context.campaigns.Prepare(unfinished, *plans, ""); !prepared) return prepared;
  fs::rename(unfinished, CampaignOf(dir, stage), error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", unfinished, error.message())};
  return SyncDirectory(dir);
}

ExitCode RunStage(CommandContext& context, const Study& study, const StudyRun& run, StudyStage stage,
                  int workers) {
  Result<StageState> state = LookAtStage(study, run.directory, stage);
  if (!state) return Fail(context, state.error());
  if (!state->exists) {
    if (Status made = MakeStage(context, study, run.directory, stage); !made)
      return Fail(context, made.error());
  }
  if (state->finished) return kExitDone;
  CampaignRun campaign;
  campaign.directory = CampaignOf(run.directory, stage);
  campaign.resumed_by = run.directory;
  campaign.announcement = fmt::format("{}: {}, {} worker{}, in {}", study.name,
                                      stage == StudyStage::kSearches ? "searches" : "re-simulations", workers,
                                      workers == 1 ? "" : "s", campaign.directory);
  campaign.serving = run.running;
  campaign.session.workers = workers;
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Resume(campaign.directory, session);
  };
  campaign.report = [](const SessionReport&) -> Status { return Ok{}; };
  return RunCampaign(context, campaign);
}

ExitCode PrintForecast(CommandContext& context, const Study& study, const RunningOptions& running) {
  const Result<int> workers = ParseWorkers(running.workers);
  if (!workers) return Fail(context, workers.error());
  Table table({"part", ">searches", ">runs", ">cases, at most", ">ms per run", ">time", ">disk, MB"});
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  Forecast all;
  double seconds = 0.0;
  for (const StudyPart& part : study.parts) {
    const std::vector<SearchPlan> plans = ForecastPlans(study, part);
    const Result<Forecast> forecast = MakeForecast(plans);
    if (!forecast) return Fail(context, forecast.error());
    const bool again = StageOf(part) == StudyStage::kEvaluations;
    all.runs += forecast->runs;
    all.cases += again ? 0 : forecast->cases;
    all.bytes += forecast->bytes;
    seconds += forecast->Seconds(*workers);
    table.AddRow({part.name, FormatCount(plans.size()), FormatCount(forecast->runs),
                  again ? "" : FormatCount(forecast->cases),
                  fmt::format("{:.1f}", 1e3 * forecast->seconds_per_run),
                  FormatDuration(forecast->Seconds(*workers)), fmt::format("{:.1f}", forecast->bytes / 1e6)});
    parts.push_back({{"part", part.name},
                     {"searches", plans.size()},
                     {"runs", forecast->runs},
                     {"cases", again ? 0 : forecast->cases},
                     {"seconds", forecast->Seconds(*workers)},
                     {"bytes", forecast->bytes}});
  }
  table.AddRow({"all", "", FormatCount(all.runs), FormatCount(all.cases), "", FormatDuration(seconds),
                fmt::format("{:.1f}", all.bytes / 1e6)});
  if (running.json) {
    context.out << JsonText({{"study", study.name},
                             {"parts", std::move(parts)},
                             {"runs", all.runs},
                             {"cases", all.cases},
                             {"workers", *workers},
                             {"seconds", seconds},
                             {"bytes", all.bytes}})
                << std::flush;
  } else {
    context.out << fmt::format(
                       "{}: a dry run, nothing was made\n\n{}\n  Times are those of up to twelve of the "
                       "first runs of "
                       "each part, with {} worker{}; later runs may take longer or shorter.\n",
                       study.name, table.ToText(), *workers, *workers == 1 ? "" : "s")
                << std::flush;
  }
  return kExitDone;
}

ExitCode RunStudy(CommandContext& context, const StudyOptions& options) {
  const Result<Study> study = LoadStudy(options.study);
  if (!study) return Fail(context, study.error());
  return StartStudy(context, *study, {options.directory, options.running, options.markdown}, options.dry_run);
}

// Of each tuning two pictures, beside the study's campaigns.
Status WritePictures(CommandContext& context, const StudyReport& report, const StudyRun& run) {
  for (const StudySection& section : report.sections) {
    if (!section.tuning) continue;
    for (const auto& [name, picture] : TuningPictures(section)) {
      const std::string file = fmt::format("{}/{}.svg", run.directory, name);
      if (Status written = WriteOutputFile(file, picture); !written) return written;
      if (!run.running.quiet) PrintMessage(context, fmt::format("wrote {}", file));
    }
  }
  return Ok{};
}

}  // namespace

ExitCode StartStudy(CommandContext& context, const Study& study, StudyRun run, bool dry_run) {
  if (dry_run) return PrintForecast(context, study, run.running);
  if (run.directory.empty()) run.directory = DefaultDirectory(study.name, std::time(nullptr));
  if (Status begun = BeginStudy(run.directory, study); !begun) return Fail(context, begun.error());
  return RunStudyIn(context, study, run);
}

ExitCode RunStudyIn(CommandContext& context, const Study& study, const StudyRun& run) {
  const Result<int> workers = ParseWorkers(run.running.workers);
  if (!workers) return Fail(context, workers.error());
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    const ExitCode code = RunStage(context, study, run, stage, *workers);
    if (code != kExitDone) return code;
  }
  const Result<StudyReport> report = MakeStudyReport(study, run.directory);
  if (!report) return Fail(context, report.error());
  if (Status drawn = WritePictures(context, *report, run); !drawn) return Fail(context, drawn.error());
  if (!run.markdown.empty()) {
    if (Status written = WriteOutputFile(run.markdown, StudyMarkdown(*report)); !written)
      return Fail(context, written.error());
    PrintMessage(context, fmt::format("wrote {}", run.markdown));
  }
  context.out << (run.running.json ? StudyJson(*report, run.directory) : StudyText(*report)) << std::flush;
  return kExitDone;
}

void AddStudy(CommandParser& parser) {
  const auto [command, options] = parser.Add(
      "study", "many searches, re-simulations and comparisons, such as the whole thesis", RunStudy);
  command.add_option("STUDY", options.study, "a shipped study, or a TOML file")->required();
  AddValue(command, "--dir", "DIR", options.directory,
           "directory of the study: new, empty, or the study's own, in which case it goes on (default: "
           "campaigns/STUDY-<UTC time>)");
  AddValue(command, "--markdown", "F", options.markdown, "write the whole report as a Markdown page too");
  command.add_flag("--dry-run", options.dry_run,
                   "make nothing: say how many searches, runs and cases it will be, and what they cost here");
  AddRunningOptions(command, options.running);
  std::string shipped;
  for (const std::string& name : ShippedStudies()) shipped += (shipped.empty() ? "" : ", ") + name;
  command.footer(fmt::format(R"(Shipped studies: {}.

A study file lists parts (evolutions, random cases, and cases simulated again with fresh seeds or another
controller), what is computed from them, and the published figures beside it. All searches share the
workers, so no core waits at the end of a generation; then follow all re-simulations. They are ordinary
campaigns, DIR/searches and DIR/evaluations: 'show', 'replay' and 'compare' work on them. Killed or stopped
at any moment, it goes on with the same command, or with 'gauntlet resume DIR', and ends the same.

Examples:
  gauntlet study thesis-flocking --dir campaigns/flocking-study
  gauntlet study thesis --dry-run
  gauntlet study thesis --dir campaigns/thesis --markdown thesis.md --json > thesis.json)",
                             shipped));
}

}  // namespace gauntlet::master
