#include "search/given/layout_search.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "controllers/registry.h"

namespace gauntlet {
namespace {

// m from a robot's centre to an obstacle up to which it is at the obstacle: its body and the range of its
// proximity ring.
constexpr double kAtObstacle = sim::foot_bot::kRadius + 0.1;

std::optional<double> MetricOf(const RunOutcome& run, std::string_view name) {
  const auto found = std::ranges::find(run.metrics, name, &std::pair<std::string, double>::first);
  if (found == run.metrics.end() || found->second == controllers::kNowhere) return std::nullopt;
  return found->second;
}

std::optional<sim::Vec2> PlaceOfFailure(const RunOutcome& run, const controllers::FailurePlace* declared) {
  if (declared == nullptr) return std::nullopt;
  const std::optional<double> x = MetricOf(run, declared->x);
  const std::optional<double> y = MetricOf(run, declared->y);
  return x && y ? std::optional(sim::Vec2(*x, *y)) : std::nullopt;
}

}  // namespace

const controllers::FailurePlace* FailurePlaceOf(const Experiment& experiment) {
  const auto* info = controllers::FindScenario(experiment);
  return info == nullptr || !info->failure_place ? nullptr : &*info->failure_place;
}

std::uint64_t CountVisits(const sim::RobotSummary& robot, const sim::ObstacleGene& obstacle) {
  const sim::OrientedBox box = sim::BoxOf(obstacle);
  return static_cast<std::uint64_t>(std::ranges::count_if(robot.waypoints, [&](const sim::Vec2& place) {
    return sim::SquaredDistance(box, place) <= kAtObstacle * kAtObstacle;
  }));
}

Experiment LayoutExperiment(const Experiment& experiment, std::string_view algorithm) {
  Experiment about = experiment;
  about.search = SearchSpec{};
  about.search.algorithm = algorithm;
  about.store.trajectories = true;
  return about;
}

LayoutSearch::LayoutSearch(const SearchSetup& setup, std::vector<std::unique_ptr<LayoutQuestion>> questions)
    : PopulationSearch(setup),
      failing_(FailingOf(setup.experiment)),
      failure_place_(FailurePlaceOf(setup.experiment)),
      cases_(setup.cases.size()) {
  for (std::size_t index = 0; index < setup.cases.size(); ++index) {
    const Individual& original = population_.emplace_back(MakeIndividual(index + 1, setup.cases[index]));
    cases_[index].question = std::move(questions[index]);
    cases_[index].layouts.emplace(sim::GenomeHash(original.test_case.obstacles), original);
    case_of_.push_back(index);
  }
  newborns_ = population_;
}

std::vector<EvaluationRequest> LayoutSearch::Ask() {
  if (evaluations_done_ == 0 && AtBoundary()) {
    for (std::size_t index = 0; index < cases_.size(); ++index) AskMore(index);
  }
  return std::exchange(requests_, {});
}

void LayoutSearch::AskMore(std::size_t index) {
  Case& one = cases_[index];
  if (one.question->runs() == 0) return;
  const sim::Genome& obstacles = one.question->layout().obstacles;
  const auto [found, is_new] = one.layouts.try_emplace(sim::GenomeHash(obstacles));
  if (is_new) {
    case_of_.push_back(index);
    sim::TestCase test_case = population_[index].test_case;
    test_case.obstacles = obstacles;
    found->second = MakeIndividual(case_of_.size(), std::move(test_case));
    found->second.parents = {index + 1};
    newborns_.push_back(found->second);
  }
  for (; one.waiting < one.question->runs(); ++one.waiting)
    requests_.push_back(Request(found->second, 1, static_cast<std::uint32_t>(one.waiting)));
}

LayoutRuns LayoutSearch::WhatBecameOf(const RunOutcome& run, const sim::Genome& obstacles) const {
  LayoutRuns became;
  became.tally.Add(run, failing_);
  const std::optional<sim::Vec2> place = PlaceOfFailure(run, failure_place_);
  if (place && became.tally.failures > 0) became.places.push_back(*place);
  for (const sim::ObstacleGene& obstacle : obstacles) {
    std::uint64_t& visits = became.visits.emplace_back(0);
    for (const sim::RobotSummary& robot : run.robots) visits += CountVisits(robot, obstacle);
  }
  return became;
}

void LayoutSearch::Told(const EvaluationOutcome& outcome) {
  const std::size_t index = case_of_[outcome.individual - 1];
  Case& one = cases_[index];
  const sim::Genome& obstacles = one.question->layout().obstacles;
  Individual& layout = one.layouts.at(sim::GenomeHash(obstacles));
  Record(outcome, layout);
  if (layout.id == index + 1) population_[index] = layout;
  for (const RunOutcome& run : outcome.runs) one.batch.Add(WhatBecameOf(run, obstacles));
  ++one.runs;
  if (--one.waiting > 0) return;
  one.question->Tell(std::exchange(one.batch, {}));
  AskMore(index);
}

SearchProgress LayoutSearch::Progress() const {
  std::uint64_t missing = 0;
  for (const Case& one : cases_)
    missing += static_cast<std::uint64_t>(std::max(one.waiting, one.question->runs()));
  return {.generation = evaluations_done_ > 0 || !AtBoundary() ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = evaluations_done_ + missing,
          .individuals_planned = case_of_.size(),
          .finished = missing == 0};
}

Status LayoutSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  // Runs are asked for as long as a case is open, so a state is saved at the end only. What was simulated
  // follows from what was told.
  const std::uint64_t told = std::exchange(evaluations_done_, 0);
  std::vector<EvaluationRequest> asked = Ask();
  std::size_t next = 0;
  bool known = true;
  TRY(history([&](const EvaluationOutcome& outcome) {
    known = known && next < asked.size() && next < told && asked[next].individual == outcome.individual &&
            asked[next].evaluation == outcome.evaluation;
    if (!known) return;
    ++next;
    Tell(outcome);
    std::ranges::move(Ask(), std::back_inserter(asked));
  }));
  newborns_.clear();
  if (known && evaluations_done_ == told && Progress().finished) return Ok{};
  return Damaged("its evaluations are not those that it would ask for");
}

}  // namespace gauntlet
