// access.json: where a campaign's master listens, and the keys by which it is reached. Written by the master,
// atomically; read by workers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gauntlet::proto {

// The keys of CurveZMQ (Z85, 40 characters each): the master's public one and the pair that it admits.
struct CurveKeys {
  std::string server_public;
  std::string worker_public;
  std::string worker_secret;
  bool operator==(const CurveKeys&) const = default;
};

// Whether `key` has the form of a key.
bool IsCurveKey(std::string_view key);

struct Access {
  std::string campaign_id;                        // hexadecimal
  std::uint64_t epoch = 0;                        // number of the master's start
  std::vector<std::string> endpoints;             // "tcp://host:port" or "ipc://path", at least one
  std::optional<CurveKeys> curve = std::nullopt;  // none: plaintext
  std::vector<std::string> controllers = {};      // whose golden hashes the master asks for; empty: all
  bool operator==(const Access&) const = default;
};

// `place` is named in errors. Unknown keys are ignored. Errors: kInvalidInput names line and column or the
// key; kVersion for another "format".
Result<Access> ParseAccess(const std::string& text, const std::string& place);

// Error kNotFound when there is no such file: the master may not have written it yet; kInvalidInput when it
// is no regular file, belongs to neither this user nor root, others may write it, or it holds keys and others
// may read it; kIo when it cannot be read now.
Result<Access> ReadAccess(const std::string& path);

// Writes the file for its owner alone (0600), at once and whole.
Status WriteAccess(const std::string& path, const Access& access);

// Removes it unless a newer master has written its own meanwhile. A missing file is no error.
Status RemoveAccess(const std::string& path, std::uint64_t epoch);

}  // namespace gauntlet::proto
