// gauntlet report: campaigns as one file for a browser.
#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "report/pages/report_page.h"

namespace gauntlet {
namespace {

constexpr std::size_t kShownRuns = 40;  // of a report, shared by its campaigns
constexpr std::size_t kMostShownRuns = 500;

struct ReportCommandOptions {
  std::vector<std::string> sets;
  std::string out;
  std::string runs;
};

Result<std::size_t> ShownRunsOf(const std::string& text) {
  if (text.empty()) return kShownRuns;
  const auto number = ParseNumber<std::size_t>(text);
  if (!number || *number > kMostShownRuns)
    return InvalidInput(
        fmt::format("--runs {}: give a whole number from 0 to {}", Printable(text), kMostShownRuns));
  return *number;
}

Result<ExitCode> RunReport(CommandContext& context, const ReportCommandOptions& options) {
  TRY(const std::size_t shown_runs, ShownRunsOf(options.runs));
  TRY(const Report report, GatherReport(options.sets, shown_runs));
  const std::string page = ReportPage(report);
  TRY(WriteOutputFile(options.out, page));
  std::size_t troubles = 0;
  for (const CampaignPages& pages : report.campaigns) {
    for (const std::string& note : pages.facts.notes) PrintMessage(context, note);
    troubles += static_cast<std::size_t>(
        std::ranges::count_if(pages.shown, [](const ShownRun& shown) { return !shown.trouble.empty(); }));
  }
  if (troubles > 0) {
    PrintMessage(context,
                 fmt::format("{} of the runs that are shown did not end as they were stored: the report "
                             "says so beside them",
                             FormatCount(troubles)));
  }
  PrintMessage(context, fmt::format("wrote {} ({:.1f} MB): open it in a browser", options.out,
                                    static_cast<double>(page.size()) / 1e6));
  return kExitDone;
}

}  // namespace

void AddReport(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("report", "write campaigns as one HTML file: what failed, how, and replays", RunReport);
  command
      .add_option("DIR", options.sets,
                  "a campaign, or the directory of a 'study' or 'tune'; the fitness of several campaigns, or "
                  "of several "
                  "sets of runs as 'compare' names them (DIR:all, DIR:random:100), is compared")
      ->required();
  AddValue(command, "-o,--out", "F", options.out, "the file to write")->required();
  AddValue(command, "--runs", "N", options.runs,
           "number of runs that are simulated again and shown as a replay (default: 40)");
  command.footer(
      R"(Writes a file that needs no network and no other file; a double click opens it. It shows what was tested and
what was found, with maps of failures and behaviours, and replays of the toughest run in each field of the maps
and of the toughest test cases. Several sets of runs are compared. For a study it shows every comparison, for a
tuning the recommended values and how sure they are. Tables and pictures also work without JavaScript. 'gauntlet
figure' writes the figures for a paper.

Examples:
  gauntlet report campaigns/flocking-20260131T120000Z -o report.html
  gauntlet report campaigns/tuning -o parameters.html
  gauntlet report campaigns/random:random:100 campaigns/evolved:final -o comparison.html)");
}

}  // namespace gauntlet
