#include "master/dispatch/process_identity.h"

#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

namespace gauntlet::master {
namespace {

std::string HostName() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

std::string FirstLineOf(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string TargetOf(const char* link) {
  std::array<char, 128> target{};
  const ssize_t size = readlink(link, target.data(), target.size());
  return size > 0 ? std::string(target.data(), static_cast<std::size_t>(size)) : std::string();
}

}  // namespace

std::optional<std::uint64_t> StartTimeOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::ostringstream stat;
  if (!(stat << file.rdbuf())) return std::nullopt;
  const std::string text = stat.str();
  // The second field is the program's name in parentheses, which may hold anything.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  std::string state;
  fields >> state;
  if (state == "Z" || state == "X") return std::nullopt;
  std::string skipped;
  for (int field = 4; field < 22; ++field) fields >> skipped;
  std::uint64_t start_time = 0;
  if (!(fields >> start_time)) return std::nullopt;
  return start_time;
}

ProcessIdentity IdentifyThisProcess() {
  ProcessIdentity identity;
  identity.host = HostName();
  identity.boot_id = FirstLineOf("/proc/sys/kernel/random/boot_id");
  identity.pid_namespace = TargetOf("/proc/self/ns/pid");
  identity.pid = getpid();
  identity.start_time = StartTimeOf(identity.pid).value_or(0);
  return identity;
}

Liveness LivenessOf(const ProcessIdentity& process, const ProcessIdentity& observer) {
  if (process.boot_id.empty() || process.boot_id != observer.boot_id) return Liveness::kUnknown;
  if (process.pid_namespace != observer.pid_namespace) return Liveness::kUnknown;
  return StartTimeOf(process.pid) == process.start_time ? Liveness::kAlive : Liveness::kDead;
}

}  // namespace gauntlet::master
