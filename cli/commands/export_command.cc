// gauntlet export: a campaign's data for other programs.
#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/tables/table.h"
#include "base/number_text.h"
#include "cli/argos_files.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "master/campaign/campaign_summary.h"
#include "proto/case_json.h"
#include "proto/json_text.h"
#include "report/tables/exported_tables.h"
#include "study/questions/questioned_cases.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

struct ExportCommandOptions {
  std::string directory;
  std::string what;
  std::string format;
  std::string out;
  std::vector<std::string> runs;
  std::string controller_file;
  std::string controller;
};

Result<Exported> WhatOf(const std::string& name) {
  const std::pair<const char*, Exported> known[] = {{"runs", Exported::kRuns},
                                                    {"cases", Exported::kCases},
                                                    {"trajectories", Exported::kTrajectories},
                                                    {"events", Exported::kEvents}};
  for (const auto& [known_name, what] : known) {
    if (name == known_name) return what;
  }
  return InvalidInput(fmt::format("--what {}: give runs, cases, trajectories or events", name));
}

// Runs when nothing was said, but for a format that has cases only.
Result<Exported> ChosenOf(const ExportCommandOptions& options) {
  const bool argos = options.format == "argos";
  if (options.what.empty()) return argos ? Exported::kCases : Exported::kRuns;
  const Result<Exported> what = WhatOf(options.what);
  if (what && argos && *what != Exported::kCases)
    return InvalidInput(fmt::format("--what {}: .argos files hold cases; give csv or json", options.what));
  return what;
}

// A file for each case rather than a table.
bool WantsCaseFiles(const ExportCommandOptions& options, Exported what) {
  return what == Exported::kCases && options.format != "csv";
}

Result<ExportOptions> Judge(const ExportCommandOptions& options) {
  ExportOptions judged;
  TRY(judged.what, ChosenOf(options));
  if (options.format != "csv" && options.format != "json" && options.format != "argos")
    return InvalidInput(fmt::format("--format {}: give csv, json or argos", options.format));
  judged.format = options.format == "csv" ? TableFormat::kCsv : TableFormat::kJson;
  const bool argos = options.format == "argos";
  if (!argos && !options.controller_file.empty())
    return InvalidInput(
        fmt::format("--controller-file {}: only .argos files hold controllers", options.controller_file));
  if (options.controller_file.empty() && !options.controller.empty())
    return InvalidInput(
        fmt::format("--controller {}: of which file? Give --controller-file FILE", options.controller));
  for (const std::string& run : options.runs) {
    if ((judged.what == Exported::kCases && !argos) || judged.what == Exported::kEvents)
      return InvalidInput(fmt::format("--run {}: {} belong to no single run", run,
                                      judged.what == Exported::kCases ? "cases" : "events"));
    const Result<std::uint64_t> id = ParseRunId(run);
    if (!id) return InvalidInput(fmt::format("--run {}", id.error().message));
    judged.runs.insert(*id);
  }
  return judged;
}

struct ExportRule {
  bool finished = false;
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
};

Result<ExportRule> ConditionOf(const StoredCampaign& campaign, const std::string& directory) {
  TRY(const CampaignSummary totals, SummariseTotals(campaign.plans, *campaign.view.store));
  ExportRule condition{totals.finished, {}};
  std::vector<std::string>& notes = condition.notes;
  if (!campaign.being_written.empty()) notes.push_back(campaign.being_written);
  if (!totals.finished)
    notes.push_back(fmt::format("{} is half-finished: the {} runs that it has so far are exported", directory,
                                FormatCount(totals.runs_done)));
  return condition;
}

std::string HeadJson(const StoredCampaign& campaign, const std::string& directory,
                     const ExportRule& condition) {
  const Experiment& experiment = campaign.plans.front().experiment;
  return JsonText({{"experiment", experiment.name},
                   {"directory", directory},
                   {"scenario", experiment.scenario},
                   {"controller", experiment.controller},
                   {"version", campaign.view.store->meta().software_version},
                   {"finished", condition.finished},
                   {"notes", condition.notes}});
}

// A file for each test case, as `evaluate --case` takes it.
Result<std::uint64_t> WriteCaseFiles(const StoredCampaign& campaign, const fs::path& directory) {
  std::uint64_t files = 0;
  for (SearchId search = 1; search <= campaign.plans.size(); ++search) {
    TRY(const std::vector<Individual> individuals, campaign.view.store->LoadIndividuals(search));
    const std::string of_search = campaign.plans.size() > 1 ? fmt::format("search-{}-", search) : "";
    // As many digits for all, so that files sort by number.
    const std::size_t digits = individuals.empty() ? 1 : fmt::formatted_size("{}", individuals.back().id);
    for (const Individual& individual : individuals) {
      const std::string name = fmt::format("{}case-{:0{}}.json", of_search, individual.id, digits);
      TRY(WriteOutputFile(directory / name, proto::WriteCaseJson(individual.test_case)));
      ++files;
    }
  }
  return files;
}

Result<ExportReport> WriteTableFile(const StoredCampaign& campaign, const ExportOptions& options,
                                    const std::string& head, const std::string& path) {
  TRY(OutputFile file, OutputFile::Open(path));
  TRY(const ExportReport report,
      WriteTable(campaign, options, head, [&](std::string_view bytes) { return file.Write(bytes); }));
  TRY(file.Close());
  return report;
}

Result<ExitCode> RunExport(CommandContext& context, const ExportCommandOptions& options) {
  TRY(const ExportOptions judged, Judge(options));
  TRY(const StoredCampaign campaign, OpenStoredCampaign(options.directory));
  TRY(const ExportRule condition, ConditionOf(campaign, options.directory));
  for (const std::string& note : condition.notes) PrintMessage(context, note);

  if (WantsCaseFiles(options, judged.what)) {
    const ArgosFilesOptions argos = {judged.runs, options.controller_file, options.controller};
    ArgosFilesReport argos_files;
    TRY(const std::uint64_t files,
        WriteOutputDirectory("--out", options.out,
                             [&](const std::string& directory) -> Result<std::uint64_t> {
                               if (options.format == "json") return WriteCaseFiles(campaign, directory);
                               TRY(argos_files, WriteArgosFiles(campaign, argos, directory));
                               return argos_files.files;
                             }));
    for (const auto& [notice, of_files] : argos_files.notices)
      PrintMessage(context,
                   of_files == files ? notice : fmt::format("{} of {} files: {}", of_files, files, notice));
    PrintMessage(context, fmt::format("wrote {} case {} into {}", FormatCount(files), Plural(files, "file"),
                                      options.out));
    return kExitDone;
  }
  TRY(const ExportReport report,
      WriteTableFile(campaign, judged, HeadJson(campaign, options.directory, condition), options.out));
  if (report.simulated > 0)
    PrintMessage(context,
                 fmt::format("{} runs, whose trajectories were not kept, were simulated again: each ended as "
                             "it had",
                             FormatCount(report.simulated)));
  PrintMessage(context, fmt::format("wrote {} rows to {}", FormatCount(report.rows), options.out));
  return kExitDone;
}

// The columns of everything that can be exported, for the help.
std::string ColumnsText() {
  std::string text;
  for (const char* name : {"runs", "cases", "trajectories", "events"}) {
    Table table({"", "", ""});
    for (const DataColumn& column : CommonColumns(*WhatOf(name)))
      table.AddRow({column.name, column.unit, column.meaning});
    text += fmt::format("\n--what {}, the columns with their units\n{}", name, table.ToText());
  }
  return text;
}

}  // namespace

void AddExport(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("export", "write a campaign's data for R, pandas, ARGoS and others", RunExport);
  AddDirectory(command, options.directory);
  AddValue(command, "--format", "csv|json|argos", options.format, "format of the output")->required();
  AddValue(command, "--out", "OUT", options.out, "the file to write; for case files, a new directory")
      ->required();
  AddValue(command, "--what", "WHAT", options.what,
           "runs (the default), cases (the default of argos), trajectories or events: see below");
  AddValue(command, "--run", "ID", options.runs,
           "write this run only (runs, trajectories, argos); repeatable");
  AddValue(command, "--controller-file", "FILE", options.controller_file,
           "give the robots the <controllers> of this .argos or XML file (argos; default: a placeholder)");
  AddValue(command, "--controller", "ID", options.controller,
           "take the controller of this id from that file (argos)");
  command.footer(
      R"(runs          a row for each run
cases         csv: a row for each obstacle of each test case; json, argos: a directory with a case file for
              each test case, as 'evaluate --case' takes them. A file for ARGoS holds the run in which the case
              was found, or each --run: ARGoS loads and runs the file as it is, with arena, walls, obstacles,
              lamps, seed, length and every robot at its start pose. A message names what ARGoS does not have
trajectories  a row for each robot every 5 s. If the campaign has not kept them (store.trajectories), each run
              is simulated again and must end as it was stored. 'replay --csv' writes every pose of a run
events        a row for each event of the campaign, such as a start or a lost worker

The command works while the campaign runs, and then says that the data is not complete. The file is written
whole or not at all. If a campaign holds several searches, each key in which they differ has a column. A field is
empty when there was nothing to measure. Seeds and hashes have 64 bits, so read them as text. (pandas reads
numbers to the last bit with float_precision="round_trip".) JSON is an object: its member "columns" describes the
columns by name, unit and meaning, and the member with the name of WHAT is the list of rows.

In R:      runs <- read.csv("runs.csv", colClasses = c(seed = "character", hash = "character"))
In pandas: runs = pandas.read_csv("runs.csv", dtype={"seed": str, "hash": str})
)" + ColumnsText() +
      R"(
Examples:
  gauntlet export campaigns/sweep --format csv --out runs.csv
  gauntlet export DIR --format json --what cases --out cases && gauntlet evaluate flocking --case cases/*.json
  gauntlet export DIR --format argos --run 812 --controller-file my_experiment.argos --out for-argos
  gauntlet export DIR --format csv --what trajectories --run 812 --out trajectories.csv)");
}

}  // namespace gauntlet
