// What a search over settings asks for, decided apart from who asks: the same cases under settings that
// follow from what the runs under earlier ones gave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "search/experiment/varied_keys.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// A run of a given case under one of the settings, both from 0.
struct SettingsRun {
  std::size_t setting = 0;
  std::size_t of_case = 0;
};

// Pure: the same runs for the same outcomes.
class SettingsCourse {
 public:
  virtual ~SettingsCourse() = default;

  virtual const std::vector<VariedKey>& varied() const = 0;
  virtual std::vector<KeyValue> ValuesOf(std::size_t setting) const = 0;
  // Of its own, in place of the run's given case; nothing: that one.
  virtual std::optional<sim::TestCase> CaseOf(std::size_t /*setting*/) const { return std::nullopt; }
  // Whether a setting has one run, so that nothing of it has to be kept once it is told.
  virtual bool Once() const { return false; }
  // Of the next stage, once all runs of the last are told; empty at the end.
  virtual std::vector<SettingsRun> Next() = 0;
  // In the order of Next.
  virtual void Tell(const SettingsRun& run, const RunOutcome& outcome) = 0;
  // Whether Next would give nothing, once all runs of a stage are told.
  virtual bool AtEnd() const = 0;
  virtual std::size_t stages() const = 0;         // that have begun
  virtual std::uint64_t RunsPlanned() const = 0;  // at most
  virtual bool WantsMetrics() const = 0;          // Tell needs RunOutcome::metrics
};

}  // namespace gauntlet
