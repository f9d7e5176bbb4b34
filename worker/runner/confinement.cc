#include "worker/runner/confinement.h"

#include <linux/capability.h>
#include <poll.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/system/process_tree.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {
namespace {

// A call that does something to the process, thread or group that this argument names; 0 is the caller's own.
struct NamingCall {
  int call;
  unsigned argument;
};
constexpr std::array kNamingCalls = {
    NamingCall{SCMP_SYS(kill), 0},
    NamingCall{SCMP_SYS(tkill), 0},
    NamingCall{SCMP_SYS(tgkill), 0},
    NamingCall{SCMP_SYS(rt_sigqueueinfo), 0},
    NamingCall{SCMP_SYS(rt_tgsigqueueinfo), 0},
    NamingCall{SCMP_SYS(pidfd_open), 0},
    NamingCall{SCMP_SYS(ptrace), 1},
    NamingCall{SCMP_SYS(process_vm_readv), 0},
    NamingCall{SCMP_SYS(process_vm_writev), 0},
    NamingCall{SCMP_SYS(move_pages), 0},
    NamingCall{SCMP_SYS(migrate_pages), 0},
    NamingCall{SCMP_SYS(prlimit64), 0},
    NamingCall{SCMP_SYS(setpgid), 1},
    NamingCall{SCMP_SYS(setpriority), 1},
    NamingCall{SCMP_SYS(ioprio_set), 1},
    NamingCall{SCMP_SYS(sched_setaffinity), 0},
    NamingCall{SCMP_SYS(sched_setattr), 0},
    NamingCall{SCMP_SYS(sched_setparam), 0},
    NamingCall{SCMP_SYS(sched_setscheduler), 0},
};
constexpr std::array kStartingCalls = {SCMP_SYS(clone), SCMP_SYS(fork), SCMP_SYS(vfork)};
// They name a process by a descriptor, which may have come from anywhere.
constexpr std::array kRefusedCalls = {SCMP_SYS(pidfd_send_signal), SCMP_SYS(pidfd_getfd),
                                      SCMP_SYS(process_madvise)};
// What a super-user keeps: rights over files, as a run in a container needs them, and ports below 1024.
constexpr std::array kKeptCapabilities = {CAP_CHOWN,  CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH,
                                          CAP_FOWNER, CAP_FSETID,       CAP_NET_BIND_SERVICE};

// A process alone is told of its limit by a signal, and ends of it up to a second later.
constexpr double kMargin = 2.0;  // s

void DropCapabilities() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
  if (syscall(SYS_capget, &header, sets.data()) != 0) return;
  for (std::size_t part = 0; part < sets.size(); ++part) {
    std::uint32_t kept = 0;
    for (const int capability : kKeptCapabilities) {
      if (CAP_TO_INDEX(capability) == static_cast<int>(part)) kept |= CAP_TO_MASK(capability);
    }
    sets[part].effective &= kept;
    sets[part].permitted &= kept;
    sets[part].inheritable &= kept;
  }
  syscall(SYS_capset, &header, sets.data());
}

bool AddRules(scmp_filter_ctx filter, Starting starting) {
  const auto add = [&](std::uint32_t action, int call) {
    return seccomp_rule_add_array(filter, action, call, 0, nullptr) == 0;
  };
  for (const NamingCall& naming : kNamingCalls) {
    const scmp_arg_cmp others{.arg = naming.argument, .op = SCMP_CMP_NE, .datum_a = 0, .datum_b = 0};
    if (seccomp_rule_add_array(filter, SCMP_ACT_NOTIFY, naming.call, 1, &others) != 0) return false;
  }
  if (!std::ranges::all_of(kRefusedCalls, [&](int call) { return add(SCMP_ACT_ERRNO(EPERM), call); }))
    return false;
  if (starting == Starting::kFree) return true;
  // What clone3 is asked lies in memory, which a filter does not see; the C library then takes clone.
  return std::ranges::all_of(kStartingCalls, [&](int call) { return add(SCMP_ACT_NOTIFY, call); }) &&
         add(SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3));
}

}  // namespace

UniqueFd ConfineToTree(Starting starting) {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  DropCapabilities();
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
  if (filter == nullptr) return UniqueFd();
  UniqueFd listener;
  seccomp_attr_set(filter, SCMP_FLTATR_CTL_SSB, 1);  // processors speculate as without a filter
  if (AddRules(filter, starting) && seccomp_load(filter) == 0) listener.Reset(seccomp_notify_fd(filter));
  seccomp_release(filter);
  return listener;
}

void CloseAllBut(const std::set<int>& kept) {
  std::vector<int> open;
  std::error_code failed;
  std::filesystem::directory_iterator entry("/proc/self/fd", failed);
  for (const std::filesystem::directory_iterator end; !failed && entry != end; entry.increment(failed))
    open.push_back(std::stoi(entry->path().filename()));
  entry = {};
  for (const int fd : open) {
    if (fd > STDERR_FILENO && !kept.contains(fd)) close(fd);
  }
}

void HideFromOthers() {
  // The leak sanitizer looks into its own process from another one.
  if (kMemoryLimitWorks) prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
}

void ShowToOthers() {
  prctl(PR_SET_DUMPABLE, 1, 0, 0, 0);
}

struct TreeGuard::Messages {
  Messages() { seccomp_notify_alloc(&request, &response); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  ~Messages() { seccomp_notify_free(request, response); }

  seccomp_notif* request = nullptr;
  seccomp_notif_resp* response = nullptr;
};

// Whoever asks is woken on the processor on which it was answered, since the guard then waits (Linux 6.6).
// Its number and flag, which headers of older systems lack.
constexpr unsigned long kSetFlags = _IOW('!', 4, std::uint64_t);
constexpr unsigned long kSynchronousWakeUp = 1;

TreeGuard::TreeGuard(UniqueFd listener, pid_t root)
    : listener_(std::move(listener)), root_(root), messages_(std::make_unique<Messages>()) {
  ioctl(listener_.get(), kSetFlags, kSynchronousWakeUp);
}

TreeGuard::~TreeGuard() = default;

bool TreeGuard::ServeUntilReadable(int fd, double cpu_limit) {
  constexpr std::chrono::milliseconds kLook{1000};  // a look costs 1 ms
  auto next_look = std::chrono::steady_clock::now() + kLook;
  bool ended = false;
  while (true) {
    std::array<pollfd, 2> polled{{{.fd = fd, .events = POLLIN, .revents = 0},
                                  {.fd = listener_.get(), .events = POLLIN, .revents = 0}}};
    if (poll(polled.data(), polled.size(), static_cast<int>(kLook.count())) < 0) continue;
    if (polled[0].revents != 0) return ended;
    Serve(polled[1].revents);
    if (cpu_limit <= 0.0 || std::chrono::steady_clock::now() < next_look) continue;
    ended = EndIfOver(cpu_limit) || ended;
    next_look = std::chrono::steady_clock::now() + kLook;
  }
}

void TreeGuard::Serve(short found) {
  if ((found & POLLIN) != 0) {
    Answer();
  } else if (found != 0) {
    listener_.Reset();  // nobody is left who could ask
  }
}

bool TreeGuard::EndIfOver(double cpu_limit) const {
  const std::vector<pid_t> below = ProcessesBelow(root_);
  double seconds = 0.0;
  for (const pid_t process : below) seconds += CpuSecondsOf(process);
  if (seconds <= cpu_limit + kMargin) return false;
  for (const pid_t process : below) kill(process, SIGKILL);
  return true;
}

void TreeGuard::Answer() {
  *messages_->request = {};  // or the kernel refuses to fill it
  if (seccomp_notify_receive(listener_.get(), messages_->request) != 0)
    return;  // who asked was killed meanwhile
  seccomp_notif_resp& response = *messages_->response;
  const int call = messages_->request->data.nr;
  const bool starts = std::ranges::find(kStartingCalls, call) != kStartingCalls.end();
  response = {};
  response.id = messages_->request->id;
  if (starts ? HasRoom() : Allows()) {
    response.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
  } else {
    response.error = starts ? -EAGAIN : -EPERM;
  }
  seccomp_notify_respond(listener_.get(), &response);
}

bool TreeGuard::Allows() const {
  const seccomp_notif& request = *messages_->request;
  const auto* naming = std::ranges::find(kNamingCalls, request.data.nr, &NamingCall::call);
  if (naming == kNamingCalls.end()) return false;
  const auto named = static_cast<pid_t>(request.data.args[naming->argument]);
  if (named == root_ || named == 0) return static_cast<pid_t>(request.pid) == root_ || named == 0;
  if (named == -1) return false;
  return IsBelow(named < 0 ? -named : named, root_);
}

bool TreeGuard::HasRoom() {
  const auto now = std::chrono::steady_clock::now();
  if (now < full_until_) return false;
  if (tasks_ >= kMostTasksOfTree) {
    tasks_ = ThreadsOf(root_);
    for (const pid_t process : ProcessesBelow(root_)) tasks_ += ThreadsOf(process);
  }
  // Whoever asks in vain and without end gets the answer at once, and uses its own time.
  if (tasks_ >= kMostTasksOfTree) {
    full_until_ = now + std::chrono::milliseconds(100);
    return false;
  }
  ++tasks_;
  return true;
}

}  // namespace gauntlet::worker
