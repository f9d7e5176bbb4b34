// Runs as rows: the one list of columns that `export` writes and `show --json --runs` prints.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "master/store/result_store.h"
#include "report/tables/search_columns.h"

namespace gauntlet {

class RunTable {
 public:
  // The metrics are those of each search's first completed run. Error: it does not read back.
  static Result<RunTable> Make(const std::vector<SearchPlan>& plans, ResultStore& store);

  const std::vector<DataColumn>& columns() const { return columns_; }
  // `run`: whole, with its result. Error: kCorrupt, naming the run.
  Result<std::vector<Value>> Row(const StoredRun& run) const;

 private:
  struct Metric {
    std::size_t place = 0;  // among the columns
    const controllers::MetricInfo* info = nullptr;
  };

  RunTable(const std::vector<SearchPlan>& plans, const std::vector<std::vector<std::string>>& metrics);

  SearchColumns searches_;
  std::vector<DataColumn> columns_;
  std::vector<std::map<std::string, Metric>> metrics_;  // [search], by name
  std::vector<std::string> untyped_failures_;           // [search]: what a total failure without a type is
};

// The columns that every campaign has, in front of the metrics and behind them.
struct RunColumns {
  std::vector<DataColumn> before_metrics;
  std::vector<DataColumn> after_metrics;
};
RunColumns CommonRunColumns();

}  // namespace gauntlet
