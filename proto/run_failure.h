// A runner's failure in words and as a run's verdict.
#pragma once

#include <string>

#include "master/dispatch/scheduler.h"
#include "sim/run_result.h"

namespace gauntlet::master {

// "crashed with signal 11". Part of the hashed message of a run that is given up: it must not depend on the
// machine or the worker. Do not change.
std::string DescribeFailure(const RunFailure& failure);

// The verdict of a run that is given up after such a failure; kind is not kExternal.
sim::Verdict VerdictOf(FailureKind kind);

}  // namespace gauntlet::master
