// What the operating system lets this process have, and what is said when that is too little.
#pragma once

#include <sys/resource.h>

#include <exception>
#include <optional>
#include <string>

#include "base/result.h"

namespace gauntlet {

// To be called first by every program. From then on nothing that this process or its children make can be
// written by the group or by others, and writing beyond the largest size of a file (RLIMIT_FSIZE) is an
// error, not a signal that ends the process. Error: fewer files may be open than any command needs.
Status PrepareProgram();

// Raises the soft limit of open files (RLIMIT_NOFILE) to `needed`, unless it is higher. kInvalidInput, when
// the hard one is below, says "`who` need up to ... open files".
Status AllowOpenFiles(rlim_t needed, const std::string& who);

// Sets the soft limit of this process, no higher than the hard one: a lowered hard limit could never be
// raised again.
void SetSoftLimit(__rlimit_resource resource, rlim_t wanted);
// Lowers both limits of this process for good, the soft one to `wanted` and the hard one so much above it.
void SetHardLimit(__rlimit_resource resource, rlim_t wanted, rlim_t above = 0);

// User and system time, s.
double CpuSecondsOf(const rusage& usage);

// The limits of this process that are not infinite, for messages: "60 open files (ulimit -n), ...".
std::string DescribeLimits();

// What an exception says of the machine: kNoSpace, with the limits, when there was no memory, no thread or no
// file to be had; nothing when it is about something else.
std::optional<Error> ErrorOfResources(const std::exception& exception);

// ZeroMQ ends the process by abort(3) when it gets no thread, no memory or no file. From now on such an end
// is one sentence on stderr, with the limits, and kExitWithoutResources. Broken invariants of our own
// (GAUNTLET_CHECK) still abort. `program`, which the sentence begins with, must live for ever.
void ExplainAborts(const char* program);
inline constexpr int kExitWithoutResources = 3;

}  // namespace gauntlet
