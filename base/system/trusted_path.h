// Who could have written what we are about to obey.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/result.h"

namespace gauntlet {

// Whether a directory, and those of `files` in it that exist, belong to this user or to root, and neither
// their group nor others may write them: otherwise somebody else may have decided what they say.
// kInvalidInput names the path, its owner or its mode, and the way out. The directory may be named by a link.
// Directories above it are not looked at.
Status CheckOnlyWeWrite(const std::string& directory, std::span<const std::string_view> files = {});

// Whether somebody else than this user or root owns what has this name; links are followed. False of nothing.
bool IsForeign(const std::string& path);

}  // namespace gauntlet
