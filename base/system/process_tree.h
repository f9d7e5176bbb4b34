// Processes of this machine by who started whom.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gauntlet {

// Whether `ancestor` has started this process or thread, or what has started it. Orphans belong to the
// process that takes them over (PR_SET_CHILD_SUBREAPER).
bool IsBelow(pid_t process, pid_t ancestor);

// All processes below `ancestor`, in no order. A look at every process of the machine, about 1 ms.
std::vector<pid_t> ProcessesBelow(pid_t ancestor);
// The same by a look at those processes alone, where the kernel lists children (CONFIG_PROC_CHILDREN): for
// who looks often. Some that start or end meanwhile may be missing.
std::vector<pid_t> SampleBelow(pid_t ancestor);

// Processes and threads of the whole machine, from a look of some microseconds; 0 when that cannot be said.
std::size_t TasksOfMachine();

// Whether a process group has more processes than that. Looks at no more than it must.
bool GroupExceeds(pid_t group, std::size_t most);

// Threads of a process; 0 when there is none.
int ThreadsOf(pid_t process);

// User and system time of a process and of its children that have ended, s; 0 when there is none.
double CpuSecondsOf(pid_t process);
// What of its memory is in RAM, bytes, shared pages included; 0 when there is none.
std::uint64_t ResidentBytesOf(pid_t process);

// Whether this process has children, ended ones that nobody has waited for included.
bool HasChildren();

// From now on this process is the parent of its descendants' orphans.
void TakeOrphans();
// Ends and reaps all processes below this one.
void EndProcessesBelow();

}  // namespace gauntlet
