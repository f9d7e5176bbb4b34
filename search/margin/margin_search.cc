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

KeyValue HeldBy(const VariedKey& key, double value) {
  return key.key.type == KeyType::kInteger ? KeyValue(static_cast<std::int64_t>(value)) : KeyValue(value);
}

Experiment AtValue(const Experiment& experiment, const VariedKey& key, double value) {
  const KeyValue held = HeldBy(key, value);
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

MarginCourse::MarginCourse(MarginPlan plan, std::string_view failing)
    : stages_(std::move(plan)), varied_({stages_.plan().key}), failing_(failing) {}

std::vector<SettingsRun> MarginCourse::Next() {
  std::vector<SettingsRun> runs;
  for (const MarginRun& run : stages_.Next()) {
    auto found = std::ranges::find(numbers_, run.value);
    if (found == numbers_.end()) {
      found = numbers_.insert(found, run.value);
      values_.push_back({HeldBy(varied_.front(), run.value)});
    }
    runs.push_back({static_cast<std::size_t>(found - numbers_.begin()), run.of_case});
  }
  return runs;
}

void MarginCourse::Tell(const SettingsRun& run, const RunOutcome& outcome) {
  stages_.Tell({numbers_[run.setting], run.of_case},
               outcome.completed() ? std::optional(Fails(outcome, failing_)) : std::nullopt);
}

bool MarginCourse::WantsMetrics() const {
  return FailingNeedsMetrics(failing_);
}

Result<std::unique_ptr<MarginSearch>> MarginSearch::Create(const SearchSetup& setup) {
  TRY(MarginPlan plan, MakeMarginPlan(setup.experiment, AllKeysOf(setup.experiment), setup.cases.size()));
  TRY(CheckRange(setup.experiment, plan.key));
  TRY(CheckHasEffect(setup.experiment, plan.key));
  return std::unique_ptr<MarginSearch>(
      new MarginSearch(setup, std::make_unique<MarginCourse>(std::move(plan), FailingOf(setup.experiment))));
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
