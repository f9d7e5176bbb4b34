#include "worker/runner/control_group.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/parse_number.h"
#include "base/split.h"
#include "base/system/atomic_file.h"
#include "base/system/unique_fd.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFolderMode = 0755;
constexpr const char* kMembers = "cgroup.procs";

// The files of a controller in one version: where its limit is written, and the count of what the limit has
// met, or of the time, in a line "key count" or alone.
struct Files {
  const char* limit;
  const char* counts;
  std::string_view key;
};
struct Controller {
  std::string_view name;  // as hierarchies of version 1 are named
  Files version_1;
  Files version_2;
};
// Documentation/admin-guide/cgroup-v1 and cgroup-v2.rst of Linux.
constexpr std::array<Controller, kGroupControllers> kControllers{{
    {"memory",
     {"memory.limit_in_bytes", "memory.oom_control", "oom_kill"},
     {"memory.max", "memory.events", "oom_kill"}},
    {"pids", {"pids.max", "pids.events", "max"}, {"pids.max", "pids.events", "max"}},
    {"cpuacct", {nullptr, "cpuacct.usage", ""}, {nullptr, "cpu.stat", "usage_usec"}},
}};
constexpr double kSecondsOfVersion1 = 1e-9;
constexpr double kSecondsOfVersion2 = 1e-6;

bool Write(const std::string& file, std::string_view text) {
  const UniqueFd fd(open(file.c_str(), O_WRONLY | O_CLOEXEC));
  return fd.valid() && write(fd.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

bool IsAmong(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

// Of this process, to a microsecond.
double OwnSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + kSecondsOfVersion1 * static_cast<double>(time.tv_nsec);
}

const std::array<GroupPlace, kGroupControllers>& Places() {
  static const std::array<GroupPlace, kGroupControllers> places = [] {
    const Result<std::string> mounts = ReadSmallFile("/proc/self/mountinfo");
    const Result<std::string> membership = ReadSmallFile("/proc/self/cgroup");
    return GroupPlaces(mounts ? *mounts : "", membership ? *membership : "");
  }();
  return places;
}

const Files& FilesOf(std::size_t controller) {
  return Places()[controller].version_2 ? kControllers[controller].version_2
                                        : kControllers[controller].version_1;
}

// What the names of groups begin with whose makers' numbers mean something here: those of our namespace.
const std::string& Prefix() {
  static const std::string prefix = [] {
    struct stat space {};
    return fmt::format("gauntlet-{}-", stat("/proc/self/ns/pid", &space) == 0 ? space.st_ino : 0);
  }();
  return prefix;
}

bool Join(const std::string& folder) {
  return Write(folder + "/" + kMembers, std::to_string(getpid()));
}

void KillMembers(const std::string& folder) {
  const Result<std::string> members = ReadSmallFile(folder + "/" + kMembers);
  if (!members) return;
  for (const std::string_view member : Split(*members, '\n')) {
    const auto process = ParseNumber<pid_t>(member);  // 0: it cannot be seen from here
    if (process && *process > 0) kill(*process, SIGKILL);
  }
}

// The number in a line "key number" of the file; that of the whole file without a key.
std::optional<std::uint64_t> ReadNumber(const std::string& file, std::string_view key) {
  const Result<std::string> text = ReadSmallFile(file);
  if (!text) return std::nullopt;
  for (const std::string_view line : Split(*text, '\n')) {
    if (key.empty()) return ParseNumber<std::uint64_t>(line);
    const std::size_t blank = line.find(' ');
    if (line.substr(0, blank) == key)
      return ParseNumber<std::uint64_t>(blank == line.npos ? "" : line.substr(blank + 1));
  }
  return std::nullopt;
}

std::optional<std::uint64_t> ReadCount(const std::string& folder, std::size_t controller) {
  const Files& files = FilesOf(controller);
  return ReadNumber(folder + "/" + files.counts, files.key);
}

// Whether the controller, if it limits anything, limits to that from now on.
bool WriteLimit(const std::string& folder, std::size_t controller, const ControlGroupLimits& limits) {
  const Files& files = FilesOf(controller);
  const bool memory = controller == kGroupMemory;
  if (files.limit == nullptr) return true;
  if (memory) {
    // What does not fit must not go to the disk instead. There is one of the two files.
    Write(folder + "/memory.swappiness", "0");
    Write(folder + "/memory.swap.max", "0");
  }
  const std::uint64_t number = memory ? limits.memory_bytes : limits.processes;
  std::string text = std::to_string(memory ? number : number + 1);
  if (number == 0) text = memory && !Places()[controller].version_2 ? "-1" : "max";
  return Write(folder + "/" + files.limit, text);
}

}  // namespace

std::array<GroupPlace, kGroupControllers> GroupPlaces(std::string_view mount_info,
                                                      std::string_view membership) {
  const std::vector<std::string> members = Split(membership, '\n');
  std::array<GroupPlace, kGroupControllers> places;
  for (const std::string& line : Split(mount_info, '\n')) {
    // proc_pid_mountinfo(5): 35 31 0:32 /root /mount/point options [tags] - type source options
    const std::vector<std::string> words = Split(line, ' ');
    const auto dash = std::ranges::find(words, "-");
    if (dash - words.begin() < 6 || words.end() - dash < 4) continue;
    const bool version_2 = dash[1] == "cgroup2";
    if (!version_2 && dash[1] != "cgroup") continue;
    const std::vector<std::string> options = Split(dash[3], ',');
    for (std::size_t controller = 0; controller < kGroupControllers; ++controller) {
      const std::string_view name = version_2 ? "" : kControllers[controller].name;
      if (!version_2 && !IsAmong(options, name)) continue;
      GroupPlace& place = places[controller];
      // A controller is in one hierarchy alone; that of version 2 counts time without any.
      if (!place.parents.empty() && version_2) continue;
      const auto own = std::ranges::find_if(members, [&](const std::string& member) {
        const std::vector<std::string> parts = Split(member, ':');  // 4:memory:/path
        return parts.size() >= 3 && IsAmong(Split(parts[1], ','), name);
      });
      if (own == members.end()) continue;
      // Where this process' path is not below the root of what is mounted, it is outside what we see.
      const std::string path = own->substr(own->find(':', own->find(':') + 1) + 1);
      const std::string root = words[3] == "/" ? "" : words[3];
      const std::string below = path.starts_with(root) ? path.substr(root.size()) : "";
      const std::string folder = words[4] + (below == "/" ? "" : below);
      place = {.parents = {folder}, .version_2 = version_2};
      if (folder != words[4]) place.parents.push_back(fs::path(folder).parent_path());
    }
  }
  return places;
}

ControlGroup::~ControlGroup() {
  for (std::size_t controller = 0; controller < kGroupControllers; ++controller) {
    const std::string& folder = parts_[controller].folder;
    if (folder.empty()) continue;
    Join(Places()[controller].parents.front());
    rmdir(folder.c_str());
  }
}

// The folder of a group that this process is in now, or "".
std::string ControlGroup::Enter(std::size_t controller, const ControlGroupLimits& limits) {
  for (const std::string& parent : Places()[controller].parents) {
    const std::string folder = fmt::format("{}/{}{}", parent, Prefix(), getpid());
    const bool is_new = mkdir(folder.c_str(), kFolderMode) == 0;
    if (!is_new && errno != EEXIST) continue;
    if (WriteLimit(folder, controller, limits) && ReadCount(folder, controller) && Join(folder))
      return folder;
    if (is_new) rmdir(folder.c_str());
  }
  return "";
}

void ControlGroup::Limit(const ControlGroupLimits& wanted) {
  ControlGroupLimits limits = wanted;
  // Files in memory that others have left stay charged to the group.
  if (limits_ && limits.memory_bytes > 0)
    limits.memory_bytes += ReadNumber(parts_[kGroupMemory].folder + "/memory.stat", "shmem").value_or(0);
  for (std::size_t controller = 0; controller < kGroupControllers; ++controller) {
    Part& part = parts_[controller];
    if (!limits_) {
      part.folder = Enter(controller, limits);
    } else if (*limits_ != limits && !part.folder.empty()) {
      WriteLimit(part.folder, controller, limits);
    }
    part.count_before = ReadCount(part.folder, controller).value_or(0);
  }
  limits_ = limits;
  own_before_ = OwnSeconds();
}

bool ControlGroup::IsWhole() const {
  return std::ranges::none_of(parts_, [](const Part& part) { return part.folder.empty(); });
}

std::uint64_t ControlGroup::Count(std::size_t controller) const {
  const Part& part = parts_[controller];
  if (part.folder.empty()) return 0;
  const std::uint64_t now = ReadCount(part.folder, controller).value_or(part.count_before);
  return now - std::min(now, part.count_before);
}

std::optional<double> ControlGroup::CpuSeconds() const {
  if (parts_[kGroupTime].folder.empty()) return std::nullopt;
  const double unit = Places()[kGroupTime].version_2 ? kSecondsOfVersion2 : kSecondsOfVersion1;
  return std::max(0.0, unit * static_cast<double>(Count(kGroupTime)) - (OwnSeconds() - own_before_));
}

void ControlGroup::EndThisFirst() {
  Write("/proc/self/oom_score_adj", "1000");  // the most of proc_pid_oom_score_adj(5)
}

void ControlGroup::RemoveAbandoned() {
  for (const GroupPlace& place : Places()) {
    for (const std::string& parent : place.parents) {
      std::error_code failed;
      std::vector<std::string> abandoned;
      for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end;
           entry.increment(failed)) {
        const std::string name = entry->path().filename();
        if (!name.starts_with(Prefix())) continue;
        const auto maker = ParseNumber<pid_t>(std::string_view(name).substr(Prefix().size()));
        if (maker && kill(*maker, 0) != 0 && errno == ESRCH) abandoned.push_back(entry->path());
      }
      for (const std::string& folder : abandoned) {
        KillMembers(folder);
        rmdir(folder.c_str());
      }
    }
  }
}

}  // namespace gauntlet::worker
