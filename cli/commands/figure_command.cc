// gauntlet figure: a campaign's figures for papers, with their data.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "analysis/tables/table.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/options/options.h"
#include "cli/output/output_file.h"
#include "proto/run_text.h"
#include "report/figures/archive_figure.h"
#include "report/figures/campaign_figures.h"
#include "report/figures/condition_figure.h"
#include "report/figures/set_comparison.h"
#include "report/figures/settings/settings_answer.h"
#include "report/figures/study_figures.h"
#include "report/pages/study_pages.h"
#include "study/questions/questioned_cases.h"
#include "study/study_campaigns.h"

namespace gauntlet {
namespace {

struct FigureOptions {
  std::string directory;
  std::string name;
  std::vector<std::string> others;
  std::string svg;
  std::string csv;
};

// "run-981" is about a run; 0 when the name is about none. Error: what stands behind the dash is no number.
Result<RunId> RunOf(const std::string& name) {
  for (const std::string prefix : {"run-", "motion-", "states-"}) {
    if (name.starts_with(prefix)) return ParseRunId(name.substr(prefix.size()));
  }
  return RunId{0};
}

// Names of figures and their titles.
using Listed = std::vector<std::pair<std::string, std::string>>;

// Of every campaign, by what is said about them.
Listed FiguresOfMore() {
  return {{"comparison", "with --with SET: box plots of several sets of runs"},
          {"run-ID", "of a run: every robot's trajectory"},
          {"motion-ID", "of a run: how the swarm moved, over time"},
          {"states-ID", "of a run: what every robot did when (foraging, task-partitioning)"}};
}

std::string ListText(const Listed& listed) {
  Table table({"name", "figure"});
  for (const auto& [name, title] : listed) table.AddRow({name, title});
  return table.ToText();
}

Error NoSuchFigure(const std::string& name, const Listed& listed) {
  std::string known;
  for (const auto& [one, title] : listed) known += (known.empty() ? "" : ", ") + one;
  return InvalidInput(
      fmt::format("there is no figure '{}'; there are: {}", Printable(name), known.empty() ? "none" : known));
}

// Writes what was asked for; the picture to stdout when nothing was.
Status Write(CommandContext& context, const NamedFigure& figure, const FigureOptions& options) {
  const std::pair<const std::string&, const std::function<std::string()>&> outputs[] = {
      {options.svg, figure.svg}, {options.csv, figure.csv}};
  for (const auto& [path, content] : outputs) {
    if (path.empty()) continue;
    TRY(WriteOutputFile(path, content()));
    PrintMessage(context, fmt::format("wrote {}", path));
  }
  if (options.svg.empty() && options.csv.empty()) context.out << figure.svg() << std::flush;
  return Ok{};
}

// Lists the figures, or writes the one that was asked for. `others`: that there are too, but not for this
// name.
Result<ExitCode> ListOrWrite(CommandContext& context, const FigureOptions& options,
                             const std::vector<NamedFigure>& figures, const Listed& others) {
  Listed listed;
  for (const NamedFigure& figure : figures) listed.emplace_back(figure.name, figure.title);
  listed.insert(listed.end(), others.begin(), others.end());
  if (options.name.empty()) {
    context.out << ListText(listed) << std::flush;
    return kExitDone;
  }
  const auto figure = std::ranges::find(figures, options.name, &NamedFigure::name);
  if (figure == figures.end()) return NoSuchFigure(options.name, listed);
  TRY(Write(context, *figure, options));
  return kExitDone;
}

Result<ExitCode> RunStudyFigure(CommandContext& context, const FigureOptions& options) {
  TRY(const StudyPages study, GatherStudy(options.directory));
  if (!study.report) {
    return InvalidInput(
        fmt::format("{0} holds a study that has not finished: 'gauntlet resume {0}' goes on; figures "
                    "of its searches: 'gauntlet figure {0}/searches'",
                    PastedPath(options.directory)));
  }
  return ListOrWrite(context, options, FiguresOf(*study.report), {});
}

// Of sets of runs, as `report` compares them.
Result<ExitCode> RunComparisonFigure(CommandContext& context, const FigureOptions& options) {
  std::vector<std::string> sets = {options.directory};
  sets.insert(sets.end(), options.others.begin(), options.others.end());
  TRY(const SetComparisons compared, CompareSets(sets));
  for (const std::string& note : compared.notes) PrintMessage(context, note);
  if (compared.comparisons.size() != 1) {
    return InvalidInput(
        "these sets are not of one scenario: name at least two that are, the "
        "first in place of DIR and each other one by --with");
  }
  return ListOrWrite(context, options, {FigureOf(compared.comparisons.front())}, {});
}

Result<ExitCode> RunFigureCommand(CommandContext& context, const FigureOptions& options) {
  if (!options.others.empty()) return RunComparisonFigure(context, options);
  if (IsStudy(options.directory)) return RunStudyFigure(context, options);
  if (options.name == "comparison") return RunComparisonFigure(context, options);
  TRY(const RunId run, RunOf(options.name));
  TRY(const CampaignFacts facts, ReadFacts(options.directory));
  for (const std::string& note : facts.notes) PrintMessage(context, note);
  std::vector<ShownRun> shown;
  std::vector<NamedFigure> figures;
  if (run == 0) {
    figures = FiguresOf(CoursesOf(facts), MapsOf(facts));
    std::ranges::move(ConditionFigures(facts), std::back_inserter(figures));
    std::ranges::move(ArchiveFigures(facts), std::back_inserter(figures));
    if (auto settings = SettingsAnswerOf(facts))
      std::ranges::move(settings->figures, std::back_inserter(figures));
  } else {
    TRY(shown, ShowRuns(facts, {run}));
    if (const std::string& trouble = shown.front().trouble; !trouble.empty()) {
      PrintMessage(context, fmt::format("run {}: {}", proto::RunText(run), trouble));
      return kExitNegative;
    }
    figures = FiguresOf(shown.front());
  }
  return ListOrWrite(context, options, figures, FiguresOfMore());
}

}  // namespace

void AddFigure(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("figure", "write a campaign's figures as SVG, and their data as CSV", RunFigureCommand);
  AddDirectory(command, options.directory);
  command.add_option("NAME", options.name, "name of the figure; without it, the figures are listed");
  AddValue(command, "--with", "SET", options.others,
           "another set of runs, as 'compare' names them, for the figure 'comparison'; repeatable");
  AddValue(command, "-o,--svg", "F", options.svg, "file of the picture (default: standard output)");
  AddValue(command, "--csv", "F", options.csv, "also write the data of the figure to this file");
  command.footer(
      R"('gauntlet figure DIR' lists the figures of a campaign, a study or a tuning. 'progress' shows fitness and failures
over the number of runs; searches that differ in their seed only are drawn as one band. 'comparison' draws box
plots of the set DIR and of those of --with. The figures of a run, such as motion-812, simulate the run again;
the exit code is 1 when it does not end as it was stored. 'gauntlet report' shows the same figures.

Examples:
  gauntlet figure campaigns/flocking-20260131T120000Z
  gauntlet figure DIR failure-types -o types.svg --csv types.csv
  gauntlet figure DIR motion-812 -o motion.svg
  gauntlet figure random:all comparison --with evolved:final -o boxes.svg --csv boxes.csv)");
}

}  // namespace gauntlet
