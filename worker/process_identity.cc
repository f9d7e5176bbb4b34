#include "worker/process_identity.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>

namespace gauntlet::worker {

void IdentifyThisProcess(Hello& hello) {
  hello.pid = getpid();
  std::ifstream boot_id("/proc/sys/kernel/random/boot_id");
  std::getline(boot_id, hello.boot_id);

  std::array<char, 128> target{};
  const ssize_t size = readlink("/proc/self/ns/pid", target.data(), target.size());
  hello.pid_namespace.assign(target.data(), size > 0 ? static_cast<std::size_t>(size) : 0);

  std::ifstream file("/proc/self/stat");
  std::string stat;
  std::getline(file, stat);
  // The second field is the program's name in parentheses, which may hold anything.
  std::istringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
  std::string skipped;
  for (int field = 3; field < 22; ++field) fields >> skipped;
  if (!(fields >> hello.start_time)) hello.start_time = 0;
}

}  // namespace gauntlet::worker
