// gauntlet-worker as a helper program: one simulation outside of any campaign, questions to plug-ins, and the
// golden hashes of this machine.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "proto/golden_hashes.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet {

// Simulates a run in a runner, under the limits of any run, and returns the result (not checked against
// anything). `scratch`: working directory of a plug-in's run, which keeps what it writes; "": one that is
// removed.
Result<sim::RunResult> SimulateInRunner(const sim::RunSpec& spec, const std::string& scratch = "");

// Whether only we could have written DIR/plugins/HASH.so, its folder and DIR (CheckOnlyWeWrite).
Status CheckCopyIsOurs(const std::string& file);

// The library of a plug-in that is known, to be run or copied in our name. Error: it was brought along by a
// directory that somebody else could have filled; the file is gone, or holds something else.
Result<std::string> ReadPlugin(const std::string& hash);
// The same of DIR/plugins/HASH.so.
Result<std::string> ReadCopy(const std::string& file, const std::string& hash);

// What the library brings, as gauntlet-worker describes it (controllers/rows/plugin_rows.h). Error: what is
// wrong with it.
Result<std::string> DescribePlugin(const std::string& file);

// How a run begins whose scenario a plug-in brings, as gauntlet-worker says it, which loads the library
// (proto/run_beginning.h). The plug-in is known. Error: why there is no answer.
Result<std::string> DescribeBeginning(const sim::RunSpec& spec);

// Of those of these controllers that gauntlet-worker was built with, and of commands, which are known: those
// are named by kGoldenPrefix (controllers/command/definition.h), and their golden hash is of what their probe
// prints here.
Result<proto::GoldenHashes> GoldenHashesOfThisMachine(const std::vector<std::string>& names);

}  // namespace gauntlet
