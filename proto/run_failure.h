// A runner's failure in words, as a run's verdict and as its result.
#pragma once

#include <string>

#include "proto/messages.h"
#include "sim/run_result.h"

namespace gauntlet::proto {

// One line for a person, "crashed with signal 11". Do not change: it is the hashed message of a run that is
// given up, and says nothing that depends on the machine or the worker.
std::string Describe(const RunnerFailure& failure);

// The result of a run that is given up after such a failure, with its verdict, Describe's words and the hash.
// The kind is not kExternal.
sim::RunResult ResultOf(const RunnerFailure& failure);

}  // namespace gauntlet::proto
