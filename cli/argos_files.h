// Runs of a campaign as .argos files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "base/result.h"
#include "master/campaign/stored_campaign.h"
#include "sim/run_spec.h"

namespace gauntlet {

struct ArgosFilesOptions {
  std::set<RunId> runs = {};    // a file for each of them; empty: for the first run of each test case
  std::string controller_file;  // whose <controllers> the robots get; "" = a placeholder
  std::string controller;       // the id of one of them; "" = the only one
};

struct ArgosFilesReport {
  std::uint64_t files = 0;
  std::map<std::string, std::uint64_t> notices;  // sentences, and of how many files each is true
};

// Writes into `directory`, which exists. Error: a run that is not there, one of `runs` that cannot begin, a
// controller file that cannot be read or that ARGoS would not load, writing. A test case that cannot begin
// has no file, and a notice says so.
Result<ArgosFilesReport> WriteArgosFiles(const StoredCampaign& campaign, const ArgosFilesOptions& options,
                                         const std::filesystem::path& directory);

// The <controllers> of ARGoS with the parameters of a run: of an adopted project those of its own file, else
// those of the options' controller_file; "" when there is none. Error: as WriteArgosFiles has it.
Result<std::string> ControllersWithParameters(const sim::RunSpec& spec, const ArgosFilesOptions& options);

}  // namespace gauntlet
