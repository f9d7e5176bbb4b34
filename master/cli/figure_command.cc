// gauntlet figure: a campaign's figures for papers, with their data.
#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "base/printable.h"
#include "base/shell_quoted.h"
#include "master/cli/commands.h"
#include "master/cli/options.h"
#include "master/cli/output_file.h"
#include "master/cli/table.h"
#include "master/pages/archive_figure.h"
#include "master/pages/campaign_figures.h"
#include "master/pages/study_figures.h"
#include "master/pages/study_pages.h"
#include "master/study/study_campaigns.h"

namespace gauntlet::master {
namespace {

struct FigureOptions {
  std::string directory;
  std::string name;
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

// Of every run of a campaign.
Listed FiguresOfRuns() {
  return {{"run-ID", "of a run: everybody's way"},
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
    if (Status written = WriteOutputFile(path, content()); !written) return written;
    PrintMessage(context, fmt::format("wrote {}", path));
  }
  if (options.svg.empty() && options.csv.empty()) context.out << figure.svg() << std::flush;
  return Ok{};
}

// Lists the figures, or writes the one that was asked for. `others`: that there are too, but not for this
// name.
ExitCode ListOrWrite(CommandContext& context, const FigureOptions& options,
                     const std::vector<NamedFigure>& figures, const Listed& others) {
  Listed listed;
  for (const NamedFigure& figure : figures) listed.emplace_back(figure.name, figure.title);
  listed.insert(listed.end(), others.begin(), others.end());
  if (options.name.empty()) {
    context.out << ListText(listed) << std::flush;
    return kExitDone;
  }
  const auto figure = std::ranges::find(figures, options.name, &NamedFigure::name);
  if (figure == figures.end()) return Fail(context, NoSuchFigure(options.name, listed));
  if (const Status written = Write(context, *figure, options); !written)
    return Fail(context, written.error());
  return kExitDone;
}

ExitCode RunStudyFigure(CommandContext& context, const FigureOptions& options) {
  const Result<StudyPages> study = GatherStudy(options.directory);
  if (!study) return Fail(context, study.error());
  if (!study->report) {
    return Fail(context,
                InvalidInput(fmt::format(
                    "{0} holds a study that has not finished: 'gauntlet resume {0}' goes on; figures "
                    "of its searches: 'gauntlet figure {0}/searches'",
                    PastedPath(options.directory))));
  }
  return ListOrWrite(context, options, FiguresOf(*study->report), {});
}

ExitCode RunFigureCommand(CommandContext& context, const FigureOptions& options) {
  if (IsStudy(options.directory)) return RunStudyFigure(context, options);
  const Result<RunId> run = RunOf(options.name);
  if (!run) return Fail(context, run.error());
  const Result<CampaignFacts> facts = ReadFacts(options.directory);
  if (!facts) return Fail(context, facts.error());
  for (const std::string& note : facts->notes) PrintMessage(context, note);
  std::vector<ShownRun> shown;
  std::vector<NamedFigure> figures;
  if (*run == 0) {
    figures = FiguresOf(CoursesOf(*facts), MapsOf(*facts));
    std::ranges::move(ArchiveFigures(*facts), std::back_inserter(figures));
  } else {
    Result<std::vector<ShownRun>> one = ShowRuns(*facts, {*run});
    if (!one) return Fail(context, one.error());
    shown = *std::move(one);
    if (const std::string& trouble = shown.front().trouble; !trouble.empty()) {
      PrintMessage(context, fmt::format("run {}: {}", *run, trouble));
      return kExitNegative;
    }
    figures = FiguresOf(shown.front());
  }
  return ListOrWrite(context, options, figures, FiguresOfRuns());
}

}  // namespace

void AddFigure(CommandParser& parser) {
  const auto [command, options] =
      parser.Add("figure", "a campaign's figures as SVG, and their data as CSV", RunFigureCommand);
  AddDirectory(command, options.directory);
  command.add_option("NAME", options.name, "which one; without it, they are listed");
  AddValue(command, "-o,--svg", "F", options.svg, "where the picture goes; stdout when nothing is said");
  AddValue(command, "--csv", "F", options.csv, "write the data that it shows");
  command.footer(
      R"(Figures of a whole campaign: progress (fitness and failures over the runs spent; searches that differ in
their seed only are repeats of one another and are drawn with a band), failure-types, behaviour. Figures of
a run simulate it again: exit 1 when it does not end as it was stored. Figures of a study: the box plots of
each comparison; of a tuning: robustness, consistency. The same figures stand in 'gauntlet report'; box plots
of any two sets of runs draws 'gauntlet compare --svg'.

Examples:
  gauntlet figure campaigns/flocking-20260131T120000Z
  gauntlet figure DIR failure-types -o types.svg --csv types.csv
  gauntlet figure DIR motion-812 -o motion.svg)");
}

}  // namespace gauntlet::master
