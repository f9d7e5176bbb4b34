#include "master/dispatch/pool/process_watch.h"

#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <utility>

namespace gauntlet {

UniqueFd OpenProcess(pid_t pid) {
  // By number: the header of glibc 2.36 gives pidfd_open C++ linkage.
  return UniqueFd(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
}

ProcessWatch::ProcessWatch() : epoll_(epoll_create1(EPOLL_CLOEXEC)), self_(IdentifyThisProcess()) {}

bool ProcessWatch::Watch(std::uint64_t name, const ProcessIdentity& process) {
  Forget(name);
  if (watched_.size() >= kMost || process.pid <= 0) return false;
  if (LivenessOf(process, self_) != Liveness::kAlive) return false;
  UniqueFd pidfd = OpenProcess(process.pid);
  if (!pidfd.valid()) return false;
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = name;
  // Asked once more: between the first question and the descriptor the pid may have become another's.
  if (LivenessOf(process, self_) != Liveness::kAlive ||
      epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, pidfd.get(), &event) != 0)
    return false;
  watched_.emplace(name, Watched{std::move(pidfd), process.pid});
  return true;
}

void ProcessWatch::Forget(std::uint64_t name) {
  watched_.erase(name);  // its descriptor is closed, which takes it out of the epoll set too
}

bool ProcessWatch::WaitsForProcessor(std::uint64_t name) const {
  const auto found = watched_.find(name);
  return found != watched_.end() && AnyThreadIsRunnable(found->second.pid);
}

std::vector<std::uint64_t> ProcessWatch::TakeEnded() {
  std::vector<std::uint64_t> ended;
  std::array<epoll_event, 64> events{};
  for (int count = 0; (count = epoll_wait(epoll_.get(), events.data(), events.size(), 0)) > 0;) {
    for (int i = 0; i < count; ++i) {
      // A copy: the kernel's struct is packed, and its members are not aligned for a reference.
      const std::uint64_t name = events.at(static_cast<std::size_t>(i)).data.u64;
      ended.push_back(name);
      Forget(name);
    }
  }
  return ended;
}

}  // namespace gauntlet
