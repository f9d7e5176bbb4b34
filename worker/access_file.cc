#include "worker/access_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace gauntlet::worker {
namespace {

constexpr int kFormat = 1;
constexpr std::size_t kKeyCharacters = 40;

bool IsEndpoint(const std::string& text) {
  return (text.starts_with("tcp://") || text.starts_with("ipc://")) && text.size() > 6;
}

}  // namespace

Result<Access> ParseAccess(const std::string& text, const std::string& place) {
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {  // parse errors, and numbers beyond all ranges
    return InvalidInput(fmt::format("{}: {}", place, error.what()));
  }
  const auto wrong = [&](const std::string& what) {
    return InvalidInput(fmt::format("{}: {}", place, what));
  };
  if (!json.is_object()) return wrong("an object is needed");

  const auto format = json.find("format");
  if (format == json.end() || !format->is_number_integer()) return wrong("\"format\" must be a whole number");
  if (*format != kFormat) {
    return Error{ErrorKind::kVersion,
                 fmt::format("{}: format {}, this version reads format {}", place, format->dump(), kFormat)};
  }
  Access access;
  const auto campaign = json.find("campaign");
  if (campaign == json.end() || !campaign->is_string() || campaign->get_ref<const std::string&>().empty()) {
    return wrong("\"campaign\" must be the campaign's id, a text");
  }
  access.campaign_id = campaign->get<std::string>();
  const auto epoch = json.find("epoch");
  if (epoch == json.end() || !epoch->is_number_unsigned())
    return wrong("\"epoch\" must be a whole number from 0");
  access.epoch = epoch->get<std::uint64_t>();
  const auto endpoints = json.find("endpoints");
  if (endpoints == json.end() || !endpoints->is_array() || endpoints->empty()) {
    return wrong("\"endpoints\" must be a list with at least one address");
  }
  for (const nlohmann::json& endpoint : *endpoints) {
    if (!endpoint.is_string() || !IsEndpoint(endpoint.get_ref<const std::string&>())) {
      return wrong(fmt::format("endpoint {} is neither tcp://HOST:PORT nor ipc://PATH", endpoint.dump()));
    }
    access.endpoints.push_back(endpoint.get<std::string>());
  }
  if (const auto curve = json.find("curve"); curve != json.end()) {
    CurveKeys keys;
    for (const auto& [name, key] :
         {std::pair{"server_public", &keys.server_public}, std::pair{"worker_public", &keys.worker_public},
          std::pair{"worker_secret", &keys.worker_secret}}) {
      // What stands there is not repeated: messages end in logs.
      const bool is_text = curve->is_object() && curve->contains(name) && (*curve)[name].is_string();
      if (is_text) *key = (*curve)[name].get<std::string>();
      if (key->size() != kKeyCharacters) {
        return wrong(fmt::format("\"curve\".\"{}\" must be a key of {} characters", name, kKeyCharacters));
      }
    }
    access.curve = std::move(keys);
  }
  return access;
}

Result<Access> ReadAccess(const std::string& path) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    const int error = errno;
    return Error{error == ENOENT || error == ENOTDIR ? ErrorKind::kNotFound : ErrorKind::kIo,
                 fmt::format("{}: {}", path, std::strerror(error))};
  }
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) return Error{ErrorKind::kIo, fmt::format("{}: cannot be read", path)};
  Result<Access> access = ParseAccess(text, path);
  struct stat status {};
  if (access.ok() && access->curve && stat(path.c_str(), &status) == 0 && (status.st_mode & 077) != 0) {
    return InvalidInput(fmt::format(
        "{} holds keys and has mode {:03o}: others may read it; make it 600 (chmod 600), or better "
        "let a new master write new keys",
        path, status.st_mode & 0777));
  }
  return access;
}

}  // namespace gauntlet::worker
