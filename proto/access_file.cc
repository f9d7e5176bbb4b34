#include "proto/access_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/unique_fd.h"
#include "proto/json_text.h"

namespace gauntlet::proto {
namespace {

constexpr int kAccessFormat = 1;
constexpr std::size_t kKeyCharacters = 40;
constexpr std::size_t kMaxBytes = 1U << 20;
constexpr mode_t kWritableByOthers = 022;

bool IsEndpoint(const std::string& text) {
  return (text.starts_with("tcp://") || text.starts_with("ipc://")) && text.size() > 6;
}

}  // namespace

bool IsCurveKey(std::string_view key) {
  // Z85 (https://rfc.zeromq.org/spec/32/): five characters are the digits of 32 bits.
  constexpr std::string_view kDigits =
      "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const std::size_t digit = kDigits.find(key[i]);
    value = (i % 5 == 0 ? 0 : value * kDigits.size()) + digit;
    if (digit == std::string_view::npos || value > UINT32_MAX) return false;
  }
  return key.size() == kKeyCharacters;
}

Result<Access> ParseAccess(const std::string& text, const std::string& place) {
  const auto wrong = [&](const std::string& what) {
    return InvalidInput(fmt::format("{}: {}", place, what));
  };
  TRY(const auto json, ParseJson(text, place));
  if (!json.is_object()) return wrong("an object is needed");
  const auto member = [&](const char* name) { return json.contains(name) ? json[name] : nlohmann::json(); };

  const nlohmann::json format = member("format");
  if (!format.is_number_integer()) return wrong("\"format\" must be a whole number");
  if (format != kAccessFormat) {
    return Error{ErrorKind::kVersion, fmt::format("{}: format {}, this version reads format {}", place,
                                                  format.dump(), kAccessFormat)};
  }
  Access access;
  const nlohmann::json campaign = member("campaign");
  if (!campaign.is_string() || campaign == "") return wrong("\"campaign\" must be the campaign's id, a text");
  access.campaign_id = campaign.get<std::string>();
  const nlohmann::json epoch = member("epoch");
  if (!epoch.is_number_unsigned()) return wrong("\"epoch\" must be a whole number from 0");
  access.epoch = epoch.get<std::uint64_t>();
  const nlohmann::json endpoints = member("endpoints");
  if (!endpoints.is_array() || endpoints.empty()) {
    return wrong("\"endpoints\" must be a list with at least one address");
  }
  for (const nlohmann::json& endpoint : endpoints) {
    if (!endpoint.is_string() || !IsEndpoint(endpoint.get_ref<const std::string&>())) {
      return wrong(fmt::format("endpoint {} is neither tcp://HOST:PORT nor ipc://PATH", endpoint.dump()));
    }
    access.endpoints.push_back(endpoint.get<std::string>());
  }
  if (const auto controllers = json.find("controllers"); controllers != json.end()) {
    if (!controllers->is_array()) return wrong("\"controllers\" must be a list of names");
    for (const nlohmann::json& controller : *controllers) {
      if (!controller.is_string()) return wrong("\"controllers\" must be a list of names");
      access.controllers.push_back(controller.get<std::string>());
    }
  }
  if (const auto curve = json.find("curve"); curve != json.end()) {
    CurveKeys keys;
    for (const auto& [name, key] :
         {std::pair{"server_public", &keys.server_public}, std::pair{"worker_public", &keys.worker_public},
          std::pair{"worker_secret", &keys.worker_secret}}) {
      // What stands there is not repeated: messages end in logs.
      const bool is_text = curve->is_object() && curve->contains(name) && (*curve)[name].is_string();
      if (is_text) *key = (*curve)[name].get<std::string>();
      if (!IsCurveKey(*key)) {
        return wrong(
            fmt::format("\"curve\".\"{}\" must be a key of {} characters of Z85", name, kKeyCharacters));
      }
    }
    access.curve = std::move(keys);
  }
  return access;
}

Result<Access> ReadAccess(const std::string& path) {
  // A named pipe would keep a blocking open waiting.
  const UniqueFd file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
  if (!file.valid() || fstat(file.get(), &status) != 0) {
    const int error = errno;
    return Error{error == ENOENT || error == ENOTDIR ? ErrorKind::kNotFound : ErrorKind::kIo,
                 fmt::format("{}: {}", path, std::strerror(error))};
  }
  if (!S_ISREG(status.st_mode)) return Error{ErrorKind::kIo, fmt::format("{} is no regular file", path)};
  if (status.st_uid != geteuid() && status.st_uid != 0) {
    return InvalidInput(fmt::format(
        "{} belongs to user {}, not to the user of this worker ({}), which so would simulate what "
        "somebody else says; start the worker as the user of the master",
        path, status.st_uid, geteuid()));
  }
  if ((status.st_mode & kWritableByOthers) != 0) {
    return InvalidInput(fmt::format(
        "{} has mode {:03o}: other users may write it; make it 600 (chmod 600), or better let a new master "
        "write it",
        path, status.st_mode & 0777));
  }
  TRY(const auto text, ReadAll(file.get(), path, kMaxBytes));
  Result<Access> access = ParseAccess(text, path);
  if (access.ok() && access->curve && (status.st_mode & 077) != 0) {
    return InvalidInput(fmt::format(
        "{} holds keys and has mode {:03o}: others may read it; make it 600 (chmod 600), or better "
        "let a new master write new keys",
        path, status.st_mode & 0777));
  }
  return access;
}

Status WriteAccess(const std::string& path, const Access& access) {
  nlohmann::ordered_json json = {{"format", kAccessFormat},
                                 {"campaign", access.campaign_id},
                                 {"epoch", access.epoch},
                                 {"endpoints", access.endpoints}};
  if (!access.controllers.empty()) json["controllers"] = access.controllers;
  if (access.curve) {
    json["curve"] = {{"server_public", access.curve->server_public},
                     {"worker_public", access.curve->worker_public},
                     {"worker_secret", access.curve->worker_secret}};
  }
  return WriteFileAtomically(path, JsonText(json), kOwnerOnly);
}

Status RemoveAccess(const std::string& path, std::uint64_t epoch) {
  const Result<std::string> text = ReadRegularFile(path);
  if (!text) return text.error().kind == ErrorKind::kNotFound ? Status(Ok{}) : text.error();
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, /*allow_exceptions=*/false);
  if (json.is_object()) {
    const auto written = json.find("epoch");
    if (written != json.end() && written->is_number_unsigned() && written->get<std::uint64_t>() > epoch)
      return Ok{};
  }
  if (unlink(path.c_str()) != 0 && errno != ENOENT)
    return SystemError(fmt::format("cannot remove {}", path), errno);
  return Ok{};
}

}  // namespace gauntlet::proto
