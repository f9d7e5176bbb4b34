#include "master/dispatch/pool/process_watch.h"

#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>

namespace gauntlet {

ProcessWatch::ProcessWatch() : epoll_(epoll_create1(EPOLL_CLOEXEC)), self_(IdentifyThisProcess()) {}

ProcessWatch::~ProcessWatch() {
  for (const auto& [name, process] : watched_) close(process.pidfd);
  if (epoll_ >= 0) close(epoll_);
}

bool ProcessWatch::Watch(std::uint64_t name, const ProcessIdentity& process) {
  Forget(name);
  if (watched_.size() >= kMost || process.pid <= 0) return false;
  if (LivenessOf(process, self_) != Liveness::kAlive) return false;
  // By number: the header of glibc 2.36 gives pidfd_open C++ linkage. Closed on exec.
  const int pidfd = static_cast<int>(syscall(SYS_pidfd_open, process.pid, 0));
  if (pidfd < 0) return false;
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = name;
  // Asked once more: between the first question and the descriptor the pid may have become another's.
  if (LivenessOf(process, self_) != Liveness::kAlive ||
      epoll_ctl(epoll_, EPOLL_CTL_ADD, pidfd, &event) != 0) {
    close(pidfd);
    return false;
  }
  watched_.emplace(name, Watched{pidfd, process.pid});
  return true;
}

void ProcessWatch::Forget(std::uint64_t name) {
  const auto found = watched_.find(name);
  if (found == watched_.end()) return;
  close(found->second.pidfd);  // which takes it out of the epoll set too
  watched_.erase(found);
}

bool ProcessWatch::WaitsForProcessor(std::uint64_t name) const {
  const auto found = watched_.find(name);
  return found != watched_.end() && AnyThreadIsRunnable(found->second.pid);
}

std::vector<std::uint64_t> ProcessWatch::TakeEnded() {
  std::vector<std::uint64_t> ended;
  std::array<epoll_event, 64> events{};
  for (int count = 0; (count = epoll_wait(epoll_, events.data(), events.size(), 0)) > 0;) {
    for (int i = 0; i < count; ++i) {
      ended.push_back(events.at(static_cast<std::size_t>(i)).data.u64);
      Forget(ended.back());
    }
  }
  return ended;
}

}  // namespace gauntlet
