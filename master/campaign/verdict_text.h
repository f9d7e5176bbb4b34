// The end of a run in words.
#pragma once

#include <string>
#include <string_view>

#include "sim/run_result.h"

namespace gauntlet {

// The rule's name in front of "no-path: there is ..."; "" when the message does not begin with one.
std::string RuleOf(std::string_view message);
// "completed", "refused", "crashed", "hung", "out-of-memory", "invalid-command", "killed".
std::string_view NameOf(sim::Verdict verdict);

}  // namespace gauntlet
