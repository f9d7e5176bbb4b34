#include "base/system/process_tree.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
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
  std::map<pid_t, pid_t> parents;
  std::error_code failed;
  for (fs::directory_iterator entry("/proc", failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename();
    pid_t process = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), process).ec == std::errc())
      parents[process] = ParentOf(process);
  }
  std::vector<pid_t> below;
  for (const auto& [process, parent] : parents) {
    pid_t above = parent;
    // Read one after the other, the parents may form a circle where a number was given again.
    for (std::size_t steps = 0; above > 1 && above != ancestor && steps < parents.size(); ++steps) {
      const auto known = parents.find(above);
      above = known == parents.end() ? 0 : known->second;
    }
    if (above == ancestor && above > 1) below.push_back(process);
  }
  return below;
}

std::vector<pid_t> SampleBelow(pid_t ancestor) {
  static const bool listed = access("/proc/thread-self/children", F_OK) == 0;
  if (!listed) return ProcessesBelow(ancestor);
  std::vector<pid_t> below{ancestor};
  for (std::size_t i = 0; i < below.size(); ++i) {
    std::error_code gone;
    fs::directory_iterator thread("/proc/" + std::to_string(below[i]) + "/task", gone);
    for (const fs::directory_iterator end; !gone && thread != end; thread.increment(gone)) {
      std::ifstream children(thread->path() / "children");
      for (pid_t child = 0; children >> child;) below.push_back(child);
    }
  }
  below.erase(below.begin());
  return below;
}

std::size_t TasksOfMachine() {
  std::ifstream load("/proc/loadavg");
  std::string averages;
  std::string tasks;  // "2/345": running, all
  load >> averages >> averages >> averages >> tasks;
  std::size_t all = 0;
  const std::size_t slash = tasks.find('/');
  if (slash != std::string::npos) std::from_chars(tasks.data() + slash + 1, tasks.data() + tasks.size(), all);
  return all;
}

bool GroupExceeds(pid_t group, std::size_t most) {
  std::size_t found = 0;
  std::error_code failed;
  for (fs::directory_iterator entry("/proc", failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename();
    pid_t process = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), process).ec != std::errc()) continue;
    if (getpgid(process) == group && ++found > most) return true;
  }
  return false;
}

int ThreadsOf(pid_t process) {
  std::error_code failed;
  const fs::directory_iterator threads("/proc/" + std::to_string(process) + "/task", failed);
  return failed ? 0 : static_cast<int>(std::distance(begin(threads), end(threads)));
}

double CpuSecondsOf(pid_t process) {
  std::istringstream fields(StatFromState("/proc/" + std::to_string(process) + "/stat"));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double ticks = 0.0;
  double all = 0.0;
  for (int field = 14; field < 18 && fields >> ticks; ++field) all += ticks;
  return all / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::uint64_t ResidentBytesOf(pid_t process) {
  std::ifstream sizes("/proc/" + std::to_string(process) + "/statm");
  std::uint64_t all = 0;
  std::uint64_t resident = 0;
  sizes >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
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
