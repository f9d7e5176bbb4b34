#include "report/figures/campaign_facts.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "master/campaign/stored_campaign.h"
#include "master/store/event_kinds.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "report/tables/summary_tables.h"
#include "search/search_table.h"
#include "study/questions/question_table.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// The descriptors of an experiment's scenario, nullptr where there are none.
std::vector<const controllers::MetricInfo*> DescriptorsOf(const Experiment& experiment) {
  std::vector<const controllers::MetricInfo*> descriptors;
  for (const controllers::MetricInfo& metric : controllers::DeclaredScenario(experiment).metrics) {
    if (metric.descriptor) descriptors.push_back(&metric);
  }
  return descriptors;
}

Result<RunFacts> FactsOf(const StoredRun& run,
                         const std::vector<const controllers::MetricInfo*>& descriptors) {
  RunFacts facts = FactsOfRow(run);
  facts.descriptors.assign(descriptors.size(), kNotMeasured);
  if (!facts.completed || descriptors.empty()) return facts;
  const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
  if (!result)
    return Error{result.error().kind,
                 fmt::format("run {}: {}", proto::RunText(run.id), result.error().message)};
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const auto metric =
        std::ranges::find(result->metrics, descriptors[i]->name, &std::pair<std::string, double>::first);
    if (metric == result->metrics.end()) continue;
    facts.descriptors[i] = MeasuredValue(descriptors[i], metric->second).value_or(kNotMeasured);
  }
  return facts;
}

Status AddRuns(const SearchPlan& plan, ResultStore& store, std::vector<RunFacts>& runs) {
  const auto descriptors = DescriptorsOf(plan.experiment);
  const auto add = [&](const StoredRun& run) -> Status {
    TRY(RunFacts facts, FactsOf(run, descriptors));
    runs.push_back(std::move(facts));
    return Ok{};
  };
  return descriptors.empty() ? store.ForEachRow(plan.id, 0, add) : store.ForEachRun(plan.id, 0, add);
}

void AddRun(const RunFacts& run, CaseFacts& of_case) {
  ++of_case.runs;
  if (run.total_failure) ++of_case.total_failures;
  if (!run.completed) return;
  if (of_case.toughest == 0 || run.fitness < of_case.fitness.lowest()) {
    of_case.toughest = run.id;
    of_case.failure_type = run.failure_type;
  }
  of_case.fitness.Add(run.fitness);
}

Result<std::vector<CaseFacts>> CasesOf(const CampaignFacts& facts, ResultStore& store) {
  std::map<std::pair<SearchId, IndividualId>, CaseFacts> cases;
  for (const RunFacts& run : facts.runs) AddRun(run, cases[{run.search, run.individual}]);
  std::map<RunId, const Confirmation*> confirmed;
  for (const Confirmation& one : facts.answers.confirmations) confirmed[one.run] = &one;
  for (const RunFacts& run : facts.runs) {
    const auto found = confirmed.find(run.id);
    if (found != confirmed.end()) cases[{run.search, run.individual}].confirmation = *found->second;
  }
  std::vector<CaseFacts> all;
  for (SearchId search = 1; search <= facts.plans.size(); ++search) {
    TRY(const auto individuals, store.LoadIndividuals(search));
    for (const Individual& individual : individuals) {
      const auto found = cases.find({search, individual.id});
      if (found == cases.end()) continue;
      CaseFacts& one = all.emplace_back(std::move(found->second));
      one.search = search;
      one.individual = individual.id;
      one.name = individual.test_case.name;
      one.born = individual.birth_generation;
      one.obstacles = individual.test_case.obstacles.size();
    }
  }
  std::ranges::stable_sort(all, [](const CaseFacts& a, const CaseFacts& b) {
    if ((a.toughest == 0) != (b.toughest == 0)) return b.toughest == 0;
    return a.fitness.mean() < b.fitness.mean();
  });
  return all;
}

// "worker 1cfc97e775e2ec67@node7 (pid 26700, slots 1) joined"
std::string HostOf(const std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos) return "";
  return text.substr(at + 1, text.find(' ', at) - at - 1);
}

Result<CampaignHistory> HistoryOf(SqliteStore& store) {
  TRY(const auto events, store.LoadEvents());
  CampaignHistory history{.created_unix_ms = store.meta().created_unix_ms};
  history.last_unix_ms = history.created_unix_ms;
  std::set<std::string> hosts;
  std::int64_t since = 0;
  for (const StoredEvent& one : events) {
    const bool starts = one.kind == event::kStart || one.kind == event::kResume;
    if (starts) {
      ++history.sessions;
      since = one.unix_ms;
    } else if (since != 0 && one.unix_ms > since) {
      // The session is known to have lived until then.
      history.served_seconds += static_cast<double>(one.unix_ms - since) / 1000.0;
      since = one.unix_ms;
    }
    if (one.kind == event::kWorkerJoined) hosts.insert(HostOf(one.text));
    history.last_unix_ms = std::max(history.last_unix_ms, one.unix_ms);
  }
  hosts.erase("");
  history.hosts.assign(hosts.begin(), hosts.end());
  return history;
}

std::vector<std::string> NotesOf(const CampaignFacts& facts, const std::string& being_written) {
  std::vector<std::string> notes;
  const CampaignSummary& summary = facts.summary;
  if (!being_written.empty()) notes.push_back(being_written);
  if (summary.runs_done == 0) {
    notes.push_back(fmt::format("{} has no run yet", facts.directory));
  } else if (!summary.finished) {
    notes.push_back(fmt::format("{} is half-finished: this tells of the {} runs that it has so far",
                                facts.directory, FormatCount(summary.runs_done)));
  }
  if (summary.runs_failed > 0) {
    notes.push_back(fmt::format("{} runs ended without a result (crashed, hung, refused)",
                                FormatCount(summary.runs_failed)));
  }
  for (std::string& warning : WarningsOf(summary)) notes.push_back(std::move(warning));
  return notes;
}

std::string TextOfFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

RunFacts FactsOfRow(const StoredRun& run) {
  return {.id = run.id,
          .search = run.search,
          .individual = run.individual,
          .generation = run.generation,
          .completed = run.completed(),
          .total_failure = run.total_failure,
          .failure_type = run.failure_type,
          .fitness = run.fitness,
          .descriptors = {}};
}

Result<CampaignFacts> ReadFacts(const std::string& dir) {
  TRY(const auto campaign, OpenStoredCampaign(dir));
  SqliteStore& store = *campaign.view.store;
  CampaignFacts facts;
  facts.directory = dir;
  facts.software_version = store.meta().software_version;
  facts.golden_hashes = store.meta().golden_hashes;
  facts.experiment_toml = TextOfFile(campaign.view.directory.experiment_path());
  facts.plans = campaign.plans;
  TRY(facts.summary, Summarise(facts.plans, store));
  TRY(facts.answers, ReadAnswers(dir));
  if (const SearchRow& row = RowOf(facts.plans.front().experiment); Reads(row.info, "fit.vary")) {
    TRY(facts.fit, ReadFit(dir));
  } else if (Reads(row.info, "margin.vary")) {
    TRY(facts.margins, ReadMargins(dir));
  } else if (Reads(row.info, "repair.vary")) {
    TRY(facts.repair, ReadRepair(dir));
  } else if (Reads(row.info, "probability.runs")) {
    TRY(facts.probability, ReadProbability(dir));
  }
  for (const auto question : kQuestions) {
    TRY(auto told, ToldCases(question(), dir));
    std::ranges::move(told, std::back_inserter(facts.told_cases));
  }
  TRY(facts.history, HistoryOf(store));
  for (const SearchPlan& plan : facts.plans) {
    TRY(AddRuns(plan, store, facts.runs));
  }
  TRY(facts.cases, CasesOf(facts, store));
  facts.notes = NotesOf(facts, campaign.being_written);
  return facts;
}

Result<std::vector<StoredRun>> ReadRuns(const std::string& dir, const std::vector<RunId>& ids) {
  TRY(const auto campaign, ViewCampaign(dir, Checked::kTotals));
  std::vector<StoredRun> runs;
  for (const RunId id : ids) {
    TRY(auto run, campaign.store->LoadRun(id));
    if (!run.has_value())
      return Error{ErrorKind::kNotFound, fmt::format("there is no run {} in {}", proto::RunText(id), dir)};
    runs.push_back(std::move(*run));
  }
  return runs;
}

}  // namespace gauntlet
