#include "master/directory/campaign_origin.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/system/atomic_file.h"
#include "proto/json_text.h"

namespace gauntlet::master {
namespace {

constexpr int kOriginFormat = 1;

Result<std::uint64_t> InodeOf(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return SystemError(fmt::format("cannot look at {}", path), errno);
  return static_cast<std::uint64_t>(info.st_ino);
}

struct Recorded {
  std::string campaign_id;
  std::uint64_t directory_inode = 0;
  std::uint64_t database_inode = 0;
};

Status Write(const std::string& path, const Recorded& recorded) {
  const nlohmann::ordered_json json = {{"format", kOriginFormat},
                                       {"campaign", recorded.campaign_id},
                                       {"directory_inode", std::to_string(recorded.directory_inode)},
                                       {"database_inode", std::to_string(recorded.database_inode)}};
  return WriteFileAtomically(path, JsonText(json), kReadableByAll);
}

Result<Recorded> Parse(const std::string& text, const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  const auto field = [&json](const char* key) {
    const bool there = json.is_object() && json.contains(key) && json[key].is_string();
    return there ? json[key].get<std::string>() : std::string();
  };
  Recorded recorded{field("campaign"), 0, 0};
  const std::string directory = field("directory_inode");
  const std::string database = field("database_inode");
  const auto read = [](const std::string& digits, std::uint64_t& inode) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), inode);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  if (recorded.campaign_id.empty() || !read(directory, recorded.directory_inode) ||
      !read(database, recorded.database_inode)) {
    return Error{
        ErrorKind::kCorrupt,
        fmt::format("{} does not say which campaign this is. Delete it: the campaign then keeps the id "
                    "that it began with",
                    path)};
  }
  return recorded;
}

Status Remove(const std::string& path) {
  if (unlink(path.c_str()) != 0 && errno != ENOENT)
    return SystemError(fmt::format("cannot remove {}", path), errno);
  return Ok{};
}

}  // namespace

Result<CampaignOrigin> ConfirmOrigin(const CampaignDirectory& directory, const std::string& born_as) {
  const std::string path = directory.origin_path();
  const Result<std::uint64_t> directory_inode = InodeOf(directory.path());
  if (!directory_inode) return directory_inode.error();
  const Result<std::uint64_t> database_inode = InodeOf(directory.database_path());
  if (!database_inode) return database_inode.error();

  const Result<std::string> text = ReadSmallFile(path);
  if (!text && text.error().kind != ErrorKind::kNotFound) return text.error();
  if (!text) {
    // Just made, or made before there was such a file.
    const Status written = Write(path, {born_as, *directory_inode, *database_inode});
    if (!written) return written.error();
    return CampaignOrigin{born_as};
  }
  const Result<Recorded> recorded = Parse(*text, path);
  if (!recorded) return recorded.error();
  if (recorded->directory_inode == *directory_inode && recorded->database_inode == *database_inode)
    return CampaignOrigin{recorded->campaign_id};

  Result<std::string> id = NewCampaignId();
  if (!id) return id.error();
  // The file last: a kill in between is noticed as a copy again.
  for (const std::string& secret : {directory.access_path(), directory.key_path()}) {
    if (Status removed = Remove(secret); !removed) return removed.error();
  }
  if (Status written = Write(path, {*id, *directory_inode, *database_inode}); !written)
    return written.error();
  return CampaignOrigin{*std::move(id), recorded->campaign_id};
}

bool IsUntakenCopy(const CampaignDirectory& directory) {
  const Result<std::string> text = ReadSmallFile(directory.origin_path());
  if (!text) return false;
  const Result<Recorded> recorded = Parse(*text, directory.origin_path());
  const Result<std::uint64_t> directory_inode = InodeOf(directory.path());
  const Result<std::uint64_t> database_inode = InodeOf(directory.database_path());
  return recorded && directory_inode && database_inode &&
         (recorded->directory_inode != *directory_inode || recorded->database_inode != *database_inode);
}

}  // namespace gauntlet::master
