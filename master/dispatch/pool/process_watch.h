// Notices at once when a process of this machine ends that is not our child, and tells a starving one from a
// frozen one.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "base/system/process_identity.h"
#include "base/system/unique_fd.h"

namespace gauntlet {

// Readable when the process has ended, closed on exec. Invalid: there is none, or the kernel is older than
// Linux 5.3 (pidfd_open).
UniqueFd OpenProcess(pid_t pid);

// Thread-safety: one thread. Nobody can be watched where OpenProcess has nothing.
class ProcessWatch {
 public:
  ProcessWatch();

  // From now on the end of the process is told under this name; a former process of the name is forgotten.
  // False, and nothing is watched, unless the process certainly is one of this machine and pid namespace and
  // lives. At most kMost processes are watched: each takes a descriptor.
  bool Watch(std::uint64_t name, const ProcessIdentity& process);
  void Forget(std::uint64_t name);
  // Readable when TakeEnded has something; -1 when nobody can be watched.
  int fd() const { return epoll_.get(); }
  // Names of processes that have ended since the last call; they are forgotten.
  std::vector<std::uint64_t> TakeEnded();

  // Is the watched process ready to run, and does it wait for a processor that others have? Not when it is
  // stopped, sleeps or is not watched.
  bool WaitsForProcessor(std::uint64_t name) const;

  static constexpr std::size_t kMost = 1024;

 private:
  UniqueFd epoll_;
  ProcessIdentity self_;
  struct Watched {
    UniqueFd pidfd;
    pid_t pid;
  };
  std::map<std::uint64_t, Watched> watched_;
};

}  // namespace gauntlet
