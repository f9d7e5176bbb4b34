#include "worker/plugin_files.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "base/system/atomic_file.h"
#include "base/system/sha256.h"
#include "proto/plugin_description.h"

namespace gauntlet::worker {
namespace {

Status WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return SystemError("cannot copy a plug-in into memory", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return Ok{};
}

}  // namespace

Result<PluginFile> PluginFiles::Open(const std::string& hash) {
  const auto [copy, is_new] = copies_.try_emplace(hash);
  if (is_new) {
    const std::string path =
        settings_.file.empty() ? fmt::format("{}/{}.so", settings_.folder, hash) : settings_.file;
    const auto give_up = [&](Error error) {
      copies_.erase(copy);
      return error;
    };
    if (settings_.file.empty() && settings_.folder.empty())
      return give_up(
          InvalidInput(fmt::format("the run needs the plug-in {}: give its file by --plugin", hash)));
    const Result<std::string> bytes = ReadSmallFile(path, proto::kMaxPluginBytes);
    if (!bytes) return give_up(bytes.error());
    if (const std::string found = Sha256(*bytes); found != hash) {
      return give_up(InvalidInput(fmt::format(
          "{} is not the plug-in that the run was made for: its SHA-256 is {}, not {}", path, found, hash)));
    }
    UniqueFd memory(memfd_create("plug-in", MFD_CLOEXEC));
    if (!memory.valid()) return give_up(SystemError("cannot make a file in memory", errno));
    if (const Status written = WriteAll(memory.get(), *bytes); !written) return give_up(written.error());
    copy->second = {path, std::move(memory)};
  }
  return PluginFile{.path = fmt::format("/proc/self/fd/{}", copy->second.memory.get()),
                    .name = copy->second.name,
                    .hash = hash};
}

}  // namespace gauntlet::worker
