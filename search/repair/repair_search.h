// A search for values of a controller's parameters with which it fails less (repair_course.h).
#pragma once

#include <memory>
#include <utility>

#include "search/repair/repair_course.h"
#include "search/search_row.h"
#include "search/settings/settings_search.h"

namespace gauntlet {

class RepairSearch final : public SettingsSearch {
 public:
  // Error: that of MakeRepairPlan.
  static Result<std::unique_ptr<RepairSearch>> Create(const SearchSetup& setup);

  const RepairCourse* Repair() const override { return course_.get(); }

 private:
  RepairSearch(const SearchSetup& setup, std::unique_ptr<RepairCourse> course)
      : SettingsSearch(setup, *course), course_(std::move(course)) {}

  std::unique_ptr<RepairCourse> course_;
};

SearchRow RepairRow();

}  // namespace gauntlet
