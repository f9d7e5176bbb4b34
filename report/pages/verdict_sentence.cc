#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "proto/run_text.h"
#include "report/pages/campaign_pages.h"
#include "report/tables/conditions.h"
#include "report/tables/summary_tables.h"

namespace gauntlet {
namespace {

std::string Percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

// "swarm of birds"
std::string SwarmOf(const CampaignFacts& facts) {
  const Experiment& experiment = facts.plans.front().experiment;
  return fmt::format("swarm of {}s", controllers::DeclaredScenario(experiment).style.member);
}

// How the share of failures grew, over all searches.
std::string Learning(const std::vector<SearchCourse>& courses) {
  double first = 0.0;
  double last = 0.0;
  double searches = 0.0;
  for (const SearchCourse& course : courses) {
    for (const std::vector<CourseBlock>& blocks : course.repeats) {
      if (blocks.size() < 2) continue;
      searches += 1.0;
      first += blocks.front().failure_share;
      last += blocks.back().failure_share;
    }
  }
  if (searches == 0.0) return "";
  return fmt::format(" Of the first runs that a search spent {} failed, of the last {}.",
                     Percent(first / searches), Percent(last / searches));
}

std::string Toughest(const CampaignFacts& facts) {
  if (const Confirmation* one = ToughestOf(facts.answers.confirmations))
    return fmt::format(" The toughest test case, that of run {}, failed in {} runs with fresh seeds.",
                       proto::RunText(one->run), OutOf(one->tally));
  const auto toughest = ToughestCaseOf(facts.summary);
  if (!toughest || toughest->member->failing_runs == 0) return "";
  const PopulationMember& member = *toughest->member;
  const std::string run = proto::RunText(toughest->run);
  const std::string fails =
      fmt::format("{} of {} runs", FormatCount(member.failing_runs), FormatCount(member.runs.size()));
  const SearchSummary* only = facts.summary.OnlySearch();
  if (only != nullptr && !only->archive.failures.empty())
    return fmt::format(
        " The smallest layout that breaks it, that of run {}, has {} and made it fail in {}, which took part "
        "in choosing it.",
        run, Counted(member.genome.size(), "obstacle"), fails);
  return toughest->as_tough == 1
             ? fmt::format(" The toughest test case, that of run {}, made it fail in {}.", run, fails)
             : fmt::format(" One of the {} toughest test cases, that of run {}, made it fail in {}.",
                           FormatCount(toughest->as_tough), run, fails);
}

std::string Confirmed(const CampaignFacts& facts) {
  const auto& confirmations = facts.answers.confirmations;
  if (confirmations.empty()) return "";
  const auto failing = std::ranges::count(confirmations, FailureVerdict::kFail, &Confirmation::verdict);
  return fmt::format(
      " Of {} test cases that were simulated again with fresh seeds, {} failed in at least half "
      "of these runs.",
      FormatCount(confirmations.size()), failing);
}

// What the runs came to.
std::string CourseOf(const CampaignPages& pages) {
  const CampaignFacts& facts = pages.facts;
  const CampaignSummary& summary = facts.summary;
  if (summary.runs_done == 0) return "Nothing has been simulated yet.";
  if (summary.runs_failed == summary.runs_done)
    return fmt::format("No run gave a result: of {} runs none could be simulated to its end.",
                       FormatCount(summary.runs_done));
  if (const auto settings = SettingsAnswerOf(facts)) return settings->outcome;
  // What is counted as failing is what the empty arena is asked for too.
  if (summary.failing_runs == 0) {
    return fmt::format("The {} held out: in none of {} runs did it fail.{}", SwarmOf(facts),
                       FormatCount(summary.runs_done), Confirmed(facts));
  }
  if (const std::vector<Condition> conditions = ConditionsOf(summary); conditions.size() > 1) {
    const auto broke =
        std::ranges::count_if(conditions, [](const Condition& one) { return one.failing_runs > 0; });
    return fmt::format("The {} broke under {} of {} conditions: {} of the runs failed.{}", SwarmOf(facts),
                       broke, conditions.size(), RangeOf(conditions), Confirmed(facts));
  }
  const double share = static_cast<double>(summary.failing_runs) / static_cast<double>(summary.runs_done);
  return fmt::format("The {} broke: it failed in {} of {} runs ({}).{}{}{}", SwarmOf(facts),
                     FormatCount(summary.failing_runs), FormatCount(summary.runs_done), Percent(share),
                     Learning(pages.courses), Toughest(facts), Confirmed(facts));
}

}  // namespace

std::string VerdictOf(const CampaignPages& pages) {
  const CampaignFacts& facts = pages.facts;
  const std::string course = CourseOf(pages);
  if (facts.summary.failing_runs == 0 || !HasBaseline(facts.plans.front().experiment.search.algorithm))
    return course;
  const bool several = ConditionsOf(facts.summary).size() > 1;
  if (several && facts.answers.baselines.empty()) return course;  // one of them may be the empty arena
  const std::string baseline = InWords(facts.answers.baselines, "gauntlet", facts.directory);
  return Matters(facts.answers.baselines) ? baseline + " " + course : course + " " + baseline;
}

}  // namespace gauntlet
