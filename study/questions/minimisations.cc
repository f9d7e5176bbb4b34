#include "study/questions/minimisations.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "search/given/minimisation_search.h"
#include "study/questions/answered_calls.h"
#include "study/questions/smallest_layouts.h"

namespace gauntlet {
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

void Name(Minimisation& one, const std::string& name) {
  one.name = name;
  one.run = RunOfName(name);
  one.original.name = name;
  if (!one.smallest.lineage) return;
  one.smallest.test_case.name = fmt::format("{}, minimised", name);
  one.smallest.lineage->parent.name = name;
}

Minimisation Found(const sim::TestCase& original, const CaseMinimiser& minimiser,
                   const Experiment& experiment) {
  Minimisation one;
  one.original = original;
  one.outcome = minimiser.outcome();
  one.found = minimiser.original();
  one.empty = minimiser.empty();
  one.smallest.test_case = original;
  Name(one, original.name);
  one.has_place = FailurePlaceOf(experiment) != nullptr;
  if (one.outcome != MinimisedTo::kLayout) return one;
  one.steps = minimiser.steps();
  one.verified = minimiser.verification();
  one.interval = FailureInterval(one.verified.tally);
  one.same_way = minimiser.SameFailures(one.verified);
  one.smallest.test_case.obstacles = minimiser.layout().obstacles;
  one.smallest.lineage = LineageOf(one, FailingOf(experiment));
  Name(one, original.name);
  return one;
}

// What the call in the directory has found, when it has come to its end.
Status AddAnswersOf(const std::string& directory, std::vector<Minimisation>& all) {
  return ForEachAnswer(directory, [&](const AnsweredSearch& answered) -> Status {
    const auto& search = dynamic_cast<const MinimisationSearch&>(answered.search);
    for (std::size_t i = 0; i < search.Population().size(); ++i) {
      const sim::TestCase& original = search.Population()[i].test_case;
      all.push_back(Found(original, search.MinimiserOf(i), answered.experiment));
      Minimisation& one = all.back();
      one.key = KeyOfCase(answered.experiment, original);
      one.directory = directory;
      one.runs = search.RunsOf(i);
      if (one.outcome == MinimisedTo::kError) one.message = answered.first_message(i + 1);
    }
    return Ok{};
  });
}

std::uint64_t KeyOf(const QuestionedCampaign& questioned, const CaseInQuestion& one, bool shorten) {
  return KeyOfCase(MinimisationOf(questioned.plans[one.search].experiment, shorten), one.test_case);
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

CallPlan PlanMinimisation(const std::string& dir, const QuestionedCampaign& questioned, bool shorten,
                          const std::vector<Minimisation>& known) {
  QuestionedCampaign open = questioned;
  std::erase_if(open.cases, [&](const CaseInQuestion& one) {
    return std::ranges::find(known, KeyOf(open, one, shorten), &Minimisation::key) != known.end();
  });
  return PlanCall(dir + kMinimiseFolder, open,
                  [shorten](const Experiment& experiment) { return MinimisationOf(experiment, shorten); });
}

Result<std::vector<Minimisation>> ReadMinimisations(const std::string& dir) {
  std::vector<Minimisation> all;
  for (const std::string& call : CallsIn(dir + kMinimiseFolder)) {
    const Status read = AddAnswersOf(call, all);
    if (!read && !HasNothingYet(read.error())) return read.error();
  }
  return all;
}

std::vector<Minimisation> AnswersTo(const QuestionedCampaign& questioned, bool shorten,
                                    const std::vector<Minimisation>& known) {
  std::vector<Minimisation> answers;
  for (const CaseInQuestion& one : questioned.cases) {
    const auto found = std::ranges::find(known, KeyOf(questioned, one, shorten), &Minimisation::key);
    if (found == known.end()) continue;
    answers.push_back(*found);
    Name(answers.back(), one.name);
  }
  return answers;
}

}  // namespace gauntlet
