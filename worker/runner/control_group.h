// A control group of the kernel (cgroups(7), version 1 or 2) for programs and all that they start: there the
// kernel itself limits their memory and number and counts their time, where this user may make one.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gauntlet::worker {

struct ControlGroupLimits {
  std::uint64_t memory_bytes = 0;  // 0: none
  std::uint64_t processes = 0;     // besides this one, and threads count, too; 0: none
  bool operator==(const ControlGroupLimits&) const = default;
};

// What groups are there for, as indices; version 1 has a hierarchy for each.
inline constexpr std::size_t kGroupMemory = 0;
inline constexpr std::size_t kGroupProcesses = 1;
inline constexpr std::size_t kGroupTime = 2;
inline constexpr std::size_t kGroupControllers = 3;

// Where a group of this process may stand for a controller.
struct GroupPlace {
  // Folders: the one that this process is in, and the one above; none: the controller is not mounted.
  std::vector<std::string> parents;
  bool version_2 = false;
};
// By what /proc/self/mountinfo and /proc/self/cgroup say.
std::array<GroupPlace, kGroupControllers> GroupPlaces(std::string_view mount_info,
                                                      std::string_view membership);

// The group of this process and of whatever it starts, once it is limited: joining a group costs half a
// millisecond, being born in one nothing. What cannot be had (no right, no such controller) is not limited,
// which IsWhole says. Thread-safety: one thread.
class ControlGroup {
 public:
  ControlGroup() = default;
  ControlGroup(const ControlGroup&) = delete;
  ControlGroup& operator=(const ControlGroup&) = delete;
  // This process leaves the group, which is removed; nothing else may be in it any more.
  ~ControlGroup();

  // From now on; what is counted begins again. Files in memory that are there already do not count.
  void Limit(const ControlGroupLimits& wanted);

  // Whether memory, processes and time are all limited or counted. Memory is what is in RAM, each page once,
  // files in memory (tmpfs) included, and the little that this process itself needs from now on.
  bool IsWhole() const;
  // Whether the kernel has ended a process, or refused one, because the limit was met.
  bool OutOfMemory() const { return Count(kGroupMemory) > 0; }
  bool OutOfProcesses() const { return Count(kGroupProcesses) > 0; }
  // User and system time of all that was in the group, but for that of this process, s; nothing where it is
  // not counted.
  std::optional<double> CpuSeconds() const;

  // When memory is short, this process and what it starts are ended, not those of the group that started it.
  static void EndThisFirst();
  // Removes those whose makers ended without their destructors, and ends who is still in them: it is gone
  // when this is called again.
  static void RemoveAbandoned();

 private:
  struct Part {
    std::string folder;  // "": there is none
    std::uint64_t count_before = 0;
  };

  static std::string Enter(std::size_t controller, const ControlGroupLimits& limits);
  std::uint64_t Count(std::size_t controller) const;

  std::optional<ControlGroupLimits> limits_;  // nothing: this process has not entered any yet
  std::array<Part, kGroupControllers> parts_;
  double own_before_ = 0.0;  // s
};

}  // namespace gauntlet::worker
