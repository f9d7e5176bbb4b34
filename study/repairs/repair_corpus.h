// The failing cases of a repair as a corpus, with what the repaired controller does in them.
#pragma once

#include <string>

#include "base/result.h"
#include "study/repairs/repair_result.h"

namespace gauntlet {

// A file for each training and held-out case in `folder`, which is made; files that are there stay. Of a
// repair that has come to its end.
Status WriteRepairedCorpus(const Repair& repair, const std::string& dir, const std::string& folder);

}  // namespace gauntlet
