#include "cli/study_run.h"

#include <algorithm>
#include <ctime>
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/duration_text.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "cli/output/output_file.h"
#include "cli/output/study_output.h"
#include "cli/output/table.h"
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
  const Result<std::vector<SearchPlan>> plans =
      stage == StudyStage::kSearches ? PlanSearchStage(study) : PlanEvaluationStage(study, run.directory);
  if (!plans) return plans.error();
  const std::string unfinished = UnfinishedCampaignOf(run.directory, stage);
  std::error_code error;
  fs::remove_all(unfinished, error);
  const std::string slurm =
      run.submitted == nullptr ? "" : slurm::WriteSlurmSettings(run.submitted->settings());
  if (Status prepared = context.campaigns.Prepare(unfinished, *plans, slurm); !prepared) return prepared;
  fs::rename(unfinished, CampaignOf(run.directory, stage), error);
  if (error) return Error{ErrorKind::kIo, fmt::format("{}: {}", unfinished, error.message())};
  return SyncDirectory(run.directory);
}

std::string Announcement(const Study& study, const CampaignRun& campaign, const StudyRun& run,
                         StudyStage stage) {
  const int workers = campaign.session.workers;
  return fmt::format("{}: {}, {}, in {}", study.name,
                     stage == StudyStage::kSearches ? "searches" : "re-simulations",
                     run.submitted != nullptr ? std::string("workers from Slurm")
                                              : fmt::format("{} worker{}", workers, workers == 1 ? "" : "s"),
                     campaign.directory);
}

ExitCode RunStage(CommandContext& context, const Study& study, const StudyRun& run, StudyStage stage,
                  int workers) {
  Result<StageState> state = LookAtStage(study, run.directory, stage);
  if (!state) return Fail(context, state.error());
  if (!state->exists) {
    if (Status made = MakeStage(context, study, run, stage); !made) return Fail(context, made.error());
  }
  if (state->finished) return kExitDone;
  CampaignRun campaign;
  campaign.directory = CampaignOf(run.directory, stage);
  campaign.resumed_by = run.directory;
  campaign.serving = run.running;
  std::optional<slurm::SlurmCampaign> jobs;
  if (run.submitted == nullptr) {
    campaign.session.workers = workers;
  } else {
    Result<slurm::SlurmCampaign> made =
        slurm::SlurmCampaign::Make(run.submitted->settings(), campaign.directory);
    if (!made) return Fail(context, made.error());
    jobs = *std::move(made);
    campaign.bind.endpoint = jobs->settings().bind;
    campaign.session.workers = 0;
    campaign.session.batch_job = run.batch_job;
    campaign.session.make_pool = [&] { return jobs->MakePool(context.slurm()); };
  }
  campaign.announcement = Announcement(study, campaign, run, stage);
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

// Of each tuning two pictures, beside the study's campaigns.
Status WritePictures(CommandContext& context, const StudyReport& report, const StudyRun& run) {
  for (const StudySection& section : report.sections) {
    if (!section.tuning) continue;
    for (const NamedFigure& figure : FiguresOf(report, section)) {
      const std::string file = fmt::format("{}/{}.svg", run.directory, figure.name);
      if (Status written = WriteOutputFile(file, figure.svg()); !written) return written;
      if (!run.running.quiet) PrintMessage(context, fmt::format("wrote {}", file));
    }
  }
  return Ok{};
}

ExitCode SubmitStudy(CommandContext& context, const Study& study, const StudyStartOptions& options,
                     const std::string& directory) {
  if (!options.markdown.empty() || !options.running.workers.empty()) {
    return Fail(context,
                InvalidInput("--submit goes without --workers and --markdown: when the jobs have ended, the "
                             "same command without --submit writes the page"));
  }
  const Result<slurm::SlurmSettings> settings = ReadSlurmOptions(options.slurm, std::nullopt, study.name);
  if (!settings) return Fail(context, settings.error());
  const Result<slurm::SlurmCampaign> campaign = slurm::SlurmCampaign::Make(*settings, directory);
  if (!campaign) return Fail(context, campaign.error());
  if (Status possible = TestJobs(context, *campaign, /*print=*/false); !possible)
    return Fail(context, possible.error());
  const Result<std::optional<slurm::SlurmCampaign>> before = slurm::SlurmCampaign::Find(directory);
  if (!before) return Fail(context, before.error());
  if (before->has_value()) {
    return Fail(context, InvalidInput(fmt::format("{} was submitted before; go on with: {} resume {}",
                                                  directory, context.program, PastedPath(directory))));
  }
  if (Status begun = BeginStudy(directory, study); !begun) return Fail(context, begun.error());
  const Status kept =
      WriteFileAtomically(directory + "/slurm.toml", slurm::WriteSlurmSettings(*settings), kReadableByAll);
  if (!kept) return Fail(context, kept.error());
  if (settings->master == slurm::MasterPlace::kJob)
    return SubmitStudyJob(context, directory, *campaign, options.running.json);
  return RunStudyIn(context, study, {directory, options.running, "", &*campaign, ""});
}

}  // namespace

ExitCode SubmitStudyJob(CommandContext& context, const std::string& directory,
                        const slurm::SlurmCampaign& campaign, bool json) {
  const Result<std::string> job = SubmitMasterJob(context, directory, campaign);
  if (!job) return Fail(context, job.error());
  if (json) {
    context.out << JsonText({{"directory", directory}, {"job", *job}});
  } else {
    context.out << fmt::format(
        "{0}: job {1} is the master\n\n  {2} status {3}/searches\n  {2} resume {3}    tells what came out, "
        "when "
        "it has ended\n",
        directory, *job, context.program, PastedPath(directory));
  }
  context.out << std::flush;
  return kExitDone;
}

void AddStudyStartOptions(CLI::App& command, StudyStartOptions& options) {
  AddValue(command, "--dir", "DIR", options.directory,
           "directory of the study: new, empty, or the study's own, in which case it goes on (default: "
           "campaigns/STUDY-<UTC time>)");
  AddValue(command, "--markdown", "F", options.markdown, "write the whole report as a Markdown page too");
  command.add_flag("--dry-run", options.dry_run,
                   "make nothing: say how many searches, runs and cases it will be, and what they cost here");
  command.add_flag(
      "--submit", options.submit,
      "its workers, and by default its master, are jobs of a Slurm cluster ('gauntlet submit --help' "
      "lists the settings)");
  AddPluginOption(command, options.plugins);
  AddSlurmOptions(command, options.slurm);
  AddRunningOptions(command, options.running);
}

ExitCode StartStudy(CommandContext& context, const Study& study, const StudyStartOptions& options) {
  if (!options.submit && (!options.slurm.master.empty() || !options.slurm.settings.empty()))
    return Fail(context, InvalidInput("--master and --slurm are for --submit"));
  if (options.dry_run) return PrintForecast(context, study, options.running);
  const std::string directory =
      options.directory.empty() ? DefaultDirectory(study.name, std::time(nullptr)) : options.directory;
  if (options.submit) return SubmitStudy(context, study, options, directory);
  if (Status begun = BeginStudy(directory, study); !begun) return Fail(context, begun.error());
  return RunStudyIn(context, study, {directory, options.running, options.markdown, nullptr, ""});
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

}  // namespace gauntlet
