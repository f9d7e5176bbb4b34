#include "master/directory/campaign_origin.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/parse_number.h"
#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

constexpr int kOriginFormat = 1;

// By what a directory is known again.
struct Inodes {
  std::uint64_t directory = 0;
  std::uint64_t database = 0;
  bool operator==(const Inodes&) const = default;
};

Result<Inodes> InodesOf(const CampaignDirectory& directory) {
  Inodes inodes;
  for (const auto& [path, inode] : {std::pair(directory.path(), &inodes.directory),
                                    std::pair(directory.database_path(), &inodes.database)}) {
    struct stat info {};
    if (stat(path.c_str(), &info) != 0) return SystemError(fmt::format("cannot look at {}", path), errno);
    *inode = info.st_ino;
  }
  return inodes;
}

struct Recorded {
  std::string campaign_id;
  Inodes inodes;
};

Status Write(const std::string& path, const Recorded& recorded) {
  const nlohmann::ordered_json json = {{"format", kOriginFormat},
                                       {"campaign", recorded.campaign_id},
                                       {"directory_inode", std::to_string(recorded.inodes.directory)},
                                       {"database_inode", std::to_string(recorded.inodes.database)}};
  return WriteFileAtomically(path, JsonText(json), kReadableByAll);
}

Result<Recorded> Parse(const std::string& text, const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  const std::string campaign = TextAt(json, "campaign");
  const auto directory = ParseNumber<std::uint64_t>(TextAt(json, "directory_inode"));
  const auto database = ParseNumber<std::uint64_t>(TextAt(json, "database_inode"));
  if (!campaign.empty() && directory && database) return Recorded{campaign, {*directory, *database}};
  return Error{
      ErrorKind::kCorrupt,
      fmt::format("{} does not say which campaign this is. Delete it: the campaign then keeps the id "
                  "that it began with",
                  path)};
}

}  // namespace

Result<CampaignOrigin> ConfirmOrigin(const CampaignDirectory& directory, const std::string& born_as) {
  const std::string path = directory.origin_path();
  TRY(const Inodes inodes, InodesOf(directory));
  const Result<std::string> text = ReadRegularFile(path);
  if (!text && text.error().kind != ErrorKind::kNotFound) return text.error();
  if (!text) {
    // Just made, or made before there was such a file.
    TRY(Write(path, {born_as, inodes}));
    return CampaignOrigin{born_as};
  }
  TRY(const Recorded recorded, Parse(*text, path));
  if (recorded.inodes == inodes) return CampaignOrigin{recorded.campaign_id};

  const std::string id = NewCampaignId();
  // The file last: a kill in between is noticed as a copy again.
  for (const std::string& secret : {directory.access_path(), directory.key_path()}) {
    std::error_code error;
    std::filesystem::remove(secret, error);
    if (error) return SystemError(fmt::format("cannot remove {}", secret), error.value());
  }
  TRY(Write(path, {id, inodes}));
  return CampaignOrigin{id, recorded.campaign_id};
}

bool IsUntakenCopy(const CampaignDirectory& directory) {
  const Result<std::string> text = ReadRegularFile(directory.origin_path());
  if (!text) return false;
  const Result<Recorded> recorded = Parse(*text, directory.origin_path());
  const Result<Inodes> inodes = InodesOf(directory);
  return recorded && inodes && recorded->inodes != *inodes;
}

}  // namespace gauntlet
