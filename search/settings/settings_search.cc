#include "search/settings/settings_search.h"

#include <algorithm>
#include <iterator>

namespace gauntlet {

SettingsSearch::SettingsSearch(const SearchSetup& setup, SettingsCourse& course)
    : PopulationSearch(setup), course_(course) {
  for (const sim::TestCase& test_case : setup.cases)
    newborns_.push_back(population_.emplace_back(MakeIndividual(++born_, test_case)));
}

EvaluationRequest SettingsSearch::RequestOf(const SettingsRun& run) {
  const auto [found, is_new] = copies_.try_emplace({run.setting, run.of_case});
  Individual& copy = found->second.individual;
  if (is_new) {
    std::optional<sim::TestCase> own = course_.CaseOf(run.setting);
    copy = MakeIndividual(++born_, own ? std::move(*own) : setup_.cases[run.of_case]);
    copy.birth_generation = static_cast<std::uint32_t>(course_.stages());
    copy.parents = {run.of_case + 1};
    newborns_.push_back(copy);
  }
  std::shared_ptr<const Experiment>& settings = settings_[run.setting];
  if (settings == nullptr) {
    settings = std::make_shared<const Experiment>(
        WithValues(setup_.experiment, course_.varied(), course_.ValuesOf(run.setting)));
  }
  EvaluationRequest request =
      Request(copy, static_cast<std::uint32_t>(course_.stages()), found->second.asked++);
  request.settings = settings;
  request.parents.clear();
  return request;
}

std::vector<EvaluationRequest> SettingsSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  if (!asked_.empty() || ended_) return requests;
  for (const SettingsRun& run : course_.Next()) {
    requests.push_back(RequestOf(run));
    asked_.push_back(run);
  }
  ended_ = requests.empty();
  return requests;
}

void SettingsSearch::Told(const EvaluationOutcome& outcome) {
  const SettingsRun run = asked_.front();
  asked_.pop_front();
  Copy& copy = copies_.at({run.setting, run.of_case});
  Record(outcome, copy.individual);
  --copy.asked;
  for (const RunOutcome& one : outcome.runs) course_.Tell(run, one);
  if (course_.Once()) {
    copies_.erase({run.setting, run.of_case});
    settings_.erase(run.setting);
  }
  if (asked_.empty()) ended_ = course_.AtEnd();
}

SearchProgress SettingsSearch::Progress() const {
  const std::uint64_t planned = ended_ ? evaluations_done_ : course_.RunsPlanned();
  return {.generation = course_.stages() > 0 ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = planned,
          .individuals_planned = planned,
          .finished = ended_};
}

Status SettingsSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  // What was asked for follows from what was told.
  const std::uint64_t told = std::exchange(evaluations_done_, 0);
  std::deque<EvaluationRequest> expected;
  bool known = true;
  TRY(history([&](const EvaluationOutcome& outcome) {
    if (expected.empty()) std::ranges::move(Ask(), std::back_inserter(expected));
    known = known && !expected.empty() && expected.front().individual == outcome.individual &&
            expected.front().evaluation == outcome.evaluation;
    if (!known) return;
    expected.pop_front();
    Tell(outcome);
  }));
  newborns_.clear();
  if (known && expected.empty() && evaluations_done_ == told) return Ok{};
  return Damaged("its evaluations are not those that it would ask for");
}

}  // namespace gauntlet
