// gauntlet blame: which obstacle of a case breaks the swarm.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/figures/blame_figure.h"
#include "analysis/tables/table.h"
#include "base/parse_number.h"
#include "base/shell_quoted.h"
#include "cli/commands.h"
#include "cli/given_cases.h"
#include "cli/output/output_file.h"
#include "proto/json_text.h"
#include "search/cases/case_file.h"
#include "study/questions/answered_calls.h"
#include "study/questions/blames.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

struct BlameOptions : RunningOptions {
  std::string directory;
  std::string test_case;
  std::string replicates;
};

Result<int> ParsePartRuns(const std::string& text) {
  if (text.empty()) return 30;
  const auto number = ParseNumber<int>(text);
  if (number && *number >= 2 && *number <= 10000) return *number;
  return InvalidInput(fmt::format("--replicates {}: a whole number from 2 to 10000 is needed", text));
}

std::string Touched(const BlamedPart& part, const Blame& blame) {
  if (blame.failing_robots == 0) return "-";
  return fmt::format("{:.0f} %",
                     100.0 * static_cast<double>(part.touched) / static_cast<double>(blame.failing_robots));
}

// A change of a probability in points of a percentage: "-43", "0", "+7".
std::string Points(double change) {
  const auto points = static_cast<int>(std::lround(100.0 * change));
  return points == 0 ? "0" : fmt::format("{:+d}", points);
}

std::string Effect(const BlamedPart& part) {
  return fmt::format("{} ({} to {})", Points(-part.effect), Points(-part.interval.high),
                     Points(-part.interval.low));
}

std::string TextOf(const Blame& blame, const std::string& picture) {
  std::string text = DescribeBlame(blame) + "\n\n";
  Table table(
      {"without obstacle", ">fails in", ">change in points (95 %)", "", ">failing robots were at it"});
  for (const BlamedPart& part : blame.singles) {
    table.AddRow({NamesOf(part), OutOf(part.without), Effect(part), part.to_blame ? "to blame" : "",
                  Touched(part, blame)});
  }
  for (const BlamedPart& part : blame.pairs) {
    if (part.to_blame) table.AddRow({NamesOf(part), OutOf(part.without), Effect(part), "to blame", ""});
  }
  text += table.ToText();
  if (!blame.pairs.empty()) text += fmt::format("  and {} pairs were tried\n", blame.pairs.size());
  return text + fmt::format("\n{} runs. Drawn on the case, with the places where robots got stuck:\n  {}\n",
                            blame.runs, ShellQuoted(picture));
}

Json JsonOf(const BlamedPart& part) {
  return {{"failure_without", {part.without.failures, part.without.runs()}},
          {"effect", part.effect},
          {"interval", {part.interval.low, part.interval.high}},
          {"to_blame", part.to_blame}};
}

Json JsonOf(const Blame& blame, const std::string& picture) {
  Json singles = Json::array();
  for (const BlamedPart& part : blame.singles) {
    Json one = {{"index", part.obstacles.front()}, {"number", part.obstacles.front() + 1}};
    one.update(JsonOf(part));
    one["touched"] = {part.touched, blame.failing_robots};
    singles.push_back(std::move(one));
  }
  Json pairs = Json::array();
  for (const BlamedPart& part : blame.pairs) {
    Json one = {{"indices", part.obstacles}};
    one.update(JsonOf(part));
    pairs.push_back(std::move(one));
  }
  return {{"run", blame.run > 0 ? Json(blame.run) : Json()},
          {"name", blame.name},
          {"k", blame.whole.failures},
          {"n", blame.whole.runs()},
          {"obstacles", std::move(singles)},
          {"pairs", std::move(pairs)},
          {"sentence", DescribeBlame(blame)},
          {"simulations", blame.runs},
          {"picture", picture}};
}

// The same case may have been asked about as another run's: it gets the name that it has now, and a picture
// of that name. A picture that is there stays: the campaign may be somebody's who may only read it.
Status Conclude(CommandContext& context, const BlameOptions& options, const std::string& name,
                const std::string& directory) {
  TRY(std::vector<Blame> blames, ReadBlames(directory));
  for (Blame& blame : blames) {
    blame.name = name;
    blame.run = RunOfName(name);
    const std::string picture = fmt::format("{}/{}-blame.svg", directory, FileNameOf(name));
    std::error_code none;
    if (!std::filesystem::exists(picture, none)) {
      TRY(WriteOutputFile(picture, analysis::DrawBlame(FigureOf(blame))));
    }
    context.out << (options.json ? JsonText(JsonOf(blame, picture)) : TextOf(blame, picture)) << std::flush;
  }
  return Ok{};
}

// Which obstacles of the parent those of a case file are that `minimise` has made: blame counts them anew.
std::string Renumbered(const std::string& file) {
  const Result<LoadedCase> loaded = LoadCase(file);
  if (!loaded || !loaded->lineage || loaded->lineage->steps.empty()) return "";
  const std::vector<int>& kept = loaded->lineage->steps.back().obstacles;
  if (kept.size() != loaded->test_case.obstacles.size()) return "";
  std::string text;
  for (std::size_t i = 0; i < kept.size(); ++i)
    text += fmt::format("{}{} was {}", i == 0 ? "" : ", ", i + 1, kept[i]);
  return fmt::format("obstacles count from 1 in {}; in {} {}", file, loaded->lineage->parent.name, text);
}

Result<ExitCode> RunBlame(CommandContext& context, const BlameOptions& options) {
  TRY(const int replicates, ParsePartRuns(options.replicates));
  TRY(const int workers, ParseWorkers(options.workers));
  TRY(const QuestionedCampaign questioned, GivenCases(context, options.directory, {options.test_case}));
  TRY(CheckHaveObstacles(questioned));
  const std::string& name = questioned.cases.front().name;
  if (const std::string numbers = RunOfName(name) > 0 ? "" : Renumbered(options.test_case);
      !numbers.empty() && !options.quiet)
    PrintMessage(context, numbers);
  const CallPlan plan = PlanBlame(options.directory, questioned, replicates);
  if (const Result<std::vector<Blame>> known = ReadBlames(plan.directory); known && !known->empty()) {
    TRY(Conclude(context, options, name, plan.directory));
    return kExitDone;
  }
  CampaignRun campaign = RunOfCall(context, plan, workers, options);
  campaign.report = [&](const SessionReport& report) -> Status {
    return report.end == CampaignEnd::kStopped ? Ok{} : Conclude(context, options, name, plan.directory);
  };
  return RunCampaign(context, campaign);
}

}  // namespace

void AddBlame(CommandParser& parser) {
  const auto [command, options] = parser.Add("blame", "which obstacle of a case breaks the swarm?", RunBlame);
  AddDirectory(command, options.directory);
  command
      .add_option("CASE", options.test_case, "the run of the campaign whose case is meant, or a case file")
      ->required();
  AddValue(command, "--replicates", "N", options.replicates,
           "runs of the case and of it without each obstacle (default: 30)");
  AddRunningOptions(command, options);
  command.footer(
      R"(Simulates the case with fresh seeds, and then without each of its obstacles. An obstacle is to blame when
without it the case fails less often by more than three standard errors; it does it when it then fails less than
half as often, else it contributes. When none is to blame, pairs are left out. The picture, kept below DIR/blame,
shows how much each obstacle does and where robots got stuck.

In --json, "index" counts obstacles from 0, as in a case file, and "number" from 1, as in pictures. "effect" is
the failure probability of the case less that without the obstacle. "touched" says of how many of the failing
robots, those that were lost, it was in reach of their proximity sensors.

Examples:
  gauntlet blame DIR 812
  gauntlet blame DIR smallest.json --replicates 100 --json)");
}

}  // namespace gauntlet
