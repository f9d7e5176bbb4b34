#include "worker/command/command_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/sha256.h"
#include "base/system/trusted_path.h"
#include "base/system/unique_fd.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
namespace command = controllers::command;

constexpr const char* kEnding = ".command";
constexpr const char* kFilesFolder = "files";
constexpr mode_t kExecutable = 0755;
constexpr mode_t kNotExecutable = 0644;

Error Differs(const std::string& path, const std::string& found, const std::string& hash) {
  return InvalidInput(
      fmt::format("{} is not what the run was made for: its SHA-256 is {}, not {}", path, found, hash));
}

// Error: it cannot be read, others may write it, or its hash is another one.
Result<std::string> ReadTrusted(const fs::path& path, const std::string& hash) {
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::string name = path.filename();
  const std::array<std::string_view, 2> ours{name, kFilesFolder};
  TRY(CheckOnlyWeWrite(folder, ours));
  TRY(std::string text, ReadRegularFile(path));
  if (const std::string found = Sha256(text); found != hash) return Differs(path, found, hash);
  return text;
}

Result<std::string> HashOf(int file, std::size_t size, const std::string& path) {
  if (size == 0) return Sha256("");
  void* const bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  if (bytes == MAP_FAILED) return SystemError(fmt::format("cannot read {}", path), errno);
  std::string hash = Sha256({static_cast<const char*>(bytes), size});
  munmap(bytes, size);
  return hash;
}

// Shares the bytes where the file system can.
Status Copy(int from, int to, const std::string& target) {
  bool shares = true;
  while (true) {
    const ssize_t copied = shares ? copy_file_range(from, nullptr, to, nullptr, command::kMostFileBytes, 0)
                                  : sendfile(to, from, nullptr, command::kMostFileBytes);
    if (copied == 0) return Ok{};
    if (copied > 0 || errno == EINTR) continue;
    if (!std::exchange(shares, false)) return SystemError(fmt::format("cannot write {}", target), errno);
  }
}

Status LayCopy(int from, const fs::path& target, bool executable) {
  std::error_code failed;
  fs::create_directories(target.parent_path(), failed);
  if (failed)
    return SystemError(fmt::format("cannot make {}", target.parent_path().string()), failed.value());
  const UniqueFd to(open(target.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerOnly));
  if (!to.valid() || fchmod(to.get(), executable ? kExecutable : kNotExecutable) != 0)
    return SystemError(fmt::format("cannot write {}", target.string()), errno);
  return Copy(from, to.get(), target);
}

}  // namespace

Result<const command::Definition*> CommandFiles::Open(const std::string& hash) {
  const auto known = opened_.find(hash);
  if (known != opened_.end()) return &known->second.definition;
  std::vector<fs::path> paths(settings_.files.begin(), settings_.files.end());
  std::erase_if(paths, [](const fs::path& path) { return path.extension() != kEnding; });
  if (paths.empty() && settings_.files.empty() && !settings_.folder.empty())
    paths.push_back(fs::path(settings_.folder) / (hash + kEnding));
  Result<std::string> text =
      InvalidInput(fmt::format("the run needs the command {}: give its file by --plugin", hash));
  for (const fs::path& path : paths) {
    text = ReadTrusted(path, hash);
    if (!text) continue;
    Result<command::Definition> definition = command::Parse(*text);
    if (!definition) return InvalidInput(fmt::format("{}: {}", path.string(), definition.error().message));
    const fs::path folder = path.parent_path() / kFilesFolder;
    return &opened_.emplace(hash, Opened{std::move(*definition), folder}).first->second.definition;
  }
  return text.error();
}

Status CommandFiles::Verify(int file, const std::string& path, const std::string& hash) {
  struct stat status {};
  if (fstat(file, &status) != 0) return SystemError(fmt::format("cannot look at {}", path), errno);
  const Version version{
      .device = status.st_dev,
      .inode = status.st_ino,
      .size = status.st_size,
      .changed = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec};
  const auto known = verified_.find(path);
  if (known != verified_.end() && known->second == version) return Ok{};
  verified_.erase(path);
  const std::array<std::string_view, 1> ours{hash};
  TRY(CheckOnlyWeWrite(fs::path(path).parent_path(), ours));
  TRY(const std::string found, HashOf(file, static_cast<std::size_t>(status.st_size), path));
  if (found != hash) return Differs(path, found, hash);
  verified_[path] = version;
  return Ok{};
}

Status CommandFiles::LayInto(const std::string& folder, const std::string& hash) {
  const Opened& opened = opened_.at(hash);
  for (const command::File& file : opened.definition.files) {
    const std::string path = opened.folder + "/" + file.hash;
    TRY(const UniqueFd from, OpenRegularFile(path, O_RDONLY | O_CLOEXEC));
    TRY(Verify(from.get(), path, file.hash));
    TRY(LayCopy(from.get(), fs::path(folder) / file.name, file.executable));
  }
  return Ok{};
}

}  // namespace gauntlet::worker
