#include "study/questions/blames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "proto/json_text.h"
#include "search/cases/case_file.h"
#include "search/given/case_blame.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

BlamedPart PartOf(const CaseBlame::Part& part, const FailureTally& whole) {
  BlamedPart blamed;
  blamed.obstacles = part.without;
  blamed.without = part.runs.tally;
  if (whole.runs() == 0 || blamed.without.runs() == 0) return blamed;
  const auto count = [](int value) { return static_cast<std::uint32_t>(value); };
  blamed.effect = static_cast<double>(whole.failures) / whole.runs() -
                  static_cast<double>(blamed.without.failures) / blamed.without.runs();
  blamed.interval =
      analysis::DifferenceInterval(count(whole.failures), count(whole.runs()), count(blamed.without.failures),
                                   count(blamed.without.runs()), analysis::kConfidence);
  blamed.to_blame = ClearlyLess(blamed.without, whole);
  return blamed;
}

std::string Numbers(const std::vector<std::size_t>& obstacles) {
  std::string text;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const char* between = i == 0 ? "" : i + 1 == obstacles.size() ? " and " : ", ";
    text += fmt::format("{}{}", between, obstacles[i] + 1);
  }
  return text;
}

// Obstacles to blame, with how often the case fails without each.
struct Guilty {
  std::vector<std::size_t> numbers;
  std::string counts;

  void Add(const BlamedPart& part) {
    numbers.push_back(part.obstacles.front());
    counts += fmt::format("{}without {} it fails in {}", counts.empty() ? "" : ", ", numbers.back() + 1,
                          OutOf(part.without));
  }
  std::string Sentence(const char* one, const char* several) const {
    return fmt::format("Obstacle{} {} {}: {}.", numbers.size() > 1 ? "s" : "", Numbers(numbers),
                       numbers.size() > 1 ? several : one, counts);
  }
};

// Without it the case fails less than half as often.
bool DoesIt(const BlamedPart& part, const FailureTally& whole) {
  return 2 * part.without.failures * whole.runs() < whole.failures * part.without.runs();
}

// Its obstacles as people count them, from 1: "1 and 3".
std::string NamesOf(const BlamedPart& part) {
  return Numbers(part.obstacles);
}

// A change of a probability in points of a percentage: "-43", "0", "+7".
std::string Points(double change) {
  const auto points = static_cast<int>(std::lround(100.0 * change));
  return points == 0 ? "0" : fmt::format("{:+d}", points);
}

// Of the failing robots, how many were at the obstacle.
Cell TouchedCell(const BlamedPart& part, std::uint64_t robots) {
  return JsonCell({part.touched, robots},
                  robots == 0 ? "-"
                              : fmt::format("{:.0f} %", 100.0 * static_cast<double>(part.touched) /
                                                            static_cast<double>(robots)));
}

// What single obstacles and pairs have in common.
std::vector<Cell> CellsOfPart(const BlamedPart& part) {
  return {OutOfCell(part.without.failures, part.without.runs()),
          Cell(fmt::format("{} ({} to {})", Points(-part.effect), Points(-part.interval.high),
                           Points(-part.interval.low)),
               part.effect),
          JsonCell({part.interval.low, part.interval.high}),
          Cell(part.to_blame ? "to blame" : "", part.to_blame)};
}

std::vector<Column> BlameColumns(std::vector<Column> columns) {
  columns.insert(columns.end(), {{">fails in", "failure_without"},
                                 {">change in points (95 %)", "effect"},
                                 ForPrograms("interval"),
                                 {"", "to_blame"},
                                 {">failing robots were at it", "touched?"}});
  return columns;
}

void AddPart(Cell index, Cell names, const BlamedPart& part, Cell touched, Table& table) {
  std::vector<Cell> row = {std::move(index), std::move(names)};
  for (Cell& cell : CellsOfPart(part)) row.push_back(std::move(cell));
  row.push_back(std::move(touched));
  table.AddRow(std::move(row));
}

Result<Told> TellBlame(const Asking& asking, const Call& /*call*/, std::span<const CaseAnswer> answers) {
  const Blame blame = BlameIn(answers.front());
  Told told;
  Table singles(BlameColumns({ForPrograms("index"), {"without obstacle", "number"}}));
  Table pairs(BlameColumns({ForPrograms("indices"), {"without obstacle"}}));
  for (const BlamedPart& part : blame.singles) {
    const std::size_t index = part.obstacles.front();
    AddPart(index, index + 1, part, TouchedCell(part, blame.failing_robots), singles);
  }
  Table shown = singles;
  for (const BlamedPart& part : blame.pairs) {
    AddPart(JsonCell(part.obstacles), NamesOf(part), part, TextCell(""), pairs);
    if (part.to_blame) AddPart("", NamesOf(part), part, TextCell(""), shown);
  }
  const std::string sentence = DescribeBlame(blame);
  const std::string file = fmt::format("{}/{}-blame.svg", answers.front().campaign, FileNameOf(blame.name));
  const bool fails = blame.whole.failures > 0;
  told.json = JsonText({{"run", blame.run > 0 ? Json(blame.run) : Json()},
                        {"name", blame.name},
                        {"k", blame.whole.failures},
                        {"n", blame.whole.runs()},
                        {"obstacles", singles.ToJson()},
                        {"pairs", pairs.ToJson()},
                        {"sentence", sentence},
                        {"simulations", blame.runs},
                        {"picture", fails ? Json(file) : Json()}});
  TRY(const std::vector<Baseline> baselines, ReadBaselines(asking.place));
  if (Matters(baselines)) told.section.lead.push_back(InWords(baselines, asking.program, asking.place));
  told.section.lead.push_back(sentence);
  if (!fails) {
    told.conclusion = Conclusion::kRefused;
    return told;
  }
  told.section.table = std::move(shown);
  if (!blame.pairs.empty())
    told.section.sentences.push_back(fmt::format("{} pairs were tried too.", blame.pairs.size()));
  told.section.sentences.push_back(fmt::format("{} runs.", blame.runs));
  const std::string picture = analysis::DrawBlame(FigureOf(blame));
  told.section.pictures = {
      {"Which obstacles are to blame",
       "The redder an obstacle, the less the case fails without it; blue is where robots "
       "got stuck.",
       picture}};
  told.files = {{file, picture, "drawn on the case, with the places where robots got stuck"}};
  return told;
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

Result<QuestionedCampaign> CasesToBlame(const Asking& asking) {
  TRY(auto questioned, CasesWithObstacles(asking));
  if (asking.quiet || questioned.cases.front().name.starts_with("run ")) return questioned;
  const std::string renumbered = Renumbered(asking.cases.front());
  if (!renumbered.empty()) asking.say(renumbered);
  return questioned;
}

Result<Experiment> AboutBlame(const Experiment& experiment, const Asking& asking) {
  TRY(const int replicates, WholeNumber(asking, "--replicates", 2, 10000, /*otherwise=*/30));
  return BlameExperiment(experiment, replicates);
}

constexpr const char* kBlameHelp =
    R"(Simulates the case with fresh seeds, and then without each of its obstacles. An obstacle is to blame when
without it the case fails less often by more than three standard errors; it does it when it then fails less than
half as often, else it contributes. When none is to blame, pairs are left out. The picture, kept below DIR/blame,
shows how much each obstacle does and where robots got stuck. Exit 2 when the case does not fail.

In --json, "index" counts obstacles from 0, as in a case file, and "number" from 1, as in pictures. "effect" is
the failure probability of the case less that without the obstacle. "touched" says of how many of the failing
robots, those that were lost, it was in reach of their proximity sensors.

Examples:
  gauntlet blame DIR 812
  gauntlet blame DIR smallest.json --replicates 100 --json)";

}  // namespace

std::string DescribeBlame(const Blame& blame) {
  if (blame.whole.failures == 0)
    return fmt::format("{} failed in {} runs: there is nothing to blame.", blame.name, OutOf(blame.whole));
  const std::string fails = fmt::format("{} fails in {} runs. ", blame.name, OutOf(blame.whole));
  Guilty does;
  Guilty contributes;
  for (const BlamedPart& part : blame.singles) {
    if (part.to_blame) (DoesIt(part, blame.whole) ? does : contributes).Add(part);
  }
  std::string sentences;
  if (!does.numbers.empty()) sentences = does.Sentence("does it", "do it");
  if (!contributes.numbers.empty())
    sentences +=
        (sentences.empty() ? "" : " ") + contributes.Sentence("contributes to it", "contribute to it");
  if (!sentences.empty()) return fails + sentences;
  const auto pair = std::ranges::max_element(blame.pairs, {}, &BlamedPart::effect);
  if (pair != blame.pairs.end() && pair->to_blame) {
    return fails + fmt::format("No single obstacle does it; without both {} it fails in {} only.",
                               Numbers(pair->obstacles), OutOf(pair->without));
  }
  return fails + "No obstacle and no pair of them explains it.";
}

analysis::BlameFigure FigureOf(const Blame& blame) {
  const std::string sentence = DescribeBlame(blame);
  const std::size_t end = sentence.find(". ");
  analysis::BlameFigure figure{.title = blame.name,
                               .sentences = {sentence},
                               .test_case = blame.test_case,
                               .effects = {},
                               .stuck = blame.stuck,
                               .lines = {}};
  if (end != std::string::npos) figure.sentences = {sentence.substr(0, end + 1), sentence.substr(end + 2)};
  figure.lines = {"Without an obstacle the case fails in:"};
  for (const BlamedPart& part : blame.singles) {
    figure.effects.push_back(part.effect);
    figure.lines.push_back(
        fmt::format("{}:  {}{}", NamesOf(part), OutOf(part.without), part.to_blame ? ", to blame" : ""));
  }
  figure.lines.insert(figure.lines.end(),
                      {"", "Red: by how much less it fails without", "Blue: where robots stayed for 5 s,",
                       fmt::format("in {} runs of the whole case", blame.whole.runs())});
  return figure;
}

Blame BlameIn(const CaseAnswer& answer) {
  CaseBlame question(answer.test_case.obstacles, BlameReplicates(*answer.experiment));
  TellAll(answer, question);
  Blame blame;
  blame.name = answer.name;
  blame.run = answer.run;
  blame.test_case = answer.test_case;
  blame.runs = answer.runs.size();
  blame.whole = question.parts().front().runs.tally;
  for (const CaseBlame::Part& part : question.parts()) {
    if (part.without.size() == 1) blame.singles.push_back(PartOf(part, blame.whole));
    if (part.without.size() == 2) blame.pairs.push_back(PartOf(part, blame.whole));
  }
  for (const CaseRun& run : answer.runs) {
    if (!run.as_it_is) continue;
    const Whereabouts& where = run.whereabouts;
    blame.stuck.insert(blame.stuck.end(), where.stuck.begin(), where.stuck.end());
    blame.failing_robots += where.failing_robots;
    for (BlamedPart& part : blame.singles) part.touched += where.touched[part.obstacles.front()];
  }
  return blame;
}

Question BlameQuestion() {
  return {
      .name = "blame",
      .summary = "which obstacle of a case breaks the swarm?",
      .help = kBlameHelp,
      .named = Question::Named::kOne,
      .options = {{"--replicates", "N", "runs of the case and of it without each obstacle (default: 30)"}},
      .cases = CasesToBlame,
      .about = AboutBlame,
      .tell = TellBlame,
      .page_title = "What each of its obstacles does"};
}

}  // namespace gauntlet
