#include "master/directory/campaign_keys.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "proto/access_file.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

constexpr int kKeysFormat = 1;
constexpr mode_t kOthers = 077;

// The file's members.
std::array<std::pair<const char*, std::string*>, 4> FieldsOf(CampaignKeys& keys) {
  return {{{"server_public", &keys.master.public_key},
           {"server_secret", &keys.master.secret_key},
           {"worker_public", &keys.worker.public_key},
           {"worker_secret", &keys.worker.secret_key}}};
}

Result<CampaignKeys> Make(const std::string& path) {
  CampaignKeys keys{NewCurveKeyPair(), NewCurveKeyPair()};
  nlohmann::ordered_json json = {{"format", kKeysFormat}};
  for (const auto& [name, key] : FieldsOf(keys)) json[name] = *key;
  TRY(WriteFileAtomically(path, JsonText(json), kOwnerOnly));
  return keys;
}

}  // namespace

Result<CampaignKeys> LoadOrMakeKeys(const std::string& path) {
  const Result<std::string> text = ReadRegularFile(path);
  if (!text) {
    if (text.error().kind == ErrorKind::kNotFound) return Make(path);
    return text.error();
  }
  struct stat status {};
  if (stat(path.c_str(), &status) == 0 && (status.st_mode & kOthers) != 0) {
    return InvalidInput(fmt::format(
        "{} holds the campaign's secret keys and has mode {:03o}: others may read it. Delete it, and "
        "new keys are made",
        path, status.st_mode & 0777));
  }
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, /*allow_exceptions=*/false);
  CampaignKeys keys;
  for (const auto& [name, key] : FieldsOf(keys)) {
    *key = TextAt(json, name);
    if (!proto::IsCurveKey(*key)) {
      return Error{
          ErrorKind::kCorrupt,
          fmt::format("{}: \"{}\" is not a key. Delete the file, and new keys are made", path, name)};
    }
  }
  return keys;
}

}  // namespace gauntlet
