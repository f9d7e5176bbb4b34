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
#include "controllers/rows/plugin_rows.h"
#include "master/directory/commands.h"
#include "master/directory/plugins.h"
#include "master/dispatch/pool/worker_program.h"
#include "proto/json_text.h"
#include "search/experiment/experiment_file.h"

namespace gauntlet {
namespace {

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
  TRY(const std::string text, ReadRegularFile(path));
  TRY(const nlohmann::json answers, ParseJson(text, path));
  for (const auto& [spec, answer] : answers.items()) {
    if (IsSha256(spec) && answer.is_string()) AddAnswer(hash, spec, answer.get<std::string>());
  }
  return Ok{};
}

}  // namespace

Status CheckPlugins(const std::vector<SearchPlan>& plans) {
  for (const std::string& hash : PluginsOf(plans)) {
    TRY(ReadPlugin(hash));
  }
  return Ok{};
}

Status KeepPlugins(const std::string& folder, const std::vector<SearchPlan>& plans) {
  for (const std::string& hash : PluginsOf(plans)) {
    TRY(const std::string library, ReadPlugin(hash));
    TRY(MakeDirectory(folder));
    const controllers::PluginInfo& plugin = *controllers::FindPlugin(hash);
    const bool command = IsCommandFile(plugin.file);
    if (command) {
      TRY(CopyCommandFiles(plugin.file, folder));
    }
    for (const auto& [ending, content] :
         {std::pair<const char*, const std::string&>(command ? kCommandEnding : ".so", library),
          {kDescription, plugin.description}}) {
      TRY(WriteFileAtomically(PathOf(folder, hash, ending), content, kReadableByAll));
    }
    TRY(KeepAnswers(folder, hash));
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
    TRY(const std::string description, ReadRegularFile(path));
    TRY(AddDescribedPlugin(hash, PluginFileIn(folder, hash), description, path.string(),
                           /*brought_along=*/true));
    TRY(KnowAnswers(PathOf(folder, hash, kBeginnings), hash));
  }
  return Ok{};
}

Status CheckPlugins(const std::string& folder, const std::vector<SearchPlan>& plans) {
  for (const std::string& hash : PluginsOf(plans)) {
    TRY(ReadCopy(PluginFileIn(folder, hash), hash));
  }
  return Ok{};
}

}  // namespace gauntlet
