// Which failures are one and the same. A failed run has features, each a function of that run alone; a case
// has a feature where most of its failed runs agree. So no case changes the group of another.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controllers/behaviour.h"
#include "sim/arena/test_case.h"
#include "sim/geometry/vec2.h"

namespace gauntlet {

// Of a failed run, in words; "" = not known.
struct FailureFeatures {
  std::string mechanism;  // what happened (failure_mechanism.h)
  std::string place;      // where: "near (0.6, -1.2)"
};

// Where runs of a case fail.
class FailurePlaces {
 public:
  FailurePlaces(const controllers::ScenarioInfo& scenario, const sim::Parameters& scenario_parameters,
                const sim::TestCase& test_case);

  // Of a run that failed: the middle of the square, as wide as FailurePlace::same_within and the same in
  // every case, that holds its place, or the nearest of the case's passages. "" where it has none.
  std::string Of(controllers::MetricValues metrics) const;

 private:
  const controllers::FailureDescriptor& descriptor_;
  std::vector<sim::Vec2> passages_;
};

// So many failed runs of a case are needed to say what group it is of.
inline constexpr std::size_t kRunsForGroup = 10;

// What most of a case's failed runs have in common.
struct LeadingFeature {
  std::string value;
  int runs = 0;  // that have it
  int of = 0;
  // There are kRunsForGroup, and the share of those that have it has a lower bound above a half (Wilson, 95
  // %).
  bool leads = false;
};
// Nothing where no run's is known. Of equally frequent ones the first in the alphabet.
std::optional<LeadingFeature> LeadingOf(std::span<const std::string> values);

// How much more often two failed runs of one case agree than two of different cases, as a share of what is
// possible (Cohen's kappa, each case with the same weight): 1 = always, 0 = no more often. Cases with fewer
// than two runs say nothing; "" is no value. Nothing: there are not two cases, or all runs are alike, so that
// there is no difference to agree in.
std::optional<double> AgreementWithin(std::span<const std::vector<std::string>> cases);
// A feature that agrees less does not name groups.
inline constexpr double kLeastAgreement = 0.5;

}  // namespace gauntlet
