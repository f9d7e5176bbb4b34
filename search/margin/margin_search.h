// A search along the range of one key: the same cases under values of it, where the failure rate is found to
// change (margin_stages.h).
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "search/margin/margin_stages.h"
#include "search/search_row.h"
#include "search/settings/settings_search.h"

namespace gauntlet {

// The stages of a margin as those of a search over settings, one for each value.
class MarginCourse final : public SettingsCourse {
 public:
  MarginCourse(MarginPlan plan, std::string_view failing);

  const MarginStages& margin() const { return stages_; }

  const std::vector<VariedKey>& varied() const override { return varied_; }
  std::vector<KeyValue> ValuesOf(std::size_t setting) const override { return values_[setting]; }
  std::vector<SettingsRun> Next() override;
  void Tell(const SettingsRun& run, const RunOutcome& outcome) override;
  bool AtEnd() const override { return MarginStages(stages_).Next().empty(); }
  std::size_t stages() const override { return stages_.stages(); }
  std::uint64_t RunsPlanned() const override { return static_cast<std::uint64_t>(stages_.plan().runs); }
  bool WantsMetrics() const override;

 private:
  MarginStages stages_;
  std::vector<VariedKey> varied_;
  std::string_view failing_;
  std::vector<double> numbers_;  // of the settings
  std::vector<std::vector<KeyValue>> values_;
};

class MarginSearch final : public SettingsSearch {
 public:
  // Error: that of MakeMarginPlan; no case is given; a value of the range breaks a rule, and which; the key
  // disturbs a device that no robot under test has.
  static Result<std::unique_ptr<MarginSearch>> Create(const SearchSetup& setup);

  const MarginStages* Margin() const override { return &course_->margin(); }

 private:
  MarginSearch(const SearchSetup& setup, std::unique_ptr<MarginCourse> course)
      : SettingsSearch(setup, *course), course_(std::move(course)) {}

  std::unique_ptr<MarginCourse> course_;
};

SearchRow MarginRow();

}  // namespace gauntlet
