#include "report/figures/campaign_figures.h"

#include <fmt/format.h>

#include "analysis/figures/heat_map.h"
#include "analysis/figures/line_figure.h"
#include "analysis/figures/run/run_annotations.h"
#include "analysis/figures/run/swarm_motion.h"
#include "analysis/figures/run/trajectory_csv.h"
#include "analysis/tables/table.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

std::string LinesCsv(const analysis::LineFigure& figure) {
  Table table({"line", "meaning", figure.x_name, "value", "lowest", "highest"});
  for (const analysis::LinePanel& panel : figure.panels) {
    for (const analysis::FigureLine& line : panel.lines) {
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        const bool band = !line.low.empty();
        table.AddRow({line.name, panel.axis_name, line.x[i], line.y[i], band ? Cell(line.low[i]) : Cell(),
                      band ? Cell(line.high[i]) : Cell()});
      }
    }
  }
  return table.ToCsv();
}

std::string MapCsv(const RunMap& map) {
  Table table({map.down_name.empty() ? "row" : map.down_name,
               map.across_name.empty() ? "column" : map.across_name, "runs", "toughest run"});
  for (std::size_t row = 0; row < map.rows.size(); ++row) {
    for (std::size_t column = 0; column < map.columns.size(); ++column) {
      const RunId toughest = map.toughest[row][column];
      table.AddRow({map.rows[row], map.columns[column], map.cells[row][column].count,
                    toughest == 0 ? Cell() : toughest});
    }
  }
  return table.ToCsv();
}

std::string StatesCsv(const analysis::RunFigure& figure) {
  const analysis::RobotStates states = analysis::StatesOf(figure.result);
  Table table({"robot", "state", "begin_s", "end_s"});
  for (const analysis::StateSpell& spell : states.spells) {
    table.AddRow({spell.robot, states.names[static_cast<std::size_t>(spell.state)], spell.begin, spell.end});
  }
  return table.ToCsv();
}

NamedFigure ProgressFigure(const SearchCourse& course, const std::string& name) {
  const std::string title =
      course.name.empty() ? "How the search went" : fmt::format("How the search went: {}", course.name);
  return {name, title,
          "Above: the fitness of the runs that a part of the search spent, their lowest (the toughest case) "
          "and their mean. A search that learns drives it down; one that only draws at random stays level. "
          "Below: how many of these runs were total failures.",
          [=] { return analysis::DrawLines(FigureOf(course, title)); },
          [=] { return LinesCsv(FigureOf(course, title)); }};
}

}  // namespace

std::vector<NamedFigure> FiguresOf(const std::vector<SearchCourse>& courses,
                                   const std::vector<RunMap>& maps) {
  std::vector<NamedFigure> figures;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    figures.push_back(ProgressFigure(
        courses[i], courses.size() == 1 ? std::string("progress") : fmt::format("progress-{}", i + 1)));
  }
  for (const RunMap& map : maps) {
    figures.push_back({map.name, map.title, map.reading, [=] { return analysis::DrawHeatMap(map); },
                       [=] { return MapCsv(map); }});
  }
  return figures;
}

std::vector<NamedFigure> FiguresOf(const ShownRun& shown) {
  const analysis::RunFigure& figure = shown.figure;
  const std::string id = proto::RunText(shown.report.stored.id);
  if (figure.result.trajectory.empty()) return {};
  std::vector<NamedFigure> figures = {
      {fmt::format("run-{}", id), fmt::format("Run {}: every robot's trajectory", id),
       "The arena from above: obstacles, where each robot went (its line grows stronger with time), who was "
       "lost, and where the swarm broke.",
       [&figure] { return analysis::DrawRun(figure); },
       [&figure] { return analysis::WriteTrajectoryCsv(figure.result.trajectory); }},
      {fmt::format("motion-{}", id), fmt::format("Run {}: how the swarm moved", id),
       "Over the time of the run: how far the robots were apart, whether they headed the same way, and how "
       "fast they were. A swarm that breaks spreads; one that jams slows down.",
       [&figure] { return analysis::DrawLines(analysis::SwarmMotion(figure)); },
       [&figure] { return LinesCsv(analysis::SwarmMotion(figure)); }}};
  if (analysis::HasTimeline(figure)) {
    figures.push_back({fmt::format("states-{}", id), fmt::format("Run {}: what every robot did when", id),
                       "A row for each robot, coloured by what it did; below, how many robots did what.",
                       [&figure] { return analysis::DrawTimeline(figure); },
                       [&figure] { return StatesCsv(figure); }});
  }
  return figures;
}

}  // namespace gauntlet
