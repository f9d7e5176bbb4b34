#include "study/questions/case_answer.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "controllers/registry.h"
#include "master/campaign/stored_check.h"
#include "master/campaign/verdict_text.h"
#include "master/directory/campaign_ownership.h"
#include "proto/run_codec.h"
#include "search/given/given_search.h"
#include "search/search_table.h"
#include "study/questions/questioned_cases.h"
#include "study/sets/failure_mechanism.h"

namespace gauntlet {
namespace {

Whereabouts WhereaboutsOf(const std::vector<sim::RobotSummary>& robots, bool failed,
                          const sim::Genome& obstacles) {
  Whereabouts where;
  where.touched.resize(obstacles.size());
  const bool any_lost = std::ranges::any_of(robots, &sim::RobotSummary::lost);
  for (const sim::RobotSummary& robot : robots) {
    for (std::size_t i = 1; i < robot.waypoints.size(); ++i) {
      if (StaysBetween(robot.waypoints[i - 1], robot.waypoints[i])) where.stuck.push_back(robot.waypoints[i]);
    }
    if (!failed || (any_lost && !robot.lost)) continue;
    ++where.failing_robots;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      if (CountVisits(robot, obstacles[i]) > 0) ++where.touched[i];
    }
  }
  return where;
}

Result<CaseRun> RunOf(const StoredRun& stored, const RunJudge& judge,
                      const controllers::ScenarioInfo& scenario, const Individual& layout, bool robots) {
  CaseRun run{.id = stored.id, .seed = stored.seed, .as_it_is = layout.parents.empty()};
  TRY(run.result, proto::DecodeStoredResult(stored.result));
  RunOutcome outcome{.verdict = run.result.verdict,
                     .fitness = run.result.fitness,
                     .total_failure = run.result.failure.total,
                     .metrics = std::move(run.result.metrics)};
  if (robots) outcome.robots = std::exchange(run.result.robots, {});
  run.became = judge.WhatBecameOf(outcome, layout.test_case.obstacles);
  if (robots && run.as_it_is) {
    const bool failed = run.became.tally.failures > 0;
    run.whereabouts = WhereaboutsOf(outcome.robots, failed, layout.test_case.obstacles);
    if (failed)
      run.whereabouts.mechanism = MechanismOf(scenario, layout.test_case, outcome.metrics, outcome.robots);
  }
  run.result.metrics = std::move(outcome.metrics);
  run.result.robots.clear();
  return run;
}

// The cases of one search.
Status AddAnswers(const SearchPlan& plan, std::size_t number, bool finished, ResultStore& store, CaseKey key,
                  std::vector<CaseAnswer>& answers) {
  const auto experiment = std::make_shared<const Experiment>(plan.experiment);
  const SearchRow& row = RowOf(*experiment);
  const auto id = static_cast<SearchId>(number + 1);
  const std::size_t first = answers.size();
  TRY(const auto layouts, store.LoadIndividuals(id));
  for (const Individual& one : layouts) {
    if (!one.parents.empty()) continue;
    answers.push_back({.name = CurrentName(one.test_case.name),
                       .run = RunOfName(one.test_case.name),
                       .search = number,
                       .test_case = one.test_case,
                       .experiment = experiment,
                       .key = key(*experiment, one.test_case)});
  }
  const RunJudge judge(*experiment);
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(*experiment);
  TRY(store.ForEachRun(id, 0, [&](const StoredRun& stored) -> Status {
    if (stored.individual < 1 || stored.individual > layouts.size()) return Ok{};
    const Individual& layout = layouts[static_cast<std::size_t>(stored.individual - 1)];
    const auto of_case = layout.parents.empty() ? layout.id : layout.parents.front();
    TRY(CaseRun run, RunOf(stored, judge, scenario, layout, row.reads_trajectories));
    answers.at(first + static_cast<std::size_t>(of_case - 1)).runs.push_back(std::move(run));
    return Ok{};
  }));
  for (std::size_t i = first; i < answers.size(); ++i) {
    CaseAnswer& one = answers[i];
    const auto question = row.question(*experiment, one.test_case.obstacles);
    std::vector<LayoutRuns> became;
    for (const CaseRun& run : one.runs) became.push_back(run.became);
    if (!TellStored(became, experiment->search.replicates, *question))
      return Error{ErrorKind::kCorrupt, fmt::format("{} has more runs than were asked for", one.name)};
    one.decided = question->runs() == 0;
    one.ended = finished;
  }
  return Ok{};
}

// Whether a call that cannot be read has nothing to tell yet: it is just being made, or its master just ends.
bool HasNothingYet(const Error& error) {
  return error.kind == ErrorKind::kNotFound || error.kind == ErrorKind::kInUse;
}

}  // namespace

FailureTally CaseAnswer::tally() const {
  LayoutRuns all;
  for (const CaseRun& one : runs) {
    if (one.as_it_is) all.Add(one.became);
  }
  return all.tally;
}

std::string CaseAnswer::Message() const {
  const auto first = std::ranges::find_if(
      runs, [](const CaseRun& one) { return one.result.verdict != sim::Verdict::kCompleted; });
  return first == runs.end() ? "" : first->result.message;
}

CaseAnswer Renamed(CaseAnswer answer, const std::string& name) {
  answer.name = answer.test_case.name = name;
  answer.run = RunOfName(name);
  return answer;
}

void TellAll(const CaseAnswer& answer, LayoutQuestion& question) {
  std::vector<LayoutRuns> became;
  for (const CaseRun& run : answer.runs) became.push_back(run.became);
  (void)TellStored(became, answer.experiment->search.replicates, question);
}

std::vector<std::string> CallsIn(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> calls;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    calls.push_back(entry.path().string());
  std::ranges::sort(calls);
  return calls;
}

Result<std::vector<CaseAnswer>> AnswersIn(const std::vector<SearchPlan>& plans, ResultStore& store,
                                          const std::string& directory, CaseKey key) {
  std::vector<CaseAnswer> answers;
  TRY(const auto searches, store.LoadSearches());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const bool finished = i < searches.size() && searches[i].finished_with > 0;
    TRY(AddAnswers(plans[i], i, finished, store, key, answers));
  }
  for (CaseAnswer& one : answers) one.campaign = directory;
  return answers;
}

Result<std::vector<CaseAnswer>> AnswersOfCall(const std::string& directory, CaseKey key) {
  const Result<CampaignView> campaign = ViewCampaign(directory, Checked::kRows);
  if (!campaign && HasNothingYet(campaign.error())) return std::vector<CaseAnswer>();
  if (!campaign) return campaign.error();
  TRY(const auto plans, ReadSearchPlans(campaign->directory));
  TRY(CheckStored(plans, *campaign->store, Checked::kRows));
  return AnswersIn(plans, *campaign->store, directory, key);
}

Result<std::vector<CaseAnswer>> AnswersOfCalls(const std::string& folder, CaseKey key) {
  std::vector<CaseAnswer> all;
  for (const std::string& call : CallsIn(folder)) {
    TRY(std::vector<CaseAnswer> some, AnswersOfCall(call, key));
    std::ranges::move(some, std::back_inserter(all));
  }
  return all;
}

std::vector<CaseAnswer> BestOf(std::vector<CaseAnswer> answers) {
  std::vector<CaseAnswer> best;
  std::map<std::uint64_t, std::size_t> place;
  for (CaseAnswer& one : answers) {
    if (!one.decided) continue;
    const auto [known, is_new] = place.try_emplace(one.key, best.size());
    if (is_new) {
      best.push_back(std::move(one));
    } else if (one.runs.size() > best[known->second].runs.size()) {
      best[known->second] = std::move(one);
    }
  }
  return best;
}

std::string OutOf(const FailureTally& tally) {
  return fmt::format("{} of {}", tally.failures, tally.runs());
}

analysis::Interval FailureInterval(const FailureTally& tally) {
  if (tally.runs() == 0) return {0.0, 1.0};
  return analysis::WilsonInterval(static_cast<std::uint32_t>(tally.failures),
                                  static_cast<std::uint32_t>(tally.runs()), analysis::kConfidence);
}

Table TableOf(std::span<const CaseRun> runs) {
  Table table({ForPrograms("id"), ForPrograms("seed"), ForPrograms("fitness"), ForPrograms("verdict"),
               ForPrograms("metrics"), ForPrograms("failure"), ForPrograms("hash"), ForPrograms("message?")});
  for (const CaseRun& run : runs) {
    const sim::RunResult& result = run.result;
    const bool completed = result.verdict == sim::Verdict::kCompleted;
    nlohmann::ordered_json metrics = nlohmann::ordered_json::object();
    for (const auto& [name, value] : result.metrics) metrics[name] = JsonValue(NumberValue(value));
    table.AddRow({run.id, fmt::format("{}", run.seed), completed ? Cell(result.fitness) : Cell(),
                  NameOf(result.verdict), JsonCell(std::move(metrics)),
                  JsonCell({{"total", result.failure.total},
                            {"type", result.failure.type >= 0 ? nlohmann::ordered_json(result.failure.type)
                                                              : nlohmann::ordered_json()},
                            {"label", result.failure.label}}),
                  fmt::format("{:016x}", result.hash), completed ? TextCell("") : Cell(result.message)});
  }
  return table;
}

}  // namespace gauntlet
