#include "master/report/minimisations.h"

#include <fmt/format.h>

#include <utility>

#include "master/report/answered_calls.h"
#include "master/report/smallest_layouts.h"
#include "master/search/minimisation_search.h"

namespace gauntlet::master {
namespace {

proto::CaseFailures FailuresOf(const FailureTally& tally) {
  const analysis::Interval interval = FailureInterval(tally);
  return {tally.failures, tally.runs(), {interval.low, interval.high}};
}

proto::CaseLineage LineageOf(const Minimisation& one, std::string_view failing) {
  proto::CaseLineage lineage;
  lineage.made_by = "minimise";
  lineage.failing = failing;
  lineage.parent = one.original;
  for (const MinimisingStep& step : one.steps) {
    proto::CaseStep& written = lineage.steps.emplace_back();
    written.change = DescribeStep(step);
    for (const std::size_t obstacle : step.layout.kept)
      written.obstacles.push_back(static_cast<int>(obstacle) + 1);
    written.found = FailuresOf(step.found);
  }
  lineage.verified = FailuresOf(one.verified.tally);
  return lineage;
}

Minimisation Found(const sim::TestCase& original, const CaseMinimiser& minimiser,
                   const std::string& scenario) {
  Minimisation one;
  one.name = original.name;
  one.run = RunOfName(one.name);
  one.original = original;
  one.outcome = minimiser.outcome();
  one.found = minimiser.original();
  one.empty = minimiser.empty();
  one.smallest.test_case = original;
  one.has_place = FailurePlaceOf(scenario) != nullptr;
  if (one.outcome != MinimisedTo::kLayout) return one;
  one.steps = minimiser.steps();
  one.verified = minimiser.verification();
  one.interval = FailureInterval(one.verified.tally);
  one.same_way = minimiser.SameFailures(one.verified);
  one.smallest.test_case.obstacles = minimiser.layout().obstacles;
  one.smallest.test_case.name = fmt::format("{}, minimised", one.name);
  one.smallest.lineage = LineageOf(one, FailingOf(scenario));
  return one;
}

}  // namespace

std::string DescribeStep(const MinimisingStep& step) {
  switch (step.change) {
    case MinimisingStep::Change::kNone:
      return "as it is";
    case MinimisingStep::Change::kNearest:
      return fmt::format("the {} nearest", step.layout.kept.size());
    case MinimisingStep::Change::kWithout:
      return fmt::format("without obstacle {}", step.obstacle + 1);
    case MinimisingStep::Change::kShortened:
      return fmt::format("obstacle {} made {:.1f} m long", step.obstacle + 1, step.length);
  }
  return "";
}

CallPlan PlanMinimisation(const std::string& dir, const QuestionedCampaign& questioned, bool shorten) {
  return PlanCall(dir + kMinimiseFolder, questioned,
                  [shorten](const Experiment& experiment) { return MinimisationOf(experiment, shorten); });
}

Result<std::vector<Minimisation>> ReadMinimisations(const std::string& directory) {
  std::vector<Minimisation> all;
  const auto add = [&](const AnsweredSearch& answered) -> Status {
    const auto& search = dynamic_cast<const MinimisationSearch&>(answered.search);
    for (std::size_t i = 0; i < search.Population().size(); ++i) {
      all.push_back(
          Found(search.Population()[i].test_case, search.MinimiserOf(i), answered.experiment.scenario));
      all.back().runs = search.RunsOf(i);
      if (all.back().outcome == MinimisedTo::kError) all.back().message = answered.first_message(i + 1);
    }
    return Ok{};
  };
  if (Status read = ForEachAnswer(directory, add); !read) return read.error();
  return all;
}

}  // namespace gauntlet::master
