#include "master/directory/campaign_directory.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/parse_number.h"
#include "base/shell_quoted.h"
#include "base/system/atomic_file.h"
#include "base/system/trusted_path.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 14> kOwnNames = {
    "access.json",   "campaign.db", "epoch",       "lock",   "experiment.toml",
    "log",           "status.json", "master.key",  "stop",   "slurm.toml",
    "searches.json", "origin.json", "snapshot.db", "plugins"};

// What else a master obeys of a campaign, or writes to.
constexpr std::array<std::string_view, 4> kBesideOwnNames = {"bundles", "campaign.db-wal",
                                                             "campaign.db-journal", "log/master.log"};

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
  if (error) return SystemError(fmt::format("cannot make the directory {}", path), error.value());
  for (auto place = missing.rbegin(); place != missing.rend(); ++place) {
    TRY(MakeDirectory(place->string()));
  }
  for (const fs::path& made : missing) (void)SyncDirectory(made.parent_path());
  return Ok{};
}

// A directory in which a master was killed before it had made the database: all there is, is ours.
bool IsUnfinished(const fs::path& dir) {
  std::error_code error;
  if (!fs::exists(dir / "lock", error)) return false;
  if (fs::exists(dir / "origin.json", error)) return false;  // made once the database is there
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error)) {
    if (!IsOwnName(entry->path().filename().string())) return false;
  }
  return !error;
}

constexpr std::size_t kLongestEpoch = 4096;
// The number begins those of the leases, in 32 bits.
constexpr std::uint64_t kLastEpoch = (1ULL << 32) - 1;

// At most `largest` can be right.
Result<std::uint64_t> ParseEpoch(const Result<std::string>& text, const std::string& path,
                                 std::uint64_t largest) {
  if (!text) return text.error();
  std::string_view digits = *text;
  while (!digits.empty() && digits.back() == '\n') digits.remove_suffix(1);
  const auto epoch = ParseNumber<std::uint64_t>(digits);
  if (epoch && *epoch > 0 && *epoch <= largest) return *epoch;
  return Error{
      ErrorKind::kCorrupt,
      fmt::format("{} holds '{}' where the number of the newest master's start should stand, 1 to {}. "
                  "It counts up by one: log/master*.log names the last ones",
                  path, digits.substr(0, 40), largest)};
}

}  // namespace

std::optional<FileVersion> VersionOf(const std::string& path) {
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0) return std::nullopt;
  return FileVersion{{info.st_dev, info.st_ino}, info.st_mtim.tv_sec, info.st_mtim.tv_nsec};
}

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
  TRY(directory.CheckTrusted());
  if (fs::exists(directory.database_path(), error)) {
    return InvalidInput(
        fmt::format("{} holds a campaign already; go on with it by `gauntlet resume {}`, or choose another "
                    "directory",
                    directory.path_, PastedPath(directory.path_)));
  }
  const bool empty = fs::is_empty(directory.path_, error);
  if (error) return SystemError(fmt::format("cannot read {}", directory.path_), error.value());
  if (!empty && !IsUnfinished(directory.path_)) {
    return InvalidInput(
        fmt::format("{} is not empty, and what it holds is no campaign that `gauntlet resume {}` could go on "
                    "with; choose a directory that is empty or does not exist",
                    directory.path_, PastedPath(directory.path_)));
  }
  return Ok{};
}

Result<CampaignDirectory> CampaignDirectory::Create(const std::string& dir) {
  TRY(CheckCreatable(dir));
  CampaignDirectory directory(WithoutSlash(dir));
  TRY(MakeDirectories(directory.path_));
  return directory;
}

bool CampaignDirectory::IsCampaign(const std::string& dir) {
  std::error_code ignored;
  return fs::exists(CampaignDirectory(dir).database_path(), ignored);
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
              "{} is no campaign yet: its master was killed, or its disk was full, before it had made "
              "campaign.db, and nothing was simulated. The same command with --dir {} starts anew there",
              directory.path_, PastedPath(directory.path_))};
    }
    if (fs::exists(directory.origin_path(), error)) {
      return Error{
          ErrorKind::kNotFound,
          fmt::format("{} was a campaign, but its campaign.db is gone, deleted or moved away, and the "
                      "runs with it; put it back, or choose another directory",
                      directory.path_)};
    }
    return Error{ErrorKind::kNotFound,
                 fmt::format("{} is not a campaign: it holds no campaign.db", directory.path_)};
  }
  return directory;
}

std::optional<std::string> CampaignDirectory::Owning(const std::string& path) {
  fs::path below = fs::path(path);
  for (fs::path dir = below.parent_path(); below.has_relative_path(); dir = below.parent_path()) {
    const std::string name = below.filename();
    const bool ours = IsOwnName(name) || name.starts_with("campaign.db-") || name == "bundles";
    if (ours && IsCampaign(dir)) return dir;
    below = dir;
  }
  return std::nullopt;
}

Status CampaignDirectory::CheckTrusted() const {
  TRY(CheckOnlyWeWrite(path_, kOwnNames));
  return CheckOnlyWeWrite(path_, kBesideOwnNames);
}

Result<std::uint64_t> CampaignDirectory::StartEpoch() {
  const Result<std::uint64_t> newest =
      ParseEpoch(ReadRegularFile(epoch_path(), kLongestEpoch), epoch_path(), kLastEpoch - 1);
  if (!newest && newest.error().kind != ErrorKind::kNotFound) return newest.error();
  const std::uint64_t epoch = newest ? *newest + 1 : 1;
  TRY(WriteFileAtomically(epoch_path(), fmt::format("{}\n", epoch), kReadableByAll));
  epoch_file_ = VersionOf(epoch_path());
  return epoch;
}

Status CampaignDirectory::RestoreEpoch(std::uint64_t mine) const {
  return WriteFileAtomically(epoch_path(), fmt::format("{}\n", mine), kReadableByAll);
}

Status CampaignDirectory::CheckEpoch(std::uint64_t mine) const {
  const Result<std::string> text = ReadRegularFile(epoch_path(), kLongestEpoch);
  // Strangers have used up the descriptors (with connections): looking at the file needs none. A newer
  // master would have put another one in its place.
  if (!text && text.error().kind == ErrorKind::kNoSpace && epoch_file_ &&
      VersionOf(epoch_path()) == epoch_file_)
    return Ok{};
  TRY(const std::uint64_t newest, ParseEpoch(text, epoch_path(), kLastEpoch));
  if (newest == mine) return Ok{};
  return Error{
      ErrorKind::kInUse,
      fmt::format(
          "campaign {} was taken over by a newer master (start number {}; this one is number {}); this one "
          "stops",
          path_, newest, mine)};
}

std::string NewCampaignId() {
  std::random_device device;  // the operating system's random numbers
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

}  // namespace gauntlet
