// Keeps a process that may do anything, and all that it starts, among themselves. The kernel asks the process
// that guards them for each new process or thread, and for each call that names another process: to signal,
// trace, read, write, limit or schedule it. They ask for nobody but each other.
//
//   guard --starts--> root of a tree, which confines itself --starts--> runs, and what they start
//     ^------------ requests, by a listener that the root hands over ----------'
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <set>

#include "base/system/unique_fd.h"

namespace gauntlet::worker {

// How many processes and threads a tree may have at the same time. The next one is refused (EAGAIN).
inline constexpr int kMostTasksOfTree = 256;

// Whether new processes and threads are asked for. A signal that comes meanwhile lets the call fail (EINTR),
// which a program of our own making tries again and a shell does not.
enum class Starting { kAsked, kFree };

// Called by the root. From now on it and all below it can gain no rights (PR_SET_NO_NEW_PRIVS), have none of
// a super-user but those over files and low ports, and ask as above. The listener; invalid where the kernel
// has no such filter (seccomp with SECCOMP_RET_USER_NOTIF, Linux 5.5) or grants none: then they are not kept
// from other processes of their user.
UniqueFd ConfineToTree(Starting starting = Starting::kAsked);

// Closes every file of this process but its standard streams and those.
void CloseAllBut(const std::set<int>& kept);

// This process' memory and files are not to be looked into by others of its user, nor by its descendants
// until they say otherwise.
void HideFromOthers();
void ShowToOthers();

// The guard's part. One thread.
class TreeGuard {
 public:
  TreeGuard(UniqueFd listener, pid_t root);
  ~TreeGuard();
  // Answers what the tree asks until `fd` can be read. Once all below the root have had `cpu_limit` of CPU
  // time together, s, they are killed; 0: no limit. True: they were.
  bool ServeUntilReadable(int fd, double cpu_limit);
  // For whoever polls himself: for POLLIN of what, and what to do when poll has found these events.
  int fd() const { return listener_.get(); }
  void Serve(short found);

 private:
  struct Messages;

  void Answer();
  bool Allows() const;
  bool HasRoom();
  // Kills the tree below its root when it has had too much.
  bool EndIfOver(double cpu_limit) const;

  UniqueFd listener_;
  pid_t root_;
  std::unique_ptr<Messages> messages_;
  std::chrono::steady_clock::time_point full_until_{};  // when it is counted again
  int tasks_ = 1;  // at most so many are there: when last counted, and what was allowed since
};

}  // namespace gauntlet::worker
