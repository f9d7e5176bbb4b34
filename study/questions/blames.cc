#include "study/questions/blames.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "master/campaign/stored_search.h"
#include "search/given/blame_search.h"
#include "study/questions/answered_calls.h"

namespace gauntlet {
namespace {

constexpr double kStays = 0.05;  // m: a robot that drives covers five times as much between two waypoints

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

// Where robots were in one run of the case as it is.
void AddWays(const RunOutcome& run, bool failed, Blame& blame) {
  const bool any_lost = std::ranges::any_of(run.robots, &sim::RobotSummary::lost);
  for (const sim::RobotSummary& robot : run.robots) {
    for (std::size_t i = 1; i < robot.waypoints.size(); ++i) {
      if ((robot.waypoints[i] - robot.waypoints[i - 1]).norm() < kStays)
        blame.stuck.push_back(robot.waypoints[i]);
    }
    if (!failed || (any_lost && !robot.lost)) continue;
    ++blame.failing_robots;
    for (BlamedPart& part : blame.singles) {
      const sim::ObstacleGene& obstacle = blame.test_case.obstacles[part.obstacles.front()];
      if (CountVisits(robot, obstacle) > 0) ++part.touched;
    }
  }
}

Status AddWaysOfRuns(const AnsweredSearch& answered, IndividualId individual, Blame& blame) {
  const std::string_view failing = FailingOf(answered.experiment);
  return answered.store.ForEachRun(answered.id, 0, [&](const StoredRun& stored) -> Status {
    if (stored.individual != individual) return Ok{};
    TRY(const RunOutcome run, OutcomeOf(stored, /*with_metrics=*/true, /*with_ways=*/true));
    FailureTally tally;
    tally.Add(run, failing);
    AddWays(run, tally.failures > 0, blame);
    return Ok{};
  });
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

}  // namespace

std::string NamesOf(const BlamedPart& part) {
  std::string names;
  for (const std::size_t obstacle : part.obstacles) {
    names += fmt::format("{}{}", names.empty() ? "" : " and ", obstacle + 1);
  }
  return names;
}

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

CallPlan PlanBlame(const std::string& dir, const QuestionedCampaign& questioned, int replicates) {
  return PlanCall(dir + "/blame", questioned, [replicates](const Experiment& experiment) {
    return BlameExperiment(experiment, replicates);
  });
}

Result<std::vector<Blame>> ReadBlames(const std::string& directory) {
  std::vector<Blame> all;
  const auto add = [&](const AnsweredSearch& answered) -> Status {
    const auto& search = dynamic_cast<const BlameSearch&>(answered.search);
    for (std::size_t i = 0; i < search.Population().size(); ++i) {
      const std::vector<CaseBlame::Part>& parts = search.BlameOf(i).parts();
      Blame& blame = all.emplace_back();
      blame.test_case = search.Population()[i].test_case;
      blame.name = blame.test_case.name;
      blame.run = RunOfName(blame.name);
      blame.whole = parts.front().runs.tally;
      blame.runs = search.RunsOf(i);
      for (const CaseBlame::Part& part : parts) {
        if (part.without.size() == 1) blame.singles.push_back(PartOf(part, blame.whole));
        if (part.without.size() == 2) blame.pairs.push_back(PartOf(part, blame.whole));
      }
      TRY(AddWaysOfRuns(answered, i + 1, blame));
    }
    return Ok{};
  };
  TRY(ForEachAnswer(directory, add));
  return all;
}

Result<std::vector<Blame>> ReadAllBlames(const std::string& dir) {
  std::vector<Blame> all;
  for (const std::string& call : CallsIn(dir + "/blame")) {
    Result<std::vector<Blame>> some = ReadBlames(call);
    if (!some && HasNothingYet(some.error())) continue;
    if (!some) return some.error();
    for (Blame& one : *some) all.push_back(std::move(one));
  }
  return all;
}

}  // namespace gauntlet
