#include "master/directory/campaign_plugins.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/sha256.h"
#include "controllers/registry.h"
#include "master/directory/plugins.h"
#include "proto/json_text.h"
#include "proto/plugin_description.h"

namespace gauntlet {
namespace {

constexpr const char* kLibrary = ".so";
constexpr const char* kDescription = ".json";
constexpr const char* kBeginnings = ".beginnings.json";

std::string PathOf(const std::string& folder, const std::string& hash, const char* ending) {
  return fmt::format("{}/{}{}", folder, hash, ending);
}

// Without the empty one, which stands for no plug-in.
std::set<std::string> PluginsOf(const std::vector<SearchPlan>& plans) {
  std::set<std::string> hashes;
  for (const SearchPlan& plan : plans)
    hashes.insert({plan.experiment.plugin, plan.experiment.scenario_plugin});
  hashes.erase("");
  return hashes;
}

// Error: the file holds something else.
Result<std::string> ReadPlugin(const std::string& path, const std::string& hash) {
  Result<std::string> bytes = ReadSmallFile(path, proto::kMaxPluginBytes);
  if (!bytes) return bytes;
  if (const std::string found = Sha256(*bytes); found != hash) {
    return InvalidInput(fmt::format(
        "{} is another plug-in now: its SHA-256 is {}, the searches were begun with {}", path, found, hash));
  }
  return bytes;
}

// What the plug-in has answered to how runs begin: a campaign that is only looked at is not to load it for
// what is known.
Status KeepAnswers(const std::string& folder, const std::string& hash) {
  const nlohmann::ordered_json answers = AnswersOf(hash);
  if (answers.empty()) return Ok{};
  return WriteFileAtomically(PathOf(folder, hash, kBeginnings), JsonText(answers), kReadableByAll);
}

// Without the file nothing is known; an answer that does not read back is asked for again.
Status KnowAnswers(const std::string& path, const std::string& hash) {
  std::error_code missing;
  if (!std::filesystem::exists(path, missing)) return Ok{};
  const Result<std::string> text = ReadRegularFile(path);
  if (!text) return text.error();
  const Result<nlohmann::json> answers = ParseJson(*text, path);
  if (!answers) return answers.error();
  for (const auto& [spec, answer] : answers->items()) {
    if (IsSha256(spec) && answer.is_string()) AddAnswer(hash, spec, answer.get<std::string>());
  }
  return Ok{};
}

}  // namespace

Status KeepPlugins(const std::string& folder, const std::vector<SearchPlan>& plans) {
  for (const std::string& hash : PluginsOf(plans)) {
    const controllers::PluginInfo* plugin = controllers::FindPlugin(hash);
    GAUNTLET_CHECK(plugin != nullptr, hash);
    const Result<std::string> library = ReadPlugin(plugin->file, hash);
    if (!library) return library.error();
    if (Status made = MakeDirectory(folder); !made) return made;
    for (const auto& [ending, content] : {std::pair<const char*, const std::string&>(kLibrary, *library),
                                          {kDescription, plugin->description}}) {
      if (Status kept = WriteFileAtomically(PathOf(folder, hash, ending), content, kReadableByAll); !kept)
        return kept;
    }
    if (Status kept = KeepAnswers(folder, hash); !kept) return kept;
  }
  return Ok{};
}

Status KnowPlugins(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code missing;
  for (fs::directory_iterator entry(folder, missing), end; !missing && entry != end;
       entry.increment(missing)) {
    const fs::path& path = entry->path();
    const std::string hash = path.stem();
    if (path.extension() != kDescription || !IsSha256(hash)) continue;
    const Result<std::string> description = ReadRegularFile(path);
    if (!description) return description.error();
    const Status known =
        AddDescribedPlugin(hash, PathOf(folder, hash, kLibrary), *description, path.string());
    if (!known) return known;
    if (Status answers = KnowAnswers(PathOf(folder, hash, kBeginnings), hash); !answers) return answers;
  }
  return Ok{};
}

Status CheckPlugins(const std::string& folder, const std::vector<SearchPlan>& plans) {
  for (const std::string& hash : PluginsOf(plans)) {
    if (const Result<std::string> read = ReadPlugin(PathOf(folder, hash, kLibrary), hash); !read)
      return read.error();
  }
  return Ok{};
}

}  // namespace gauntlet
