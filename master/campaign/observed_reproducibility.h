// What a campaign whose runs start a program of the user's has seen of it: whether its runs end the same when
// they are simulated again. It is read from the events of all masters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "master/directory/search_plans.h"
#include "master/dispatch/trust/reproducibility.h"
#include "master/store/result_store.h"

namespace gauntlet {

struct ObservedReproducibility {
  Reproducible state = Reproducible::kPromised;
  std::string seen = "";  // ReproducibilityNews::text

  bool observed() const { return state != Reproducible::kPromised; }
  std::string_view Name() const;           // "yes", "no" or "unknown"
  std::vector<std::string> Hosts() const;  // that agreed; of kYes only
};

// Whether its stored runs keep the robots' waypoints. Of a program they do: another run might have others.
bool KeepsWays(const Experiment& experiment);

Result<ObservedReproducibility> ReadReproducibility(const std::vector<SearchPlan>& plans, ResultStore& store);

// "yes (hosts a, b)", "no (run 17 ended differently when it was simulated again on a)", "not yet known".
std::string InWords(const ObservedReproducibility& observed);

}  // namespace gauntlet
