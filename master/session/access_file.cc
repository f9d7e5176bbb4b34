#include "master/session/access_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

constexpr int kAccessFormat = 1;

}  // namespace

Status WriteAccessFile(const std::string& path, const AccessInfo& info) {
  nlohmann::ordered_json json = {{"format", kAccessFormat},
                                 {"campaign", info.campaign},
                                 {"epoch", info.epoch},
                                 {"endpoints", info.endpoints}};
  if (info.curve) {
    json["curve"] = {{"server_public", info.curve->server_public},
                     {"worker_public", info.curve->worker_public},
                     {"worker_secret", info.curve->worker_secret}};
  }
  return WriteFileAtomically(path, JsonText(json), kOwnerOnly);
}

Status RemoveAccessFile(const std::string& path, std::uint64_t epoch) {
  const Result<std::string> text = ReadSmallFile(path);
  if (!text) {
    if (text.error().kind == ErrorKind::kNotFound) return Ok{};
    return text.error();
  }
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

}  // namespace gauntlet::master
