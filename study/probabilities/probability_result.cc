#include "study/probabilities/probability_result.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/comparison.h"
#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "controllers/registry.h"
#include "controllers/requirements/requirements.h"
#include "master/campaign/stored_campaign.h"
#include "master/campaign/stored_search.h"
#include "proto/json_text.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "search/failure_tally.h"
#include "search/probability/confidence_sequence.h"
#include "study/sets/failure_mechanism.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostTold = 5;  // failures
constexpr std::size_t kMostGroups = 10;
constexpr const char* kMixed = "mixed";

using Json = nlohmann::ordered_json;

std::string ShortText(double probability) {
  return fmt::format("{:.3g}", probability);
}
std::string IntervalText(const ProbabilityEstimate& estimate) {
  return fmt::format("{} to {}", ShortText(estimate.interval.low), ShortText(estimate.interval.high));
}

// What happened in a failed run: by its metrics, by the requirement that was violated first, by its numbered
// type; "mixed" where nothing of it is known.
std::string GroupOf(const controllers::ScenarioInfo& scenario, const sim::TestCase& test_case,
                    const RunOutcome& outcome) {
  if (!outcome.completed()) return "ended without a result";
  if (std::string mechanism = MechanismOf(scenario, test_case, outcome.metrics, {}); !mechanism.empty())
    return mechanism;
  const std::string begin = fmt::format("{}.", controllers::requirements::kViolatedAt);
  const std::pair<std::string, double>* first = nullptr;
  for (const auto& metric : outcome.metrics) {
    const bool violated = metric.first.starts_with(begin) && metric.second >= 0.0;
    if (violated && (first == nullptr || metric.second < first->second)) first = &metric;
  }
  if (first != nullptr) return "violates " + first->first.substr(begin.size());
  const controllers::FailureType* type = scenario.failure_types.Find(outcome.failure_type);
  return type == nullptr ? kMixed : type->name;
}

// The failed runs by the numbers of their samples.
Result<std::map<std::uint64_t, LikelyFailure>> FailuresIn(const SearchPlan& plan, ResultStore& store,
                                                          SearchAlgorithm& search) {
  std::map<std::uint64_t, LikelyFailure> failures;
  const std::string_view failing = FailingOf(plan.experiment);
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(plan.experiment);
  const std::size_t given = search.Population().size();
  const auto take = [&](const StoredRun& run, const RunOutcome& outcome) -> Status {
    const bool crashed = !outcome.completed() && outcome.verdict != sim::Verdict::kRefused;
    if (!crashed && !Fails(outcome, failing)) return Ok{};
    LikelyFailure failure{.run = run.id};
    failure.robustness =
        controllers::ReportedValue(outcome.metrics, controllers::requirements::kRobustness).value_or(-1.0);
    TRY(const auto spec, proto::DecodeRunSpec(run.spec));
    failure.group = GroupOf(scenario, spec.test_case, outcome);
    failures.emplace(run.individual - given, std::move(failure));
    return Ok{};
  };
  TRY(RestoreSearch(plan.id, store, search, {.take = take, .with_metrics = true}));
  return failures;
}

// How the probability falls on the groups.
std::vector<FailureShare> SharesOf(const ProbabilityCourse& course,
                                   const std::map<std::uint64_t, LikelyFailure>& failures,
                                   const ProbabilityEstimate& whole) {
  std::map<std::string, std::vector<FailedSample>> samples;
  for (const FailedSample& one : course.Failed()) samples[failures.at(one.number).group].push_back(one);
  const double confidence =
      1.0 - (1.0 - analysis::kConfidence) / std::max<double>(1.0, static_cast<double>(samples.size()));
  std::vector<FailureShare> shares;
  for (const auto& [group, its] : samples) {
    FailureShare share{.group = group, .failures = its.size()};
    if (whole.repeats.empty()) {
      share.probability = {
          .estimate = static_cast<double>(its.size()) / static_cast<double>(course.plain_runs()),
          .interval = ConfidenceSequence(its.size(), course.plain_runs(), confidence)};
    } else {
      std::vector<double> repeats(whole.repeats.size());
      for (const FailedSample& one : its)
        repeats[one.repeat] += one.share * whole.estimate * static_cast<double>(repeats.size());
      share.probability = EstimateOfRepeats(std::move(repeats), confidence);
    }
    shares.push_back(std::move(share));
  }
  std::ranges::stable_sort(shares, std::greater{},
                           [](const FailureShare& one) { return one.probability.estimate; });
  return shares;
}

std::vector<LikelyFailure> LikeliestOf(const ProbabilityCourse& course,
                                       std::map<std::uint64_t, LikelyFailure> failures) {
  std::vector<LikelyFailure> likeliest;
  std::set<std::uint64_t> seen;  // of splitting, copies
  for (const FailedSample& one : course.Failed()) {
    if (!seen.insert(one.number).second) continue;
    LikelyFailure& failure = failures.at(one.number);
    failure.density = course.conditions().DensityOf(course.SampleOf(one.number));
    likeliest.push_back(std::move(failure));
  }
  std::ranges::stable_sort(likeliest, {},
                           [](const LikelyFailure& one) { return std::pair(-one.density, one.robustness); });
  return likeliest;
}

std::string ReasonText(const ProbabilityCourse& course) {
  switch (course.reason()) {
    case SamplingReason::kFirst:
    case SamplingReason::kFrequent:
      return "Plain samples: each draws the conditions and a seed anew.";
    case SamplingReason::kAsked:
      return "Plain samples, as was asked for.";
    case SamplingReason::kNoScore:
      return "Plain samples: nothing says how near to failing a run was. With [requirements], rare failures "
             "take fewer runs.";
    case SamplingReason::kSeedDecides:
      return fmt::format(
          "Plain samples: the seed decides. What came nearest to failing came nearer than others in only "
          "{:.0f} % "
          "of the comparisons when its seed was drawn anew, so that splitting does not pay.",
          100.0 * course.pull());
    case SamplingReason::kFewRuns:
      return fmt::format(
          "Plain samples: too few runs were left for splitting, which needs {} particles in {} "
          "repeats.",
          ProbabilityCourse::kLeastParticles, ProbabilityCourse::kRepeats);
    case SamplingReason::kSplitting:
      return fmt::format(
          "Adaptive multilevel splitting by robustness: {} of {} plain samples failed, and those that came "
          "nearest came nearer than others in {:.0f} % of the comparisons when their seeds were drawn anew.",
          course.plain_failures(), FormatCount(course.plain_runs()), 100.0 * course.pull());
    case SamplingReason::kDearer:
      return fmt::format(
          "Plain samples: a first round of splitting, {} repeats, left a wider interval than as many plain "
          "samples "
          "would have.",
          ProbabilityCourse::kRepeats);
  }
  return "";
}

std::string EndText(const FailureProbability& one) {
  const ProbabilitySpec& spec = one.experiment.probability;
  switch (one.course().end()) {
    case ProbabilityEnd::kOpen:
      return "It has not come to its end.";
    case ProbabilityEnd::kNarrow:
      return fmt::format("It is known within {:.0f} %, which was asked for.", 100.0 * spec.within);
    case ProbabilityEnd::kBelow:
      return fmt::format("It is surely below {}.", spec.below);
    case ProbabilityEnd::kAbove:
      return fmt::format("It is surely above {}.", spec.below);
    case ProbabilityEnd::kBudget:
      break;
  }
  if (spec.below > 0.0)
    return fmt::format("Whether it is below {} is not decided by {}.", spec.below,
                       Counted(one.course().runs(), "run"));
  if (spec.within == 0.0) return "All runs that were asked for were made.";
  return fmt::format("The runs ended before it was known within {:.0f} %.", 100.0 * spec.within);
}

// Half the width takes four times the runs; twice, as long as none has failed.
std::uint64_t RunsToHalve(const FailureProbability& one) {
  return (one.estimate.estimate == 0.0 ? 1 : 3) * one.course().runs();
}

Table ConditionsTable(const FailureProbability& one) {
  Table table({{"drawn", "key"}, {"from", "distribution"}});
  for (const VariedKey& key : one.course().varied()) {
    const std::string text = key.ToText();
    table.AddRow({key.key.path, text.substr(text.find('=') + 1)});
  }
  const std::string arenas =
      one.course().conditions().generates()
          ? fmt::format("the generator: {} each",
                        Counted(static_cast<std::uint64_t>(one.experiment.genome.genes), "obstacle"))
          : fmt::format("{}{}", Counted(one.given, "given case"),
                        one.experiment.probability.weights.empty() ? "" : ", with weights");
  table.AddRow({"arena", arenas});
  table.AddRow({"seed of the run, which also places the robots", "evenly"});
  return table;
}

Table GroupTable(const FailureProbability& one) {
  Table table({{"what happens", "group"},
               {">probability", "probability"},
               {"95 %, all at once", "interval"},
               {">failures", "failures"}});
  for (const FailureShare& share : one.groups) {
    table.AddRow({share.group, Cell(ShortText(share.probability.estimate), share.probability.estimate),
                  Cell(IntervalText(share.probability), IntervalCell(share.probability.interval).value),
                  CountCell(share.failures)});
  }
  return table;
}

Table LikeliestTable(const FailureProbability& one) {
  Table table(
      {{">run", "run"}, {">density", "density"}, {">robustness", "robustness"}, {"what happens", "group"}});
  for (std::size_t i = 0; i < std::min(one.likeliest.size(), kMostTold); ++i) {
    const LikelyFailure& failure = one.likeliest[i];
    table.AddRow({proto::RunText(failure.run), DigitsCell(failure.density, 3),
                  one.experiment.requirements.empty() ? TextCell("-") : DecimalCell(failure.robustness, 3),
                  failure.group});
  }
  return table;
}

const char* EndName(ProbabilityEnd end) {
  constexpr const char* kNames[] = {"open", "narrow", "below", "above", "budget"};
  return kNames[static_cast<int>(end)];
}
const char* ReasonName(SamplingReason reason) {
  constexpr const char* kNames[] = {"first",        "frequent", "asked",     "no-requirements",
                                    "seed-decides", "few-runs", "splitting", "dearer"};
  return kNames[static_cast<int>(reason)];
}

}  // namespace

Result<FailureProbability> ReadProbability(const std::string& dir) {
  TRY(const StoredCampaign campaign, OpenStoredCampaign(dir));
  ResultStore& store = *campaign.view.store;
  const SearchPlan& plan = campaign.plans.front();
  TRY(std::unique_ptr<SearchAlgorithm> search, MakeStoredSearch(plan, store));
  if (search->Probability() == nullptr)
    return InvalidInput(dir + " holds no failure probability: gauntlet probability makes one");
  TRY(auto failures, FailuresIn(plan, store, *search));
  FailureProbability one{.experiment = plan.experiment, .search = std::move(search)};
  const ProbabilityCourse& course = one.course();
  one.finished = course.AtEnd();
  one.given = one.search->Population().size();
  one.estimate = course.Estimate(analysis::kConfidence);
  one.groups = SharesOf(course, failures, one.estimate);
  one.likeliest = LikeliestOf(course, std::move(failures));
  return one;
}

std::string OutcomeOf(const FailureProbability& one) {
  const ProbabilityCourse& course = one.course();
  const ProbabilityEstimate& e = one.estimate;
  const std::string plain = fmt::format("{} of {}", FormatCount(course.plain_failures()),
                                        FormatCount(course.plain_runs()) + " plain samples");
  if (const auto reached = course.Reached(); reached && one.finished)
    return fmt::format(
        "The failure probability is hardly above {}: the runs ended while splitting was there. By {} "
        "that failed it is {} (95 %).",
        ShortText(*reached), plain, IntervalText(e));
  if (!e.repeats.empty() && e.estimate == 0.0)
    return fmt::format(
        "No repeat of splitting came to a failure; by {} that failed the failure probability is {} "
        "(95 %).",
        plain,
        IntervalText({.interval = ConfidenceSequence(course.plain_failures(), course.plain_runs(),
                                                     analysis::kConfidence)}));
  if (!e.repeats.empty())
    return fmt::format("The failure probability is {} ({}, 95 %): the mean of {} repeats of splitting.",
                       ShortText(e.estimate), IntervalText(e), e.repeats.size());
  if (course.plain_runs() == 0) return "No run has ended yet.";
  return fmt::format("The failure probability is {} ({}, 95 %): {} failed.",
                     e.estimate == 0.0 ? "at most " + ShortText(e.interval.high) : ShortText(e.estimate),
                     IntervalText(e), plain);
}

std::vector<Section> TellProbability(const FailureProbability& one, const std::string& dir,
                                     const std::string& program) {
  const ProbabilityCourse& course = one.course();
  const std::string place = PastedPath(dir);
  Section main{.title = "Failure probability of " + one.experiment.controller};
  main.lead = {fmt::format("{} runs over the conditions of {}; everything else is as in the experiment.",
                           FormatCount(course.runs()), one.experiment.name)};
  main.table = ConditionsTable(one);
  main.sentences = {OutcomeOf(one)};
  if (!one.finished) {
    main.commands = {{fmt::format("{} resume {}", program, place), "go on"}};
    return {std::move(main)};
  }
  main.sentences.push_back(EndText(one));
  main.sentences.push_back(ReasonText(course));
  main.sentences.push_back(fmt::format("{} About {} more would halve it.",
                                       one.estimate.valid_at_any_time
                                           ? "The interval holds whenever one stops (a confidence sequence)."
                                           : "The interval is Student's, of the repeats' logarithm.",
                                       FormatCount(RunsToHalve(one)) + " runs"));
  if (course.without_result() > 0)
    main.sentences.push_back(fmt::format("{} ended without a result, and counted as failed.",
                                         Counted(course.without_result(), "run")));
  if (course.refused() > 0)
    main.sentences.push_back(fmt::format("{} broke a rule of the scenario, and counted as not failed.",
                                         Counted(course.refused(), "sample")));
  std::vector<Section> sections = {std::move(main)};
  if (one.likeliest.empty()) return sections;
  Section groups{.title = "What it falls on", .table = GroupTable(one).First(kMostGroups)};
  if (one.groups.size() > kMostGroups)
    groups.sentences = {fmt::format("{} rarer ones: --json has them.", one.groups.size() - kMostGroups)};
  sections.push_back(std::move(groups));
  Section likeliest{.title = "Likeliest failures"};
  likeliest.table = LikeliestTable(one);
  likeliest.sentences = {
      "Density: of what was drawn, as a share of the largest that there is; arenas of one generator count "
      "equal. Of "
      "equal ones the least robust come first."};
  std::string runs;
  for (std::size_t i = 0; i < std::min(one.likeliest.size(), kMostTold); ++i)
    runs += " " + proto::RunText(one.likeliest[i].run);
  likeliest.commands = {
      {fmt::format("{} confirm {}{}", program, place, runs), "how often each fails, with fresh seeds"},
      {fmt::format("{} minimise {} {}", program, place, proto::RunText(one.likeliest.front().run)),
       "what of it is needed"},
      {fmt::format("{} corpus add {} {} --to corpus", program, place,
                   proto::RunText(one.likeliest.front().run)),
       "keep it, once it is confirmed"}};
  sections.push_back(std::move(likeliest));
  return sections;
}

std::string ProbabilityJson(const FailureProbability& one, const std::string& dir) {
  const ProbabilityCourse& course = one.course();
  Json json({{"directory", dir},
             {"finished", one.finished},
             {"probability", one.estimate.estimate},
             {"interval", {one.estimate.interval.low, one.estimate.interval.high}},
             {"valid_at_any_time", one.estimate.valid_at_any_time},
             {"end", EndName(course.end())},
             {"sampling", ReasonName(course.reason())},
             {"runs", course.runs()},
             {"plain", {{"k", course.plain_failures()}, {"n", course.plain_runs()}}},
             {"repeats", one.estimate.repeats},
             {"runs_to_halve", RunsToHalve(one)},
             {"without_result", course.without_result()},
             {"refused", course.refused()},
             {"outcome", OutcomeOf(one)}});
  json["below"] = one.experiment.probability.below > 0.0 ? Json(one.experiment.probability.below) : Json();
  json["groups"] = GroupTable(one).ToJson();
  json["likeliest"] = LikeliestTable(one).ToJson();
  return JsonText(json);
}

}  // namespace gauntlet
