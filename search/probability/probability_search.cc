#include "search/probability/probability_search.h"

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "search/failure_tally.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

// Rules between keys, and whether the swarm can begin, all over the conditions.
Status CheckConditions(const SearchSetup& setup, const Conditions& conditions) {
  constexpr std::uint32_t kTried = 40;
  for (std::uint32_t i = 0; i < kTried; ++i) {
    const Sample sample = conditions.Draw({i, sim::StreamPurpose::kProposals});
    const Experiment there = WithValues(setup.experiment, conditions.varied(), conditions.ValuesOf(sample));
    std::string drawn;
    for (const VariedKey& one : conditions.varied())
      drawn += fmt::format("{}{} = {}", drawn.empty() ? "" : ", ", one.key.path, ToToml(one.key.get(there)));
    if (const auto broken = CheckRules(there, BuiltInCatalogue()))
      return InvalidInput(fmt::format("[conditions] {}: {}", drawn, broken->message));
    if (!there.scenario_plugin.empty()) continue;
    if (const Status fits = CheckSwarmFits(there, EmptyArena(there.arena)); !fits.ok())
      return InvalidInput(fmt::format("[conditions] {}: {}", drawn, fits.error().message));
  }
  return Ok{};
}

}  // namespace

Result<std::unique_ptr<ProbabilitySearch>> ProbabilitySearch::Create(const SearchSetup& setup) {
  TRY(Conditions conditions, Conditions::Make(setup, AllKeysOf(setup.experiment)));
  TRY(CheckConditions(setup, conditions));
  return std::unique_ptr<ProbabilitySearch>(new ProbabilitySearch(
      setup, std::make_unique<ProbabilityCourse>(setup, std::move(conditions), FailingOf(setup.experiment))));
}

SearchRow ProbabilityRow() {
  return {.info = {.name = "probability",
                   .description = "how likely a failure is over stated conditions: gauntlet probability",
                   .keys = {"probability.", "genome.", "conditions"}},
          .number = 13,
          .title = "failure probability",
          .plan =
              [](const Experiment& e) {
                return fmt::format("at most {} runs",
                                   FormatCount(static_cast<std::uint64_t>(e.probability.runs)));
              },
          .make = Make<ProbabilitySearch>,
          .purpose = sim::SeedPurpose::kProbability,
          .command = "probability",
          .varies_settings = true};
}

}  // namespace gauntlet
