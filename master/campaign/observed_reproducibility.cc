#include "master/campaign/observed_reproducibility.h"

#include <fmt/format.h>

#include <algorithm>

#include "master/store/event_kinds.h"
#include "search/failure_tally.h"

namespace gauntlet {

std::string_view ObservedReproducibility::Name() const {
  if (state == Reproducible::kUnknown) return "unknown";
  return state == Reproducible::kNo ? "no" : "yes";
}

std::vector<std::string> ObservedReproducibility::Hosts() const {
  constexpr std::string_view kBetween = ", ";
  std::vector<std::string> hosts;
  if (state != Reproducible::kYes) return hosts;
  std::string_view rest = seen;
  rest.remove_prefix(std::min(rest.size(), rest.find(' ') + 1));  // "hosts "
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.size(), rest.find(kBetween));
    hosts.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(rest.size(), end + kBetween.size()));
  }
  return hosts;
}

bool KeepsWays(const Experiment& experiment) {
  return experiment.store.trajectories || StartsProgram(experiment);
}

Result<ObservedReproducibility> ReadReproducibility(const std::vector<SearchPlan>& plans,
                                                    ResultStore& store) {
  ObservedReproducibility observed;
  const auto starts_program = [](const SearchPlan& plan) { return StartsProgram(plan.experiment); };
  if (std::ranges::none_of(plans, starts_program)) return observed;
  observed.state = Reproducible::kUnknown;
  TRY(const std::vector<StoredEvent> events, store.LoadEvents());
  for (const StoredEvent& event : events) {
    const bool differed = event.kind == event::kNotReproducible;
    if (!differed && event.kind != event::kReproducible) continue;
    observed = {differed ? Reproducible::kNo : Reproducible::kYes, event.text};
    if (differed) break;
  }
  return observed;
}

std::string InWords(const ObservedReproducibility& observed) {
  if (observed.state == Reproducible::kUnknown) return "not yet known";
  return fmt::format("{} ({})", observed.Name(), observed.seen);
}

}  // namespace gauntlet
