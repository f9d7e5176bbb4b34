// The columns that tell the searches of a campaign apart, with which rows of exported tables begin.
#pragma once

#include <vector>

#include "master/directory/search_plans.h"
#include "report/tables/data_table.h"

namespace gauntlet {

class SearchColumns {
 public:
  // `plans`: in the order of the searches' numbers.
  explicit SearchColumns(const std::vector<SearchPlan>& plans);

  // search, search_name, search_seed, and each key of the experiment in which searches differ.
  const std::vector<DataColumn>& columns() const { return columns_; }
  const std::vector<Value>& CellsOf(SearchId search) const { return cells_.at(search - 1); }

 private:
  std::vector<DataColumn> columns_;
  std::vector<std::vector<Value>> cells_;  // [search]
};

// Those that every campaign has.
std::vector<DataColumn> CommonSearchColumns();

}  // namespace gauntlet
