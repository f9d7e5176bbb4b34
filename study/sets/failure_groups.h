// Which failures are one and the same: those of one kind at one place. Cases are told apart by what most of
// their runs with fresh seeds did, because a single run may fail in another way by chance.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "controllers/behaviour.h"
#include "sim/geometry/vec2.h"

namespace gauntlet {

// How a run failed, or most of the failed runs of a case.
struct FailureWay {
  std::size_t kind = 0;            // of FailureDescriptor::kinds
  std::optional<sim::Vec2> place;  // one of the passages, where there are any
};

// How the runs of a case fail.
class FailureWays {
 public:
  FailureWays(const controllers::ScenarioInfo& scenario, const sim::Parameters& scenario_parameters,
              const sim::TestCase& test_case);

  // `metrics`: of a run that failed.
  FailureWay Of(controllers::MetricValues metrics) const;

 private:
  const controllers::FailureDescriptor& descriptor_;
  std::vector<sim::Vec2> passages_;
};

// Of the ways of a case's failed runs, at least one, the number of that which stands for all: of the most
// frequent kind, and in the middle of its places.
std::size_t TypicalWay(std::span<const FailureWay> ways);

// The group of each of these ways, one a case: of one kind, and no two places farther apart than
// FailurePlace::same_within. Groups are numbered from 0 by their first way.
std::vector<std::size_t> GroupWays(const controllers::ScenarioInfo& scenario,
                                   std::span<const FailureWay> ways);

// In words: "near (0.3, -1.7)".
std::string DescribeWay(const controllers::ScenarioInfo& scenario, const FailureWay& way);

}  // namespace gauntlet
