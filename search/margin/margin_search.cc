#include "search/margin/margin_search.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "search/failure_tally.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

Experiment AtValue(const Experiment& experiment, const VariedKey& key, double value) {
  const KeyValue held =
      key.key.type == KeyType::kInteger ? KeyValue(static_cast<std::int64_t>(value)) : KeyValue(value);
  return WithValues(experiment, {&key, 1}, {&held, 1});
}

// Rules, and whether the swarm can begin, at values all over the range. Of what a plug-in's process alone can
// answer, each run is asked.
Status CheckRange(const Experiment& experiment, const VariedKey& key) {
  constexpr int kTried = 20;
  const auto wrong = [&](double value, const std::string& why) {
    return InvalidInput(fmt::format("{} = {}, within the range: {}", key.key.path, value, why));
  };
  for (int i = 0; i <= kTried; ++i) {
    double value = key.low + i * (key.high - key.low) / kTried;
    if (key.key.type == KeyType::kInteger) value = std::floor(value);
    const Experiment there = AtValue(experiment, key, value);
    if (const auto broken = CheckRules(there, BuiltInCatalogue())) return wrong(value, broken->message);
    if (!there.scenario_plugin.empty()) continue;
    const Status fits = CheckSwarmFits(there, EmptyArena(there.arena));
    if (!fits.ok()) return wrong(value, fits.error().message);
  }
  return Ok{};
}

// A device's noise does nothing to robots that have no such device.
Status CheckHasEffect(const Experiment& experiment, const VariedKey& key) {
  constexpr std::string_view kNoise = "noise.";
  if (!key.key.path.starts_with(kNoise)) return Ok{};
  const std::string rest = key.key.path.substr(kNoise.size());
  const std::string name = rest.substr(0, rest.find('.'));
  const auto device = sim::DeviceOfKey(name);
  const auto start = controllers::StartOf(SpecOf(experiment, EmptyArena(experiment.arena), experiment.seed));
  if (!start || !device) return Ok{};
  std::string others;
  for (const sim::StartingRobot& robot : start->robots) {
    if (!robot.under_test) continue;
    if (robot.devices == sim::DeviceSet() || robot.devices.Has(*device)) return Ok{};
    if (!others.empty()) continue;
    for (const sim::DeviceInfo& info : sim::kDevices) {
      if (robot.devices.Has(info.device) && info.most_noise > 0.0)
        others += fmt::format("{}{}", others.empty() ? "" : ", ", info.key);
    }
  }
  return InvalidInput(
      fmt::format("{} has no effect: robots of the controller '{}' have no {}; of noise they "
                  "have {}",
                  key.key.path, experiment.controller, name, others.empty() ? "none" : others));
}

}  // namespace

MarginSearch::MarginSearch(const SearchSetup& setup, MarginPlan plan)
    : PopulationSearch(setup),
      stages_(std::move(plan)),
      failing_(FailingOf(setup_.experiment)),
      needs_metrics_(FailingNeedsMetrics(failing_)) {
  for (const sim::TestCase& test_case : setup.cases)
    newborns_.push_back(population_.emplace_back(MakeIndividual(++born_, test_case)));
}

Result<std::unique_ptr<MarginSearch>> MarginSearch::Create(const SearchSetup& setup) {
  TRY(MarginPlan plan, MakeMarginPlan(setup.experiment, AllKeysOf(setup.experiment), setup.cases.size()));
  TRY(CheckRange(setup.experiment, plan.key));
  TRY(CheckHasEffect(setup.experiment, plan.key));
  return std::unique_ptr<MarginSearch>(new MarginSearch(setup, std::move(plan)));
}

EvaluationRequest MarginSearch::RequestOf(const MarginRun& run) {
  const auto [found, is_new] = copies_.try_emplace({run.value, run.of_case});
  Individual& copy = found->second;
  if (is_new) {
    copy = MakeIndividual(++born_, setup_.cases[run.of_case]);
    copy.birth_generation = static_cast<std::uint32_t>(stages_.stages());
    copy.parents = {run.of_case + 1};
    newborns_.push_back(copy);
  }
  std::shared_ptr<const Experiment>& settings = settings_[run.value];
  if (settings == nullptr)
    settings = std::make_shared<const Experiment>(AtValue(setup_.experiment, stages_.plan().key, run.value));
  EvaluationRequest request = Request(copy, static_cast<std::uint32_t>(stages_.stages()));
  request.settings = settings;
  request.parents.clear();
  return request;
}

std::vector<EvaluationRequest> MarginSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  if (!asked_.empty() || ended_) return requests;
  for (const MarginRun& run : stages_.Next()) {
    requests.push_back(RequestOf(run));
    asked_.push_back(run);
  }
  ended_ = requests.empty();
  return requests;
}

void MarginSearch::Told(const EvaluationOutcome& outcome) {
  const MarginRun run = asked_.front();
  asked_.pop_front();
  Record(outcome, copies_.at({run.value, run.of_case}));
  for (const RunOutcome& one : outcome.runs)
    stages_.Tell(run, one.completed() ? std::optional(Fails(one, failing_)) : std::nullopt);
  if (asked_.empty()) ended_ = MarginStages(stages_).Next().empty();
}

SearchProgress MarginSearch::Progress() const {
  const auto planned = ended_ ? evaluations_done_ : static_cast<std::uint64_t>(stages_.plan().runs);
  return {.generation = stages_.stages() > 0 ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = planned,
          .individuals_planned = planned,
          .finished = ended_};
}

Status MarginSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
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

SearchRow MarginRow() {
  return {.info = {.name = "margin",
                   .description = "where along a range given cases begin to fail: gauntlet margin",
                   .keys = {"margin."}},
          .number = 10,
          .title = "margin of a setting",
          .plan =
              [](const Experiment& e) {
                return fmt::format("{} runs along {}", FormatCount(static_cast<std::uint64_t>(e.margin.runs)),
                                   e.margin.vary);
              },
          .make = Make<MarginSearch>,
          .purpose = sim::SeedPurpose::kMargin,
          .command = "margin",
          .seeds_of_cases = true,
          .varies_settings = true};
}

}  // namespace gauntlet
