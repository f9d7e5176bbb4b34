#include "base/system/process_identity.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace gauntlet {
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

std::string StatFromState(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  std::getline(file, text, '\0');  // nothing, and no exception, when the process ends meanwhile
  // The second field is the program's name in parentheses, which may hold anything.
  const std::size_t name_end = text.rfind(") ");
  return name_end == std::string::npos ? "" : text.substr(name_end + 2);
}

std::optional<std::uint64_t> StartTimeOf(pid_t pid) {
  std::istringstream fields(StatFromState("/proc/" + std::to_string(pid) + "/stat"));
  std::string state;
  if (!(fields >> state)) return std::nullopt;
  if (state == "Z" || state == "X") return std::nullopt;
  std::string skipped;
  for (int field = 4; field < 22; ++field) fields >> skipped;
  std::uint64_t start_time = 0;
  if (!(fields >> start_time)) return std::nullopt;
  return start_time;
}

pid_t ParentOf(pid_t pid) {
  std::istringstream fields(StatFromState("/proc/" + std::to_string(pid) + "/stat"));
  std::string state;
  pid_t parent = 0;
  fields >> state >> parent;
  return parent;
}

bool AnyThreadIsRunnable(pid_t pid) {
  std::error_code gone;
  std::filesystem::directory_iterator thread("/proc/" + std::to_string(pid) + "/task", gone);
  for (; !gone && thread != std::filesystem::directory_iterator(); thread.increment(gone)) {
    if (StatFromState(thread->path().string() + "/stat").starts_with("R")) return true;
  }
  return false;
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

}  // namespace gauntlet
