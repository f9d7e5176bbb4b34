// What `export` writes of a campaign, row by row.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "master/campaign/stored_campaign.h"
#include "report/tables/data_table.h"

namespace gauntlet {

enum class Exported { kRuns, kCases, kTrajectories, kEvents };

struct ExportOptions {
  Exported what = Exported::kRuns;
  TableFormat format = TableFormat::kCsv;
  std::set<RunId> runs = {};  // of runs and trajectories: only these; empty = all
};

struct ExportReport {
  std::uint64_t rows = 0;
  std::uint64_t simulated = 0;  // runs whose trajectories were not kept, simulated again and found the same
};

// Writes the table to `sink`. `head`: the text of a JSON object that the rows continue. Needs memory for the
// test cases of one search at most. Errors: those of reading and of `sink`; kNotFound when one of `runs` is
// not there; kCorrupt when a run that was simulated again is not the same.
Result<ExportReport> WriteTable(const StoredCampaign& campaign, const ExportOptions& options,
                                const std::string& head, const Sink& sink);

// The columns of such a table, to be described: "..." stands for the metrics of a run; those of the keys of a
// sweep are left out.
std::vector<DataColumn> CommonColumns(Exported what);

}  // namespace gauntlet
