#include "cli/output/examination_output.h"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/shell_quoted.h"
#include "master/directory/campaign_directory.h"
#include "master/directory/campaign_ownership.h"
#include "proto/json_text.h"
#include "proto/run_text.h"
#include "report/tables/distinct_failures.h"
#include "study/questions/question_table.h"

namespace gauntlet {
namespace {

constexpr std::size_t kMostLayouts = 3;

Result<std::uint64_t> RunsIn(const std::string& campaign) {
  TRY(const CampaignView view, ViewCampaign(campaign, Checked::kRows));
  TRY(const auto totals, view.store->LoadTotals());
  std::uint64_t runs = 0;
  for (const SearchTotals& one : totals) runs += one.runs;
  return runs;
}

// Of a campaign and of all that was asked about its cases.
Result<std::uint64_t> RunsOf(const std::string& campaign) {
  TRY(std::uint64_t runs, RunsIn(campaign));
  for (const auto question : kQuestions) {
    if (question().place != Question::Place::kCampaign) continue;
    for (const std::string& call : CallsIn(FolderOf(question(), campaign))) {
      if (!CampaignDirectory::IsCampaign(call)) continue;
      TRY(const std::uint64_t more, RunsIn(call));
      runs += more;
    }
  }
  return runs;
}

std::string FailsIn(std::uint64_t failures, std::uint64_t runs) {
  return fmt::format("fails in {} of {} runs", FormatCount(failures), FormatCount(runs));
}

// Of some that is known of a run.
std::string InWords(const FailureGrouping& grouping) {
  if (!grouping.Used())
    return fmt::format("does not repeat within a case; most often {} ({} of {} failed runs)",
                       grouping.overall->value, grouping.overall->runs, grouping.overall->of);
  constexpr std::size_t kMost = 3;
  std::vector<const DistinctFailure*> groups;
  for (const DistinctFailure& one : grouping.groups) groups.push_back(&one);
  std::ranges::stable_sort(groups, std::greater(), [](const DistinctFailure* one) { return one->share; });
  std::vector<std::string> parts;
  for (const DistinctFailure* one : groups) {
    if (parts.size() < kMost)
      parts.push_back(fmt::format("{} ({})", one->name, Counted(one->cases.size(), "case")));
  }
  if (groups.size() > kMost) parts.push_back(fmt::format("{} more", groups.size() - kMost));
  if (grouping.mixed > 0)
    parts.push_back(fmt::format("mixed ({})", Counted(static_cast<std::uint64_t>(grouping.mixed), "case")));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// What stands for a search that has found something.
void AddFailures(const CampaignFacts& search, Table& lines) {
  const CampaignAnswers& answers = search.answers;
  const auto confirmed =
      std::ranges::count(answers.confirmations, FailureVerdict::kFail, &Confirmation::verdict);
  lines.AddRow(
      {"obstacles", fmt::format("a search of {} runs ends with {}, of which {} break it in at least half of "
                                "fresh runs",
                                FormatCount(search.summary.runs_done),
                                Counted(answers.confirmations.size(), "layout"), confirmed)});
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  for (const FailureGrouping& one : distinct.groupings) {
    if (one.overall) lines.AddRow({one.phrase, InWords(one)});
  }
  for (const SmallestLayout* one : SmallestFirst(answers.smallest_layouts, kMostLayouts)) {
    const proto::CaseFailures& verified = one->document.lineage->verified;
    lines.AddRow({"smallest",
                  fmt::format("{}, run {}: {}", Counted(one->document.test_case.obstacles.size(), "obstacle"),
                              proto::RunText(one->run),
                              FailsIn(static_cast<std::uint64_t>(verified.failures),
                                      static_cast<std::uint64_t>(verified.runs)))});
  }
}

// In random cases: what it withstands least, and the others by name.
void AddMargins(const std::vector<Margin>& margins, const ExaminationPlan& plan, Table& lines) {
  std::vector<std::string> withstood, unknown;
  for (const Margin& one : margins) {
    const std::string& key = one.plan.key.key.path;
    const std::string range = fmt::format("{} up to {}", key, one.plan.key.high);
    const std::string crosses = CrossesOf(one);
    if (crosses == "below_everywhere") {
      withstood.push_back(range);
    } else if (crosses == "undecided") {
      unknown.push_back(range);
    } else if (one.rank == 1) {
      lines.AddRow({"disturbed", OutcomeOf(one)});
    } else {
      withstood.push_back(fmt::format("more of {}", key));
    }
  }
  for (const std::string& key : plan.unvaried) unknown.push_back(key.substr(0, key.find('=')));
  if (!withstood.empty())
    lines.AddRow({"withstands",
                  fmt::format("{}: fewer than half of the random cases fail", fmt::join(withstood, ", "))});
  if (!unknown.empty())
    lines.AddRow({"not known", fmt::format("{}: the runs are too few", fmt::join(unknown, ", "))});
}

}  // namespace

Result<std::vector<Confirmation>> ExaminedCases(const std::string& campaign) {
  TRY(auto confirmations, ReadConfirmations(campaign));
  if (confirmations.empty()) return confirmations;
  TRY(const QuestionedCampaign ended_with, PopulationCases(campaign));
  std::set<std::uint64_t> keys;
  for (const CaseInQuestion& one : ended_with.cases)
    keys.insert(ConfirmationKey(ended_with.plans[one.search].experiment, one.test_case));
  std::erase_if(confirmations, [&](const Confirmation& one) { return !keys.contains(one.key); });
  return confirmations;
}

Result<ExaminationFacts> ReadExamination(const std::string& directory) {
  ExaminationFacts facts;
  TRY(facts.random, ReadFacts(directory + "/random"));
  facts.search = facts.random;
  TRY(facts.runs, RunsOf(directory + "/random"));
  if (const std::string search = directory + "/search"; CampaignDirectory::IsCampaign(search)) {
    TRY(facts.search, ReadFacts(search));
    TRY(facts.search.answers.confirmations, ExaminedCases(search));
    TRY(const std::uint64_t of_search, RunsOf(search));
    facts.runs += of_search;
  }
  const std::string margins = directory + "/margins";
  if (!CampaignDirectory::IsCampaign(margins)) return facts;
  TRY(facts.margins, ReadMargins(margins));
  TRY(const std::uint64_t of_margins, RunsOf(margins));
  facts.runs += of_margins;
  return facts;
}

std::string ExaminationText(const ExaminationFacts& facts, const ExaminationPlan& plan,
                            const std::string& program, const std::string& page) {
  const CampaignFacts& search = facts.search;
  const Experiment& experiment = search.plans.front().experiment;
  Table lines({"", ""});
  if (!facts.random.answers.baselines.empty()) {
    const FailureTally& tally = facts.random.answers.baselines.front().tally;
    lines.AddRow({"no obstacles", FailsIn(static_cast<std::uint64_t>(tally.failures),
                                          static_cast<std::uint64_t>(tally.runs()))});
  }
  lines.AddRow({"random cases", FailsIn(facts.random.summary.failing_runs, facts.random.summary.runs_done)});
  if (search.directory == facts.random.directory) {
    lines.AddRow({"obstacles", "not searched for: it fails without any, so that no layout is to blame"});
  } else if (search.answers.confirmations.empty()) {
    lines.AddRow({"obstacles", fmt::format("a search of {} runs found no layout that breaks it reliably",
                                           FormatCount(search.summary.runs_done))});
  } else {
    AddFailures(search, lines);
  }
  if (search.directory != facts.random.directory) AddMargins(facts.margins, plan, lines);
  lines.AddRow({"all of it", page});
  std::string text = fmt::format("{} with the controller {}, examined in {} runs\n\n{}", experiment.name,
                                 experiment.controller, FormatCount(facts.runs), lines.ToText());
  if (const auto smallest = SmallestFirst(search.answers.smallest_layouts, 1); !smallest.empty()) {
    Section next;
    next.commands = {
        {fmt::format("{} show {}", program, PastedPath(search.directory)), "every failure, and what to type"},
        {fmt::format("{} corpus add {} {} --to corpus", program, PastedPath(search.directory),
                     smallest.front()->run),
         "keep the smallest as a regression test"}};
    text += "\n" + ToText(next);
  }
  return text;
}

std::string ExaminationJson(const ExaminationFacts& facts, const std::string& directory,
                            const std::string& page) {
  const CampaignAnswers& answers = facts.search.answers;
  nlohmann::ordered_json empty;
  if (!facts.random.answers.baselines.empty()) {
    const FailureTally& tally = facts.random.answers.baselines.front().tally;
    empty = {{"k", tally.failures}, {"n", tally.runs()}};
  }
  nlohmann::ordered_json smallest = nlohmann::ordered_json::array();
  for (const SmallestLayout* one : SmallestFirst(answers.smallest_layouts, kMostLayouts)) {
    const proto::CaseFailures& verified = one->document.lineage->verified;
    smallest.push_back({{"run", one->run},
                        {"obstacles", one->document.test_case.obstacles.size()},
                        {"k", verified.failures},
                        {"n", verified.runs},
                        {"file", one->file}});
  }
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  return JsonText(
      {{"experiment", facts.search.summary.experiment},
       {"directory", directory},
       {"report", page},
       {"runs", facts.runs},
       {"baseline",
        {{"empty", std::move(empty)},
         {"random", {{"k", facts.random.summary.failing_runs}, {"n", facts.random.summary.runs_done}}}}},
       {"distinct", DistinctFailuresTable(distinct.All()).ToJson()},
       {"groupings", FailureGroupingsTable(distinct).ToJson()},
       {"confirmed", ConfirmationsTable(answers.confirmations).ToJson()},
       {"smallest", std::move(smallest)},
       {"margins", MarginValues(facts.margins)}});
}

}  // namespace gauntlet
