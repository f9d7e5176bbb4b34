#include "master/directory/campaign_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/parse_number.h"
#include "base/system/atomic_file.h"
#include "base/system/unique_fd.h"

namespace gauntlet::master {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 13> kOwnNames = {
    "access.json",   "campaign.db", "epoch",      "lock", "experiment.toml",
    "log",           "status.json", "master.key", "stop", "slurm.toml",
    "searches.json", "origin.json", "snapshot.db"};

std::string WithoutSlash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

// Ours, or a draft of it ("campaign.db.new", "epoch.a8f3Gz").
bool IsOwnName(const std::string& name) {
  return std::ranges::any_of(kOwnNames, [&name](std::string_view own) {
    return name == own || (name.starts_with(own) && name[own.size()] == '.');
  });
}

// With those above it that are missing. A loss of power leaves them, unless their place cannot be
// synchronised: one may be allowed to write into a directory and not to open it.
Status MakeDirectories(const std::string& path) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path there = fs::absolute(path, error); !error && !fs::exists(there, error);
       there = there.parent_path()) {
    missing.push_back(there);
  }
  fs::create_directories(path, error);
  if (error) return SystemError(fmt::format("cannot make the directory {}", path), error.value());
  for (const fs::path& made : missing) (void)SyncDirectory(made.parent_path());
  return Ok{};
}

// A directory in which a master was killed before it had made the database: all there is, is ours.
bool IsUnfinished(const fs::path& dir) {
  std::error_code error;
  if (!fs::exists(dir / "lock", error)) return false;
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error)) {
    if (!IsOwnName(entry->path().filename().string())) return false;
  }
  return !error;
}

constexpr std::size_t kLongestEpoch = 4096;

Result<std::uint64_t> ParseEpoch(const Result<std::string>& text, const std::string& path) {
  if (!text) return text.error();
  std::string_view digits = *text;
  while (!digits.empty() && digits.back() == '\n') digits.remove_suffix(1);
  if (const auto epoch = ParseNumber<std::uint64_t>(digits); epoch && *epoch > 0) return *epoch;
  return Error{ErrorKind::kCorrupt,
               fmt::format("{} holds '{}' where the number of the newest master's start should stand", path,
                           digits.substr(0, 40))};
}

std::optional<FileIdentity> IdentifyFile(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return std::nullopt;
  return FileIdentity{info.st_dev, info.st_ino, info.st_mtim.tv_sec, info.st_mtim.tv_nsec};
}

}  // namespace

Status CampaignDirectory::CheckCreatable(const std::string& dir) {
  const CampaignDirectory directory(WithoutSlash(dir));
  std::error_code error;
  if (!fs::exists(directory.path_, error)) {
    if (!fs::is_symlink(fs::symlink_status(directory.path_, error))) return Ok{};
    return InvalidInput(
        fmt::format("{} is a link that leads nowhere; a campaign needs a directory", directory.path_));
  }
  if (!fs::is_directory(directory.path_, error)) {
    return InvalidInput(fmt::format("{} is a file; a campaign needs a directory", directory.path_));
  }
  if (fs::exists(directory.database_path(), error)) {
    return InvalidInput(
        fmt::format("{0} holds a campaign already; go on with it by `gauntlet resume {0}`, or choose another "
                    "directory",
                    directory.path_));
  }
  const bool empty = fs::is_empty(directory.path_, error);
  if (error) return SystemError(fmt::format("cannot read {}", directory.path_), error.value());
  if (!empty && !IsUnfinished(directory.path_)) {
    return InvalidInput(fmt::format(
        "{0} is not empty, and what it holds is no campaign that `gauntlet resume {0}` could go on "
        "with; choose a directory that is empty or does not exist",
        directory.path_));
  }
  return Ok{};
}

Result<CampaignDirectory> CampaignDirectory::Create(const std::string& dir) {
  if (Status creatable = CheckCreatable(dir); !creatable) return creatable.error();
  CampaignDirectory directory(WithoutSlash(dir));
  if (Status made = MakeDirectories(directory.path_); !made) return made.error();
  return directory;
}

Result<CampaignDirectory> CampaignDirectory::Open(const std::string& dir) {
  CampaignDirectory directory(WithoutSlash(dir));
  std::error_code error;
  if (!fs::is_directory(directory.path_, error)) {
    return Error{ErrorKind::kNotFound,
                 fs::exists(directory.path_, error)
                     ? fmt::format("{} is a file; a campaign is a directory", directory.path_)
                     : fmt::format("there is no directory {}", directory.path_)};
  }
  if (!fs::exists(directory.database_path(), error)) {
    if (IsUnfinished(directory.path_)) {
      return Error{
          ErrorKind::kNotFound,
          fmt::format(
              "{0} is no campaign yet: its master was killed, or its disk was full, before it had made "
              "campaign.db, and nothing was simulated. The same command with --dir {0} starts anew there",
              directory.path_)};
    }
    return Error{ErrorKind::kNotFound,
                 fmt::format("{} is not a campaign: it holds no campaign.db", directory.path_)};
  }
  return directory;
}

Result<std::uint64_t> CampaignDirectory::StartEpoch() {
  const Result<std::uint64_t> newest = ParseEpoch(ReadSmallFile(epoch_path()), epoch_path());
  if (!newest && newest.error().kind != ErrorKind::kNotFound) return newest.error();
  const std::uint64_t epoch = newest ? *newest + 1 : 1;
  const Status written = WriteFileAtomically(epoch_path(), fmt::format("{}\n", epoch), kReadableByAll);
  if (!written) return written.error();
  epoch_file_ = IdentifyFile(epoch_path());
  return epoch;
}

Status CampaignDirectory::CheckEpoch(std::uint64_t mine) const {
  const int fd = open(epoch_path().c_str(), O_RDONLY | O_CLOEXEC);
  const int error = errno;
  if (fd < 0 && (error == EMFILE || error == ENFILE) && epoch_file_) {
    // Strangers have used up the descriptors (with connections): looking at the file needs none. A newer
    // master would have put another one in its place.
    if (IdentifyFile(epoch_path()) == epoch_file_) return Ok{};
  }
  // Of a directory that is gone, workers that start may make the folder of logs again.
  if (std::error_code ignored; fd < 0 && error == ENOENT && !fs::exists(database_path(), ignored)) {
    return Error{ErrorKind::kIo, fmt::format("the directory {} is gone: removed, or moved to a place that "
                                             "this master does not know",
                                             path_)};
  }
  if (fd < 0) return SystemError(fmt::format("cannot open {}", epoch_path()), error);
  const Result<std::uint64_t> newest =
      ParseEpoch(ReadAll(UniqueFd(fd).get(), epoch_path(), kLongestEpoch), epoch_path());
  if (!newest) return newest.error();
  if (*newest == mine) return Ok{};
  return Error{
      ErrorKind::kInUse,
      fmt::format(
          "campaign {} was taken over by a newer master (start number {}; this one is number {}); this one "
          "stops",
          path_, *newest, mine)};
}

std::string NewCampaignId() {
  std::random_device device;  // the operating system's random numbers
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

}  // namespace gauntlet::master
