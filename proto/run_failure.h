// A runner's failure in words, as a run's verdict and as its result.
#pragma once

#include <string>
#include <string_view>

#include "proto/messages.h"
#include "sim/run_result.h"

namespace gauntlet::proto {

// Exit codes by which a run's process says why it gave up. Outside the range that programs commonly use.
inline constexpr int kExitUnheard = 85;  // its result could not be handed over: it closed our files
inline constexpr int kExitOutOfMemory = 86;
inline constexpr int kExitException = 87;
inline constexpr int kExitWithoutPlugin = 88;  // the plug-in that it needs cannot be had here
inline constexpr int kExitWithoutResult = 89;  // somebody called exit(0) before there was a result
// Of runs that are a program: it ended with one of these codes itself, as the last line on stderr says.
inline constexpr int kExitOfProgram = 90;
inline constexpr int kExitOverDisk = 91;        // its folder grew beyond its limit
inline constexpr int kExitWithoutMetrics = 92;  // it ended with code 0, but not with what is asked of it
inline constexpr int kExitOverProcesses = 93;   // it had more processes than it may
// And so much more than the number of a signal that a plug-in sent to itself, as a shell says it.
inline constexpr int kExitSignalled = 128;

// One line for a person, "crashed with signal 11". Do not change: it is the hashed message of a run that is
// given up, and says nothing that depends on the machine or the worker.
std::string Describe(const RunnerFailure& failure);

// Describe's words and what their number stands for: "crashed with exit code 87 (an exception that nobody
// caught)". Other messages as they are.
std::string Explained(std::string_view message);

// The result of a run that is given up after such a failure, with its verdict, Describe's words and the hash.
sim::RunResult ResultOf(const RunnerFailure& failure);

}  // namespace gauntlet::proto
