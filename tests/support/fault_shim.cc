// A library for LD_PRELOAD that lets a program meet what a test machine does not offer. For tests only.
//   GAUNTLET_FAULT_LOSE_UNSYNCED=DIR  files in DIR reach the disk when they are synchronised and not before:
//       until then what is written is kept in memory, so a kill loses it as a loss of power would. Without
//       effect on DIR/log, DIR/lock, DIR/status.json and DIR/*-shm, which nobody relies on after a loss of
//       power.
//   GAUNTLET_FAULT_CLOCK_OFFSET=S     the wall clock is S seconds ahead
//   GAUNTLET_FAULT_CLOCK_JUMPS=S      the wall clock jumps by up to S seconds, to and fro, at every look at
//   it GAUNTLET_FAULT_LOCAL_LOCKS=1      locks on files always succeed, as on a file system that other hosts
//       have mounted too and that keeps locks to each host
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace {

template <typename Function>
Function Real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::string_view Setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

// ---- Files that lose what was not synchronised: the program's descriptor is a file in memory.

struct Tracked {
  int disk = -1;
  struct stat identity {};  // as the program would see it
};
std::mutex tracked_mutex;
std::map<int, Tracked>& TrackedFiles() {
  static auto* files = new std::map<int, Tracked>;  // outlives every destructor that closes a file
  return *files;
}

bool Loses(std::string_view path) {
  static const std::string directory(Setting("GAUNTLET_FAULT_LOSE_UNSYNCED"));
  if (directory.empty() || !path.starts_with(directory + "/")) return false;
  const std::string_view name = path.substr(directory.size() + 1);
  // SQLite's shared memory is no content: it is made anew after a loss of power.
  return !name.starts_with("log/") && name != "lock" && !name.starts_with("status.json") &&
         !name.ends_with("-shm");
}

// Takes the place of `fd`, which stays open under another number.
int Track(int fd) {
  struct stat identity {};
  if (fd < 0 || syscall(SYS_fstat, fd, &identity) != 0 || !S_ISREG(identity.st_mode)) return fd;
  const int memory = memfd_create("unsynced", MFD_CLOEXEC);
  const int disk = static_cast<int>(syscall(SYS_fcntl, fd, F_DUPFD_CLOEXEC, 500));
  if (memory < 0 || disk < 0) std::abort();
  std::vector<char> buffer(1U << 16);
  off_t offset = 0;
  for (ssize_t size = 0; (size = syscall(SYS_pread64, disk, buffer.data(), buffer.size(), offset)) > 0;
       offset += size) {
    if (syscall(SYS_pwrite64, memory, buffer.data(), size, offset) != size) std::abort();
  }
  syscall(SYS_dup3, memory, fd, O_CLOEXEC);
  syscall(SYS_close, memory);
  const std::lock_guard lock(tracked_mutex);
  TrackedFiles()[fd] = {disk, identity};
  return fd;
}

// Back to front and in pieces, so that a kill in the middle of it leaves later bytes without earlier ones.
int WriteBack(int fd, int disk) {
  constexpr off_t kPiece = 4096;
  struct stat now {};
  if (syscall(SYS_fstat, fd, &now) != 0) return -1;
  char piece[kPiece];
  char there[kPiece];
  if (ftruncate(disk, now.st_size) != 0) return -1;
  for (off_t offset = (now.st_size - 1) / kPiece * kPiece; offset >= 0 && now.st_size > 0; offset -= kPiece) {
    const ssize_t size = syscall(SYS_pread64, fd, piece, kPiece, offset);
    if (size <= 0) return -1;
    const auto bytes = static_cast<std::size_t>(size);
    if (syscall(SYS_pread64, disk, there, bytes, offset) == size &&
        std::string_view(piece, bytes) == std::string_view(there, bytes))
      continue;
    if (syscall(SYS_pwrite64, disk, piece, bytes, offset) != size) return -1;
  }
  return 0;
}

int DiskOf(int fd) {
  const std::lock_guard lock(tracked_mutex);
  const auto found = TrackedFiles().find(fd);
  return found == TrackedFiles().end() ? -1 : found->second.disk;
}

int Synchronise(int fd, const char* name) {
  const int disk = DiskOf(fd);
  if (disk < 0) return Real<int (*)(int)>(name)(fd);
  return WriteBack(fd, disk);
}

int OpenAs(const char* name, const char* path, int flags, mode_t mode) {
  const int fd = Real<int (*)(const char*, int, ...)>(name)(path, flags, mode);
  return (flags & O_ACCMODE) != O_RDONLY && Loses(path) ? Track(fd) : fd;
}

// ---- The wall clock.

std::int64_t ClockError() {
  static const std::int64_t offset = std::atoll(std::string(Setting("GAUNTLET_FAULT_CLOCK_OFFSET")).c_str());
  static const std::int64_t jumps = std::atoll(std::string(Setting("GAUNTLET_FAULT_CLOCK_JUMPS")).c_str());
  static std::atomic<std::uint64_t> looks{0};
  if (jumps == 0) return offset;
  // Multiplicative hashing spreads consecutive numbers over the range (Knuth, TAOCP 3, 6.4).
  const std::uint64_t spread = (looks.fetch_add(1) + 1) * 0x9E3779B97F4A7C15ULL;
  return offset + static_cast<std::int64_t>((spread >> 32) % static_cast<std::uint64_t>(2 * jumps + 1)) -
         jumps;
}

bool LocksAreLocal() {
  static const bool local = Setting("GAUNTLET_FAULT_LOCAL_LOCKS") == "1";
  return local;
}

int FcntlAs(const char* name, int fd, int command, void* argument) {
  if (LocksAreLocal() && (command == F_SETLK || command == F_SETLKW)) return 0;
  if (LocksAreLocal() && command == F_GETLK) {
    static_cast<struct flock*>(argument)->l_type = F_UNLCK;
    return 0;
  }
  return Real<int (*)(int, int, ...)>(name)(fd, command, argument);
}

}  // namespace

// The C library's functions, with its names and types.
extern "C" {

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
  va_end(list);
  return OpenAs("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
  va_end(list);
  return OpenAs("open64", path, flags, mode);
}
int mkostemp(char* path, int flags) {
  const int fd = Real<int (*)(char*, int)>("mkostemp")(path, flags);
  return Loses(path) ? Track(fd) : fd;
}
int fsync(int fd) {
  return Synchronise(fd, "fsync");
}
int fdatasync(int fd) {
  return Synchronise(fd, "fdatasync");
}
int fchmod(int fd, mode_t mode) noexcept {
  const int disk = DiskOf(fd);
  return Real<int (*)(int, mode_t)>("fchmod")(disk < 0 ? fd : disk, mode);
}
int close(int fd) {
  {
    const std::lock_guard lock(tracked_mutex);
    const auto found = TrackedFiles().find(fd);
    if (found != TrackedFiles().end()) {
      syscall(SYS_close, found->second.disk);
      TrackedFiles().erase(found);
    }
  }
  return Real<int (*)(int)>("close")(fd);
}
// SQLite asks whether the path still names the file that it has open.
int fstat64(int fd, struct stat64* info) noexcept {
  const int result = Real<int (*)(int, struct stat64*)>("fstat64")(fd, info);
  const std::lock_guard lock(tracked_mutex);
  const auto found = TrackedFiles().find(fd);
  if (result == 0 && found != TrackedFiles().end()) {
    info->st_dev = found->second.identity.st_dev;
    info->st_ino = found->second.identity.st_ino;
    info->st_nlink = found->second.identity.st_nlink;
  }
  return result;
}

int flock(int fd, int operation) noexcept {
  return LocksAreLocal() ? 0 : Real<int (*)(int, int)>("flock")(fd, operation);
}
int fcntl(int fd, int command, ...) {
  va_list list;
  va_start(list, command);
  void* argument = va_arg(list, void*);
  va_end(list);
  return FcntlAs("fcntl", fd, command, argument);
}
int fcntl64(int fd, int command, ...) {
  va_list list;
  va_start(list, command);
  void* argument = va_arg(list, void*);
  va_end(list);
  return FcntlAs("fcntl64", fd, command, argument);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = Real<int (*)(clockid_t, timespec*)>("clock_gettime")(clock, time);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    time->tv_sec += ClockError();
  return result;
}
int gettimeofday(timeval* time, void* zone) noexcept {
  const int result = Real<int (*)(timeval*, void*)>("gettimeofday")(time, zone);
  if (result == 0) time->tv_sec += ClockError();
  return result;
}
time_t time(time_t* where) noexcept {
  const time_t now = Real<time_t (*)(time_t*)>("time")(nullptr) + ClockError();
  if (where != nullptr) *where = now;
  return now;
}

}  // extern "C"
