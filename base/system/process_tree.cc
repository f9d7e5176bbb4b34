#include "base/system/process_tree.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>

#include "base/system/process_identity.h"

namespace gauntlet {

namespace fs = std::filesystem;

bool IsBelow(pid_t process, pid_t ancestor) {
  while (process > 1) {
    process = ParentOf(process);
    if (process == ancestor) return true;
  }
  return false;
}

std::vector<pid_t> ProcessesBelow(pid_t ancestor) {
  std::vector<pid_t> below;
  std::error_code failed;
  for (fs::directory_iterator entry("/proc", failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename();
    pid_t process = 0;
    const bool named = std::from_chars(name.data(), name.data() + name.size(), process).ec == std::errc();
    if (named && IsBelow(process, ancestor)) below.push_back(process);
  }
  return below;
}

int ThreadsOf(pid_t process) {
  std::error_code failed;
  const fs::directory_iterator threads("/proc/" + std::to_string(process) + "/task", failed);
  return failed ? 0 : static_cast<int>(std::distance(begin(threads), end(threads)));
}

bool HasChildren() {
  siginfo_t ended{};
  return waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 || errno != ECHILD;
}

void TakeOrphans() {
  prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);
}

void EndProcessesBelow() {
  while (HasChildren()) {
    for (const pid_t process : ProcessesBelow(getpid())) kill(process, SIGKILL);
    waitpid(-1, nullptr, 0);
    while (waitpid(-1, nullptr, WNOHANG) > 0) continue;
  }
}

}  // namespace gauntlet
