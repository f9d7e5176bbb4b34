// What a scenario declares of how its runs fail: what tells two failures apart, and the names of the numbered
// types. Readers work both out from stored results.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/geometry/vec2.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers {

// The name of SwarmFailure::total among metrics.
inline constexpr const char* kTotalFailure = "total_failure";

// Values that say that there was nothing to measure: of what is never negative, and of a coordinate, which no
// arena has (sim::kMaxArenaSide).
inline constexpr double kNotMeasured = -1.0;
inline constexpr double kNowhere = -1000.0;

// Of a run, by name.
using MetricValues = std::span<const std::pair<std::string, double>>;

// Nothing where the run does not report it.
std::optional<double> ReportedValue(MetricValues metrics, std::string_view name);

// Where a failed run failed, so that two failures can be told to be the same one.
struct FailurePlace {
  std::string x;  // metrics, m, in the coordinates of the test case
  std::string y;
  double same_within = 0.0;  // m: failures that are no farther apart are the same one
  bool operator==(const FailurePlace&) const = default;
};

// A way in which failed runs differ that repeats when their cases are simulated again. A failed run is of the
// first of the scenario's kinds whose metric is at most `at_most`.
struct FailureKind {
  std::string metric;
  double at_most = 0.0;
  std::string what;  // in words: "no item was taken"
  bool operator==(const FailureKind&) const = default;
};

// The range of a metric, cut into equal parts; what lies outside belongs to the outermost ones. Several axes
// make a grid whose cells tell failures apart.
struct DescriptorAxis {
  std::string metric;
  double min = 0.0;
  double max = 0.0;
  int parts = 1;
  bool operator==(const DescriptorAxis&) const = default;
};

// What tells failures apart in a way that repeats when their cases are simulated again. All may be left out.
struct FailureDescriptor {
  std::vector<DescriptorAxis> axes = {};   // in the cells of their grid a search collects failures
  std::optional<FailurePlace> place = {};  // nothing: failures have no place that repeats
  // Points that the swarm has to pass in this test case, m. At which of them it fails repeats better than
  // where exactly. May be empty, and may give none.
  std::function<std::vector<sim::Vec2>(const sim::Parameters& parameters, const sim::TestCase& test_case)>
      passages = nullptr;
  std::vector<FailureKind> kinds = {};

  // Of a failed run: its number, or how many there are when it is of none.
  std::size_t KindOf(MetricValues metrics) const;
  // Of a failed run. Nothing where it reports none, or kNowhere.
  std::optional<sim::Vec2> PlaceOf(MetricValues metrics) const;
  // FailurePlace::same_within, or 0.
  double SameWithin() const { return place ? place->same_within : 0.0; }
  // Whether they are the coordinates of the place.
  bool ArePlaces(std::span<const DescriptorAxis> given) const;
};

// A way in which the whole swarm can fail, as Evaluate reports it in SwarmFailure.
struct FailureType {
  int type = 0;  // SwarmFailure::type: stored, so do not renumber
  std::string name;
  std::string column = "";  // where it stands in a map of the types, in words; "" = they have no such order
  std::string row = "";
  bool operator==(const FailureType&) const = default;
};

// What the numbers in SwarmFailure::type stand for.
struct FailureTypes {
  std::vector<FailureType> types = {};
  std::string columns = "";  // of a map of the types: what these are
  std::string rows = "";
  std::string untyped = "without a type";  // a total failure of none of the types
  std::string note = "";                   // what was measured about total failures and their types
  bool operator==(const FailureTypes&) const = default;

  // nullptr: of none of them.
  const FailureType* Find(int type) const;
};

}  // namespace gauntlet::controllers
