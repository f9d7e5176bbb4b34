#include "tests/master/store/fault_vfs.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstring>

#include "base/check.h"

namespace gauntlet {

// What SQLite allocates per open file: ours, then the real VFS's.
struct FaultFile {
  sqlite3_file base;
  FaultVfs* shim;
  std::string* name;
  sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

struct FaultVfsAccess {
  using Operation = FaultVfs::Operation;

  static FaultFile& Of(sqlite3_file* file) { return *reinterpret_cast<FaultFile*>(file); }
  static sqlite3_vfs* Real() { return sqlite3_vfs_find(nullptr); }

  static int Close(sqlite3_file* file) {
    FaultFile& fault = Of(file);
    delete fault.name;
    return fault.real()->pMethods->xClose(fault.real());
  }
  static int Read(sqlite3_file* file, void* to, int size, sqlite3_int64 offset) {
    return Of(file).real()->pMethods->xRead(Of(file).real(), to, size, offset);
  }
  static int Write(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset) {
    FaultFile& fault = Of(file);
    FaultVfs& shim = *fault.shim;
    const std::lock_guard lock(shim.mutex_);
    ++shim.writes_;
    Fault what = Fault::kNone;
    if (shim.fault_ != Fault::kNone) {
      if (shim.writes_until_fault_ == 0) what = shim.fault_;
      if (shim.writes_until_fault_ > 0) {
        --shim.writes_until_fault_;
      } else if (!shim.lasting_) {
        shim.fault_ = Fault::kNone;
      }
    }
    if (what == Fault::kDiskFull) return SQLITE_FULL;
    if (what == Fault::kIoError) return SQLITE_IOERR_WRITE;
    const int written = what == Fault::kTornWrite ? size / 2 : size;
    shim.operations_.push_back(
        {Operation::kWrite, *fault.name, offset,
         std::string(static_cast<const char*>(from), static_cast<std::size_t>(written))});
    const int code = fault.real()->pMethods->xWrite(fault.real(), from, written, offset);
    return what == Fault::kTornWrite ? SQLITE_IOERR_WRITE : code;
  }
  static int Truncate(sqlite3_file* file, sqlite3_int64 size) {
    FaultFile& fault = Of(file);
    const std::lock_guard lock(fault.shim->mutex_);
    fault.shim->operations_.push_back({Operation::kTruncate, *fault.name, size, {}});
    return fault.real()->pMethods->xTruncate(fault.real(), size);
  }
  static int Sync(sqlite3_file* file, int /*flags*/) {
    FaultFile& fault = Of(file);
    FaultVfs& shim = *fault.shim;
    const std::lock_guard lock(shim.mutex_);
    if (shim.syncs_until_fault_ == 0) return SQLITE_IOERR_FSYNC;
    if (shim.syncs_until_fault_ > 0) --shim.syncs_until_fault_;
    ++shim.syncs_[*fault.name];
    shim.operations_.push_back({Operation::kSync, *fault.name, 0, {}});
    return SQLITE_OK;
  }
  static int FileSize(sqlite3_file* file, sqlite3_int64* size) {
    return Of(file).real()->pMethods->xFileSize(Of(file).real(), size);
  }
  static int Lock(sqlite3_file* file, int level) {
    return Of(file).real()->pMethods->xLock(Of(file).real(), level);
  }
  static int Unlock(sqlite3_file* file, int level) {
    return Of(file).real()->pMethods->xUnlock(Of(file).real(), level);
  }
  static int CheckReservedLock(sqlite3_file* file, int* answer) {
    return Of(file).real()->pMethods->xCheckReservedLock(Of(file).real(), answer);
  }
  static int FileControl(sqlite3_file* file, int operation, void* argument) {
    return Of(file).real()->pMethods->xFileControl(Of(file).real(), operation, argument);
  }
  static int SectorSize(sqlite3_file* file) {
    return Of(file).real()->pMethods->xSectorSize(Of(file).real());
  }
  static int DeviceCharacteristics(sqlite3_file* file) {
    return Of(file).real()->pMethods->xDeviceCharacteristics(Of(file).real());
  }

  static int Open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* out_flags) {
    // Version 1: no shared memory and no memory mapping to be had, as on a network file system.
    static const sqlite3_io_methods methods = {1,
                                               Close,
                                               Read,
                                               Write,
                                               Truncate,
                                               Sync,
                                               FileSize,
                                               Lock,
                                               Unlock,
                                               CheckReservedLock,
                                               FileControl,
                                               SectorSize,
                                               DeviceCharacteristics,
                                               nullptr,
                                               nullptr,
                                               nullptr,
                                               nullptr,
                                               nullptr,
                                               nullptr};
    FaultFile& fault = Of(file);
    fault.base.pMethods = nullptr;
    const int code = Real()->xOpen(Real(), path, fault.real(), flags, out_flags);
    if (code != SQLITE_OK) return code;
    const char* slash = path == nullptr ? nullptr : std::strrchr(path, '/');
    fault.shim = static_cast<FaultVfs*>(vfs->pAppData);
    fault.name = new std::string(slash == nullptr ? "temporary" : slash + 1);
    fault.base.pMethods = &methods;
    return SQLITE_OK;
  }
};

FaultVfs::FaultVfs() : vfs_(std::make_unique<sqlite3_vfs>(*FaultVfsAccess::Real())) {
  static int number = 0;
  name_ = fmt::format("fault-{}", ++number);
  vfs_->szOsFile = static_cast<int>(sizeof(FaultFile)) + FaultVfsAccess::Real()->szOsFile;
  vfs_->zName = name_.c_str();
  vfs_->pAppData = this;
  vfs_->xOpen = FaultVfsAccess::Open;
  vfs_->pNext = nullptr;
  // Everything but opening goes to the real one, which looks for its own data behind pAppData.
  vfs_->xDelete = [](sqlite3_vfs*, const char* path, int sync) {
    return FaultVfsAccess::Real()->xDelete(FaultVfsAccess::Real(), path, sync);
  };
  vfs_->xAccess = [](sqlite3_vfs*, const char* path, int flags, int* answer) {
    return FaultVfsAccess::Real()->xAccess(FaultVfsAccess::Real(), path, flags, answer);
  };
  vfs_->xFullPathname = [](sqlite3_vfs*, const char* path, int size, char* out) {
    return FaultVfsAccess::Real()->xFullPathname(FaultVfsAccess::Real(), path, size, out);
  };
  const int code = sqlite3_vfs_register(vfs_.get(), 0);
  GAUNTLET_CHECK(code == SQLITE_OK, "the VFS cannot be registered");
}

FaultVfs::~FaultVfs() {
  sqlite3_vfs_unregister(vfs_.get());
}

void FaultVfs::FailWrites(Fault fault, std::int64_t first, bool lasting) {
  const std::lock_guard lock(mutex_);
  fault_ = fault;
  writes_until_fault_ = first;
  lasting_ = lasting;
}

void FaultVfs::FailSyncs(std::int64_t first) {
  const std::lock_guard lock(mutex_);
  syncs_until_fault_ = first;
}

std::int64_t FaultVfs::writes() const {
  const std::lock_guard lock(mutex_);
  return writes_;
}

std::int64_t FaultVfs::syncs(const std::string& file) const {
  const std::lock_guard lock(mutex_);
  const auto found = syncs_.find(file);
  return found == syncs_.end() ? 0 : found->second;
}

std::size_t FaultVfs::position() const {
  const std::lock_guard lock(mutex_);
  return operations_.size();
}

std::vector<FaultVfs::Operation> FaultVfs::operations() const {
  const std::lock_guard lock(mutex_);
  return operations_;
}

std::string AfterPowerLoss(const std::vector<FaultVfs::Operation>& operations, std::size_t cut,
                           const std::string& file, std::string content,
                           const std::function<bool()>& survives) {
  constexpr std::size_t kSector = 512;
  std::size_t synchronised = 0;
  for (std::size_t i = 0; i < cut; ++i) {
    if (operations[i].kind == FaultVfs::Operation::kSync && operations[i].file == file) synchronised = i;
  }
  for (std::size_t i = 0; i < cut; ++i) {
    const FaultVfs::Operation& operation = operations[i];
    if (operation.file != file || operation.kind == FaultVfs::Operation::kSync) continue;
    const bool certain = i < synchronised;
    const auto offset = static_cast<std::size_t>(operation.offset);
    if (operation.kind == FaultVfs::Operation::kTruncate) {
      if (certain || survives()) content.resize(offset);
      continue;
    }
    for (std::size_t begin = 0; begin < operation.bytes.size();) {
      const std::size_t size = std::min(kSector - (offset + begin) % kSector, operation.bytes.size() - begin);
      if (certain || survives()) {
        content.resize(std::max(content.size(), offset + begin + size));
        content.replace(offset + begin, size, operation.bytes, begin, size);
      }
      begin += size;
    }
  }
  return content;
}

}  // namespace gauntlet
