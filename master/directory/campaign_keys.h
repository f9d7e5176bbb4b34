// master.key: the keys of a campaign, made once and kept for its life.
#pragma once

#include <string>

#include "base/result.h"
#include "master/dispatch/wire/curve_keys.h"

namespace gauntlet {

// Reads the file, or makes keys and the file (0600) when there is none. Errors: kInvalidInput when others
// than its owner may read it, kCorrupt when it does not hold keys. No message repeats a key.
Result<CampaignKeys> LoadOrMakeKeys(const std::string& path);

}  // namespace gauntlet
