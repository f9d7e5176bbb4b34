// A SQLite VFS over the real one that counts what is written and synchronised, fails on demand, and remembers
// every write, so that a test can rebuild what a loss of power would have left. Thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

struct sqlite3_vfs;

namespace gauntlet {

enum class Fault {
  kNone,
  kDiskFull,   // the write changes nothing: SQLITE_FULL
  kIoError,    // the write changes nothing: SQLITE_IOERR_WRITE
  kTornWrite,  // its first half is written: SQLITE_IOERR_WRITE
};

class FaultVfs {
 public:
  struct Operation {
    enum Kind { kWrite, kTruncate, kSync } kind = kWrite;
    std::string file;  // "campaign.db", "campaign.db-wal"
    std::int64_t offset = 0;
    std::string bytes;
  };

  // Registered as name() as long as it lives.
  FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;
  ~FaultVfs();

  const std::string& name() const { return name_; }

  // Write number `first` (0 = the next one) and, with `lasting`, all later ones fail.
  void FailWrites(Fault fault, std::int64_t first, bool lasting);
  // Sync number `first` and all later ones fail with SQLITE_IOERR_FSYNC.
  void FailSyncs(std::int64_t first);

  std::int64_t writes() const;
  std::int64_t syncs(const std::string& file) const;
  // How many operations there have been so far.
  std::size_t position() const;
  std::vector<Operation> operations() const;

 private:
  friend struct FaultVfsAccess;

  std::string name_;
  std::unique_ptr<sqlite3_vfs> vfs_;
  mutable std::mutex mutex_;
  Fault fault_ = Fault::kNone;
  std::int64_t writes_until_fault_ = 0;
  bool lasting_ = false;
  std::int64_t syncs_until_fault_ = -1;
  std::int64_t writes_ = 0;
  std::map<std::string, std::int64_t> syncs_;
  std::vector<Operation> operations_;
};

// The content of `file` after the first `cut` operations and a loss of power: what was synchronised is there;
// of the later sectors (512 bytes), each one for which `survives()` answers true. `content` is what the file
// held before.
std::string AfterPowerLoss(const std::vector<FaultVfs::Operation>& operations, std::size_t cut,
                           const std::string& file, std::string content,
                           const std::function<bool()>& survives);

}  // namespace gauntlet
