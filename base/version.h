// What `--version` prints of a program: its name and version, then commit and compiler.
#pragma once

#include <string>

namespace gauntlet {

std::string VersionText(const std::string& program);

}  // namespace gauntlet
