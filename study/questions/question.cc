#include "study/questions/question.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/parse_number.h"
#include "master/directory/campaign_directory.h"

namespace gauntlet {
namespace {

std::vector<CaseAnswer>::const_iterator FindKey(const std::vector<CaseAnswer>& answers, std::uint64_t key) {
  return std::ranges::find(answers, key, &CaseAnswer::key);
}

std::string FolderAsked(const Question& question, const Asking& asking) {
  return FolderOf(question, asking.place, question.variant == nullptr ? "" : question.variant(asking));
}

// Gives the call those cases of which nothing is known, and a folder that the same call finds again.
Call WithCasesOf(Call call, const QuestionedCampaign& questioned, const std::string& folder,
                 const std::vector<CaseAnswer>& known) {
  std::set<std::uint64_t> asked;
  Fnv1a64 hash;
  for (std::size_t i = 0; i < questioned.cases.size(); ++i) {
    const CaseInQuestion& one = questioned.cases[i];
    SearchPlan& plan = call.searches[one.search];
    const std::uint64_t key = KeyOfCase(plan.experiment, one.test_case);
    if (FindKey(known, call.cases[i].key) != known.end() || !asked.insert(key).second) continue;
    hash.AddUint64(key);
    plan.cases.push_back(one.test_case);
    plan.cases.back().name = one.name;
  }
  std::erase_if(call.searches, [](const SearchPlan& plan) { return plan.cases.empty(); });
  if (call.searches.size() == 1) call.searches.front().settings.clear();
  call.directory = fmt::format("{}/{:016x}", folder, hash.value());
  return call;
}

// Those of calls that have come to their end.
std::vector<CaseAnswer> OfEndedCalls(std::vector<CaseAnswer> answers) {
  std::set<std::string> stopped;
  for (const CaseAnswer& one : answers) {
    if (!one.ended) stopped.insert(one.campaign);
  }
  std::erase_if(answers, [&](const CaseAnswer& one) { return stopped.contains(one.campaign); });
  return answers;
}

Result<Call> PlanInCampaign(const Question& question, const Asking& asking) {
  TRY(const auto questioned,
      question.cases != nullptr ? question.cases(asking) : NamedCases(asking.place, asking.cases));
  for (const std::string& notice : questioned.notices) asking.say(notice);
  Call call;
  call.searches = questioned.plans;
  std::vector<std::shared_ptr<const Experiment>> experiments;
  for (SearchPlan& plan : call.searches) {
    TRY(plan.experiment, question.about(plan.experiment, asking));
    experiments.push_back(std::make_shared<const Experiment>(plan.experiment));
  }
  const std::string folder = FolderAsked(question, asking);
  TRY(std::vector<CaseAnswer> known, AnswersOfCalls(folder, question.key));
  std::erase_if(known, [&](const CaseAnswer& one) {
    return question.enough != nullptr && !question.enough(one, asking);
  });
  for (const CaseInQuestion& one : questioned.cases) {
    const SearchPlan& plan = call.searches[one.search];
    call.cases.push_back({.name = one.name,
                          .run = RunOfName(one.name),
                          .search = one.search,
                          .test_case = one.test_case,
                          .experiment = experiments[one.search],
                          .key = question.key(plan.experiment, one.test_case)});
  }
  // The same call, stopped before, is gone on with; another one takes from it what is decided.
  Call same = WithCasesOf(call, questioned, folder, OfEndedCalls(known));
  if (!same.Simulates() || CampaignDirectory::IsCampaign(same.directory)) return same;
  std::erase_if(known, [](const CaseAnswer& one) { return !one.decided; });
  return WithCasesOf(std::move(call), questioned, folder, known);
}

}  // namespace

std::string Asking::Value(std::string_view option) const {
  const auto found = options.find(option);
  return found == options.end() || found->second.empty() ? "" : found->second.back();
}

std::vector<std::string> Asking::Values(std::string_view option) const {
  const auto found = options.find(option);
  return found == options.end() ? std::vector<std::string>() : found->second;
}

Result<int> WholeNumber(const Asking& asking, std::string_view option, int low, int high, int otherwise) {
  const std::string text = asking.Value(option);
  if (text.empty()) return otherwise;
  const auto number = ParseNumber<int>(text);
  if (number && *number >= low && *number <= high) return *number;
  return InvalidInput(fmt::format("{} {}: a whole number from {} to {} is needed", option, text, low, high));
}

bool Call::Simulates() const {
  return std::ranges::any_of(searches, [](const SearchPlan& plan) { return !plan.cases.empty(); });
}

Result<QuestionedCampaign> CasesWithObstacles(const Asking& asking) {
  TRY(auto questioned, NamedCases(asking.place, asking.cases));
  const auto bare = std::ranges::find_if(
      questioned.cases, [](const CaseInQuestion& one) { return one.test_case.obstacles.empty(); });
  if (bare == questioned.cases.end()) return questioned;
  return InvalidInput(fmt::format("{} has no obstacles: there is nothing to leave out", bare->name));
}

std::string FolderOf(const Question& question, const std::string& place, const std::string& variant) {
  return fmt::format("{}/{}{}{}{}", place, question.place == Question::Place::kCorpus ? "." : "",
                     question.name, variant.empty() ? "" : "-", variant);
}

Result<Call> PlanCall(const Question& question, const Asking& asking) {
  return question.plan != nullptr ? question.plan(asking) : PlanInCampaign(question, asking);
}

Result<std::vector<CaseAnswer>> AnswersTo(const Question& question, const Asking& asking, const Call& call) {
  std::vector<CaseAnswer> answers;
  if (question.place == Question::Place::kCampaign) {
    TRY(auto stored, AnswersOfCalls(FolderAsked(question, asking), question.key));
    const std::vector<CaseAnswer> known = BestOf(std::move(stored));
    for (const CaseAnswer& one : call.cases) {
      const auto found = FindKey(known, one.key);
      if (found != known.end()) answers.push_back(Renamed(*found, one.name));
    }
    return answers;
  }
  answers = call.cases;
  if (!call.Simulates()) return answers;
  TRY(auto stored, AnswersOfCall(call.directory, question.key));
  auto next = stored.begin();
  for (std::size_t search = 0; search < call.searches.size(); ++search) {
    for (CaseAnswer& one : answers) {
      if (one.search != search || !one.refused.empty()) continue;
      if (next == stored.end()) return answers;  // it was stopped before
      one.campaign = next->campaign;
      one.runs = std::move(next->runs);
      one.decided = next->decided;
      one.ended = (next++)->ended;
    }
  }
  return answers;
}

Result<std::vector<ToldCase>> ToldCases(const Question& question, const std::string& dir) {
  std::vector<ToldCase> cases;
  if (*question.page_title == '\0') return cases;
  TRY(auto known, AnswersOfCalls(FolderOf(question, dir), question.key));
  for (const CaseAnswer& one : BestOf(std::move(known))) {
    if (one.run == 0) continue;
    TRY(Told told, question.tell({.place = dir}, {}, {&one, 1}));
    told.section.title = question.page_title;
    told.section.commands.clear();
    cases.push_back({one.run, std::move(told.section)});
  }
  return cases;
}

}  // namespace gauntlet
