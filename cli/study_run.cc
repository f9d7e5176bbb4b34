#include "cli/study_run.h"

#include <algorithm>
#include <ctime>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/duration_text.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "cli/output/output_file.h"
#include "cli/output/study_output.h"
#include "cli/run_campaign.h"
#include "cli/submitted_campaign.h"
#include "master/campaign/forecast.h"
#include "master/session/bind_endpoint.h"
#include "proto/json_text.h"
#include "report/figures/study_figures.h"
#include "study/study_report.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

// Makes the stage's campaign under another name first, so that one with this name is whole.
Status MakeStage(CommandContext& context, const Study& study, const StudyRun& run, StudyStage stage) {
  TRY(const std::vector<SearchPlan> plans, PlanStage(study, run.directory, stage));
  const std::string unfinished = UnfinishedCampaignOf(run.directory, stage);
  std::error_code error;
  fs::remove_all(unfinished, error);
  const std::string slurm =
      run.submitted == nullptr ? "" : slurm::WriteSlurmSettings(run.submitted->settings());
  TRY(context.campaigns.Prepare(unfinished, plans, slurm));
  fs::rename(unfinished, CampaignOf(run.directory, stage), error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", unfinished, error.message())};
  return SyncDirectory(run.directory);
}

std::string Announcement(const Study& study, const CampaignRun& campaign, StudyStage stage) {
  return fmt::format("{}: {}, {}, in {}", study.name,
                     stage == StudyStage::kSearches ? "searches" : "re-simulations", campaign.WorkersText(),
                     campaign.directory);
}

Result<ExitCode> RunStage(CommandContext& context, const Study& study, const StudyRun& run, StudyStage stage,
                          int workers) {
  TRY(const StageState state, LookAtStage(study, run.directory, stage));
  if (!state.exists) {
    TRY(MakeStage(context, study, run, stage));
  }
  if (state.finished) return kExitDone;
  CampaignRun campaign;
  campaign.directory = CampaignOf(run.directory, stage);
  campaign.resumed_by = run.directory;
  campaign.serving = run.running;
  campaign.session.workers = workers;
  if (run.submitted != nullptr) {
    TRY(campaign.jobs, slurm::SlurmCampaign::Make(run.submitted->settings(), campaign.directory));
    campaign.session.batch_job = run.batch_job;
  }
  campaign.announcement = Announcement(study, campaign, stage);
  campaign.run = [&](const SessionOptions& session) {
    return context.campaigns.Resume(campaign.directory, session);
  };
  campaign.report = [](const SessionReport&) -> Status { return Ok{}; };
  return RunCampaign(context, campaign);
}

Result<ExitCode> PrintForecast(CommandContext& context, const Study& study, const RunningOptions& running) {
  TRY(const int workers, ParseWorkers(running.workers));
  Table table({{"part", "part"},
               {">searches", "searches"},
               {">runs", "runs"},
               {">cases, at most", "cases"},
               {">ms per run"},
               {">time", "seconds"},
               {">disk, MB", "bytes"}});
  const auto megabytes = [](double bytes) { return Cell(fmt::format("{:.1f}", bytes / 1e6), bytes); };
  Forecast all;
  double seconds = 0.0;
  for (const StudyPart& part : study.parts) {
    const std::vector<SearchPlan> plans = ForecastPlans(study, part);
    TRY(const Forecast forecast, MakeForecast(plans));
    const bool again = StageOf(part) == StudyStage::kEvaluations;
    const double time = forecast.Seconds(workers);
    all.runs += forecast.runs;
    all.cases += again ? 0 : forecast.cases;
    all.bytes += forecast.bytes;
    seconds += time;
    table.AddRow({part.name, CountCell(plans.size()), CountCell(forecast.runs),
                  again ? Cell("", std::uint64_t{0}) : CountCell(forecast.cases),
                  DecimalCell(1e3 * forecast.seconds_per_run, 1), Cell(FormatDuration(time), time),
                  megabytes(forecast.bytes)});
  }
  if (running.json) {
    context.out << JsonText({{"study", study.name},
                             {"parts", table.ToJson()},
                             {"runs", all.runs},
                             {"cases", all.cases},
                             {"workers", workers},
                             {"seconds", seconds},
                             {"bytes", all.bytes}})
                << std::flush;
  } else {
    table.AddRow({"all", "", CountCell(all.runs), CountCell(all.cases), "", FormatDuration(seconds),
                  megabytes(all.bytes)});
    context.out << fmt::format(
                       "{}: a dry run, nothing was made\n\n{}\n  Times are those of up to twelve of the "
                       "first runs of "
                       "each part, with {}; later runs may take longer or shorter.\n",
                       study.name, table.ToText(), Counted(workers, "worker"))
                << std::flush;
  }
  return kExitDone;
}

// Of each tuning two pictures, beside the study's campaigns.
Status WritePictures(CommandContext& context, const StudyReport& report, const StudyRun& run) {
  for (const StudySection& section : report.sections) {
    if (!section.tuning) continue;
    for (const NamedFigure& figure : FiguresOf(report, section)) {
      const std::string file = fmt::format("{}/{}.svg", run.directory, figure.name);
      TRY(WriteOutputFile(file, figure.svg()));
      if (!run.running.quiet) PrintMessage(context, fmt::format("wrote {}", file));
    }
  }
  return Ok{};
}

Result<ExitCode> SubmitStudy(CommandContext& context, const Study& study, const StudyStartOptions& options,
                             const std::string& directory) {
  if (!options.markdown.empty() || !options.running.workers.empty()) {
    return InvalidInput(
        "--submit goes without --workers and --markdown: when the jobs have ended, the "
        "same command without --submit writes the page");
  }
  TRY(const slurm::SlurmSettings settings, ReadSlurmOptions(options.slurm, std::nullopt, study.name));
  TRY(const slurm::SlurmCampaign campaign, slurm::SlurmCampaign::Make(settings, directory));
  TRY(TestJobs(context, campaign, /*print=*/false));
  TRY(const std::optional<slurm::SlurmCampaign> before, slurm::SlurmCampaign::Find(directory));
  if (before.has_value()) {
    return InvalidInput(fmt::format("{} was submitted before; go on with: {} resume {}", directory,
                                    context.program, PastedPath(directory)));
  }
  TRY(BeginStudy(directory, study));
  TRY(WriteFileAtomically(directory + "/slurm.toml", slurm::WriteSlurmSettings(settings), kReadableByAll));
  if (settings.master == slurm::MasterPlace::kJob)
    return SubmitStudyJob(context, directory, campaign, options.running.json);
  return RunStudyIn(context, study, {directory, options.running, "", &campaign, ""});
}

}  // namespace

Result<ExitCode> SubmitStudyJob(CommandContext& context, const std::string& directory,
                                const slurm::SlurmCampaign& campaign, bool json) {
  TRY(const std::string job, SubmitMasterJob(context, directory, campaign));
  if (json) {
    context.out << JsonText({{"directory", directory}, {"job", job}});
  } else {
    context.out << fmt::format(
        "{0}: job {1} is the master\n\n  {2} status {3}/searches\n  {2} resume {3}    tells what came out, "
        "when "
        "it has ended\n",
        directory, job, context.program, PastedPath(directory));
  }
  context.out << std::flush;
  return kExitDone;
}

void AddStudyStartOptions(CLI::App& command, StudyStartOptions& options) {
  AddValue(command, "--dir", "DIR", options.directory,
           "directory of the study: new or empty, or that of this study, which then continues (default: "
           "campaigns/STUDY-<UTC time>)");
  AddValue(command, "--markdown", "F", options.markdown, "also write the whole report as a Markdown page");
  command.add_flag(
      "--dry-run", options.dry_run,
      "write nothing; print how many searches, runs and cases there would be, and what they would "
      "cost on this machine");
  command.add_flag(
      "--submit", options.submit,
      "run the workers, and by default the master, as jobs of a cluster ('gauntlet submit --help' "
      "lists the settings)");
  AddPluginOption(command, options.plugins);
  AddSlurmOptions(command, options.slurm);
  AddRunningOptions(command, options.running);
}

Result<ExitCode> StartStudy(CommandContext& context, const Study& study, const StudyStartOptions& options) {
  if (!options.submit && (!options.slurm.master.empty() || !options.slurm.settings.empty()))
    return InvalidInput("--master and --slurm are for --submit");
  const std::string directory =
      options.directory.empty() ? DefaultDirectory(study.name, std::time(nullptr)) : options.directory;
  if (options.dry_run) {
    if (options.submit) {
      TRY(const slurm::SlurmSettings settings, ReadSlurmOptions(options.slurm, std::nullopt, study.name));
      TRY(slurm::SlurmCampaign::Make(settings, directory));
    }
    return PrintForecast(context, study, options.running);
  }
  if (options.submit) return SubmitStudy(context, study, options, directory);
  TRY(BeginStudy(directory, study));
  return RunStudyIn(context, study, {directory, options.running, options.markdown, nullptr, ""});
}

Result<ExitCode> RunStudyIn(CommandContext& context, const Study& study, const StudyRun& run) {
  TRY(const int workers, ParseWorkers(run.running.workers));
  for (const StudyStage stage : {StudyStage::kSearches, StudyStage::kEvaluations}) {
    if (std::ranges::count(study.parts, stage, &StageOf) == 0) continue;
    TRY(const ExitCode code, RunStage(context, study, run, stage, workers));
    if (code != kExitDone) return code;
  }
  TRY(const StudyReport report, MakeStudyReport(study, run.directory));
  TRY(WritePictures(context, report, run));
  if (!run.markdown.empty()) {
    TRY(WriteOutputFile(run.markdown, StudyMarkdown(report)));
    PrintMessage(context, fmt::format("wrote {}", run.markdown));
  }
  context.out << (run.running.json ? StudyJson(report, run.directory) : StudyText(report)) << std::flush;
  return kExitDone;
}

}  // namespace gauntlet
