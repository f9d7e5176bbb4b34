#include "worker/plugin/plugin_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <set>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/sha256.h"
#include "controllers/rows/plugin_rows.h"

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

// Error: it cannot be read, or its hash is another one.
Result<std::string> ReadPlugin(const std::string& path, const std::string& hash) {
  TRY(std::string bytes, ReadSmallFile(path, controllers::kMaxPluginBytes));
  if (const std::string found = Sha256(bytes); found != hash) {
    return InvalidInput(fmt::format(
        "{} is not the plug-in that the run was made for: its SHA-256 is {}, not {}", path, found, hash));
  }
  return bytes;
}

}  // namespace

Result<PluginFile> PluginFiles::Open(const std::string& hash) {
  if (!copies_.contains(hash)) {
    std::vector<std::string> paths = settings_.files;
    if (paths.empty() && !settings_.folder.empty())
      paths.push_back(fmt::format("{}/{}.so", settings_.folder, hash));
    Result<std::string> bytes =
        InvalidInput(fmt::format("the run needs the plug-in {}: give its file by --plugin", hash));
    std::string name;
    for (const std::string& path : paths) {
      bytes = ReadPlugin(path, hash);
      name = path;
      if (bytes) break;
    }
    if (!bytes) return bytes.error();
    UniqueFd memory(memfd_create("plug-in", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!memory.valid()) return SystemError("cannot make a file in memory", errno);
    TRY(WriteAll(memory.get(), *bytes));
    // No run writes into the library of the next one.
    if (fcntl(memory.get(), F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL) != 0)
      return SystemError("cannot seal a file in memory", errno);
    copies_[hash] = {std::move(name), std::move(memory)};
  }
  const Copy& copy = copies_.at(hash);
  return PluginFile{.path = fmt::format("/proc/self/fd/{}", copy.memory.get()),
                    .name = copy.name,
                    .hash = hash,
                    .descriptor = copy.memory.get()};
}

std::set<int> DescriptorsOf(const std::vector<PluginFile>& files) {
  std::set<int> descriptors;
  for (const PluginFile& file : files) descriptors.insert(file.descriptor);
  return descriptors;
}

Result<std::vector<PluginFile>> PluginFiles::Of(const sim::RunSpec& spec) {
  std::vector<PluginFile> files;
  for (const std::string& hash : std::set{spec.plugin, spec.scenario_plugin}) {
    if (hash.empty()) continue;
    TRY(PluginFile file, Open(hash));
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace gauntlet::worker
