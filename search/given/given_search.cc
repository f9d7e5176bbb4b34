#include "search/given/given_search.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "controllers/registry.h"
#include "search/failure_tally.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// m from a robot's centre to an obstacle up to which it is at the obstacle: its body and the range of its
// proximity ring.
constexpr double kAtObstacle = sim::foot_bot::kRadius + 0.1;

}  // namespace

std::uint64_t CountVisits(const sim::RobotSummary& robot, const sim::ObstacleGene& obstacle) {
  const sim::OrientedBox box = sim::BoxOf(obstacle);
  return static_cast<std::uint64_t>(std::ranges::count_if(robot.waypoints, [&](const sim::Vec2& place) {
    return sim::SquaredDistance(box, place) <= kAtObstacle * kAtObstacle;
  }));
}

RunJudge::RunJudge(const Experiment& experiment)
    : failing_(FailingOf(experiment)),
      leaves_out_refused_(StartsProgram(experiment)),
      failures_(controllers::DeclaredScenario(experiment).failures) {}

LayoutRuns RunJudge::WhatBecameOf(const RunOutcome& run, const sim::Genome& obstacles) const {
  LayoutRuns became;
  if (leaves_out_refused_ && run.verdict == sim::Verdict::kRefused) {
    ++became.tally.refused;
    return became;
  }
  became.tally.Add(run, failing_);
  const std::optional<sim::Vec2> place = failures_.PlaceOf(run.metrics);
  if (place && became.tally.failures > 0) became.places.push_back(*place);
  if (run.robots.empty()) return became;
  for (const sim::ObstacleGene& obstacle : obstacles) {
    std::uint64_t& visits = became.visits.emplace_back(0);
    for (const sim::RobotSummary& robot : run.robots) visits += CountVisits(robot, obstacle);
  }
  return became;
}

bool TellStored(std::span<const LayoutRuns> runs, int each, LayoutQuestion& question) {
  LayoutRuns batch;
  int waiting = 0;
  for (const LayoutRuns& run : runs) {
    if (waiting == 0) waiting = each * question.runs();
    if (waiting == 0) return false;
    batch.Add(run);
    if (--waiting == 0) question.Tell(std::exchange(batch, {}));
  }
  return true;
}

Experiment AboutCasesOf(const Experiment& experiment, std::string_view algorithm) {
  Experiment about = experiment;
  about.search = SearchSpec{};
  about.search.algorithm = algorithm;
  about.store.trajectories = about.store.trajectories || RowOf(about).reads_trajectories;
  return about;
}

GivenSearch::GivenSearch(const SearchSetup& setup)
    : PopulationSearch(setup), judge_(setup.experiment), cases_(setup.cases.size()) {
  for (std::size_t index = 0; index < setup.cases.size(); ++index) {
    const Individual& original = population_.emplace_back(MakeIndividual(index + 1, setup.cases[index]));
    Case& one = cases_[index];
    one.question = setup.row->question(setup.experiment, original.test_case.obstacles);
    one.layouts.emplace(sim::GenomeHash(original.test_case.obstacles), original);
    missing_ += static_cast<std::uint64_t>(one.Missing());
    case_of_.push_back(index);
  }
  newborns_ = population_;
}

Result<std::unique_ptr<GivenSearch>> GivenSearch::Create(const SearchSetup& setup) {
  return std::unique_ptr<GivenSearch>(new GivenSearch(setup));
}

std::vector<EvaluationRequest> GivenSearch::Ask() {
  if (evaluations_done_ == 0 && AtBoundary()) {
    for (std::size_t index = 0; index < cases_.size(); ++index) AskMore(index);
  }
  return std::exchange(requests_, {});
}

void GivenSearch::AskMore(std::size_t index) {
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

void GivenSearch::Told(const EvaluationOutcome& outcome) {
  const std::size_t index = case_of_[outcome.individual - 1];
  Case& one = cases_[index];
  const sim::Genome& obstacles = one.question->layout().obstacles;
  Individual& layout = one.layouts.at(sim::GenomeHash(obstacles));
  Record(outcome, layout);
  if (layout.id == index + 1) population_[index] = layout;
  for (const RunOutcome& run : outcome.runs) one.batch.Add(judge_.WhatBecameOf(run, obstacles));
  --missing_;
  if (--one.waiting > 0) return;
  one.question->Tell(std::exchange(one.batch, {}));
  missing_ += static_cast<std::uint64_t>(one.Missing());
  AskMore(index);
}

SearchProgress GivenSearch::Progress() const {
  return {.generation = evaluations_done_ > 0 || !AtBoundary() ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = evaluations_done_ + missing_,
          .individuals_planned = case_of_.size(),
          .finished = missing_ == 0};
}

Status GivenSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  // Evaluations are asked for as long as a case is open, so a state is saved before all of them or at the
  // end. What was simulated follows from what was told.
  newborns_ = population_;
  const std::uint64_t told = std::exchange(evaluations_done_, 0);
  if (told == 0) return Ok{};
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
